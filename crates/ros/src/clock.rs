//! System time, and simulated time from `/clock`.

use std::sync::Arc;
use std::sync::atomic::{AtomicI64, Ordering};
use std::time::{SystemTime, UNIX_EPOCH};

use opendr_engine::Result;
use opendr_messages::{Message, MessageType};
use opendr_ros_bridge::nanoseconds;

use crate::{Clock, Graph, Qos};

/// Value of `sim_time` while the system time is used.
pub(crate) const NO_SIM_TIME: i64 = i64::MIN;

/// Returns a clock that reads `sim_time` or, without it, the system time.
pub(crate) fn clock(sim_time: Arc<AtomicI64>) -> Clock {
    Arc::new(move || match sim_time.load(Ordering::Relaxed) {
        NO_SIM_TIME => system_time_ns(),
        time => time,
    })
}

/// Returns the system time in nanoseconds since 1970.
pub(crate) fn system_time_ns() -> i64 {
    let since = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    i64::try_from(since.as_nanos()).unwrap_or(i64::MAX)
}

/// Subscribes to `/clock` and updates `sim_time` from it.
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
