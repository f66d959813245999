//! The tracking task of the environment.

use opendr_engine::environment::{TrackingAxis, TrackingLayout, TrackingTask};

use super::{CONTROL_PERIOD, OBSERVATION_LEN};

/// Position error, velocity error, and the reference's velocity, acceleration and jerk.
const LAYOUT: TrackingLayout = TrackingLayout {
    len: OBSERVATION_LEN,
    axes: 3,
    error: 0,
    rate: 3,
    reference: [6, 9],
    velocity: Some(6),
    feedforward: Some(9),
    age: Some(15),
    saturated: Some(16),
};

/// The response is that of the attitude loop (14/60 s), the rotors (40 ms), the actuation and the age of the estimate. The gains are
/// lower than those of the PID that `tune_pid` of `opendr-control` finds on the nominal plant: that loop has almost no gain margin
/// left, and a lighter body or a weak motor makes it oscillate.
const HORIZONTAL: TrackingAxis = TrackingAxis { response: 0.3, stiffness: 5.0, damping: 4.0 };
/// The thrust follows without the attitude loop.
const VERTICAL: TrackingAxis = TrackingAxis { response: 0.075, stiffness: 10.0, damping: 5.0 };

pub(super) fn tracking() -> TrackingTask {
    TrackingTask { layout: LAYOUT, period: CONTROL_PERIOD, axes: vec![HORIZONTAL, HORIZONTAL, VERTICAL] }
}
