//! Conversion of the quality of service to DDS.

use std::time::Duration;

use ros2_client::QosProfile;
use ros2_client::qos::{Durability, History, WhenFull};

use crate::Qos;

/// Maximum blocking time of a reliable publisher when peers do not acknowledge.
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
