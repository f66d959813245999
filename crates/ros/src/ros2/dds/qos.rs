//! Our quality of service in DDS's words.

use std::time::Duration;

use ros2_client::QosProfile;
use ros2_client::qos::{Durability, History, WhenFull};

use crate::Qos;

/// How long a reliable message waits for room when peers do not confirm.
const PATIENCE: Duration = Duration::from_millis(20);

pub(super) fn profile(qos: Qos) -> QosProfile {
    let profile = QosProfile::subscription_default()
        .history(History::KeepLast { depth: qos.depth })
        .durability(if qos.latched { Durability::TransientLocal } else { Durability::Volatile });
    if qos.reliable {
        profile.reliability_reliable(WhenFull::Wait(PATIENCE))
    } else {
        profile.reliability_best_effort()
    }
}
