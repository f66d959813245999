//! Whose time it is: the system's, or a simulation's.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use opendr_engine::Result;
use opendr_messages::{Message, MessageType};
use opendr_ros_bridge::nanoseconds;

use crate::{Clock, Graph, Qos};

/// While nobody asked for the simulation's time.
pub(crate) const NO_SIM_TIME: i64 = i64::MIN;

/// The clock that `sim_time` tells, or the system's.
pub(crate) fn clock(sim_time: Arc<AtomicI64>) -> Clock {
    Arc::new(move || match sim_time.load(Ordering::Relaxed) {
        NO_SIM_TIME => system_time_ns(),
        time => time,
    })
}

/// Nanoseconds since 1970.
pub(crate) fn system_time_ns() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_nanos()).unwrap_or(i64::MAX)
}

/// Has `sim_time` follow `/clock` from now on.
pub(crate) fn follow(graph: &mut dyn Graph, sim_time: &Arc<AtomicI64>) -> Result<()> {
    sim_time.store(0, Ordering::Relaxed);
    let sim_time = sim_time.clone();
    graph.subscribe(
        "/clock",
        MessageType::RosgraphMsgsClock,
        Qos::SENSOR,
        Box::new(move |message| {
            if let Ok(Message::RosgraphMsgsClock(message)) = message {
                sim_time.store(nanoseconds(&message.clock), Ordering::Relaxed);
            }
        }),
    )
}
