//! Inputs of VPIT.

use opendr_clouds::object_detection_3d::Scan;
use opendr_engine::learner::{Inputs, Port, Ports};
use opendr_engine::target::BoundingBox3DList;
use opendr_engine::{Header, Result, ValueType};

/// A scan, and with the first one the object to track.
#[derive(Debug, Clone, Copy)]
pub struct VpitInputs<'a> {
    /// Lidar scan.
    pub scan: Scan<'a>,
    /// Object to track from this scan on: its first box.
    pub init_box: Option<&'a BoundingBox3DList>,
}

const INIT: &str = "init_box";
const SCAN: Port = <Scan<'static> as Inputs<'static>>::PORTS[0];

impl<'a> Inputs<'a> for VpitInputs<'a> {
    const PORTS: &'static [Port] = &[
        SCAN,
        Port {
            name: INIT,
            doc: "Object to track from this scan on: its first box.",
            value_type: ValueType::BoundingBox3DList,
            optional: true,
            init: true,
        },
    ];

    fn from_ports(ports: &Ports<'a>) -> Result<Self> {
        Ok(Self { scan: Scan::from_ports(ports)?, init_box: ports.optional(INIT)? })
    }

    fn header(&self) -> &Header {
        self.scan.header()
    }
}
