//! Attempts the best grasp of a learner for the view of `PlanarGrasp-v1`, detects again where it failed, and counts what is held.
//!
//! ```console
//! $ cargo run --release -p opendr --example grasp_in_the_loop -- gr_conv_net 100
//! ```
//!
//! The learner is a name of the registry with the task grasp detection, which takes an image and, if it has such a port, its depth.

use std::env;
use std::error::Error;

use opendr::learner::Ports;
use opendr::manipulation::held_within;
use opendr::simulation::planar_grasp::{GraspObject, PlanarGraspParams};
use opendr::target::PoseList;
use opendr::{Value, learner};

/// Most attempts for an object.
const ATTEMPTS: usize = 5;

fn main() -> Result<(), Box<dyn Error>> {
    let mut arguments = env::args().skip(1);
    let name = arguments.next().unwrap_or_else(|| "gr_conv_net".to_owned());
    let poses: u64 = arguments.next().map_or(Ok(100), |poses| poses.parse())?;
    let has_depth = opendr::registry().find(&name)?.ports.iter().any(|port| port.name == "depth");
    let mut learner = learner(&name)?;
    for object in GraspObject::ALL {
        let params = PlanarGraspParams { object: Some(object), size: 480, ..PlanarGraspParams::default() };
        let held = held_within(&params, poses, ATTEMPTS, &mut |view| {
            let ports = Ports::default().with("image", view.image);
            let ports = if has_depth { ports.with("depth", view.depth) } else { ports };
            match learner.infer(&ports)?.first() {
                Some(Value::PoseList(grasps)) => Ok(grasps.clone()),
                _ => Ok(PoseList::default()),
            }
        })?;
        println!(
            "{object:?}: of {poses} held in the first attempt {}, within {ATTEMPTS} {}",
            held[0],
            held[ATTEMPTS - 1]
        );
    }
    Ok(())
}
