//! What an environment must offer.

use opendr_engine::environment::{EnvironmentSpec, Space, TrackingTask};
use opendr_engine::{Error, Result};

/// Returns the tracking task that an environment states.
///
/// # Errors
/// `Unsupported` where it states none.
pub fn tracking_task(spec: &EnvironmentSpec) -> Result<&TrackingTask> {
    spec.tracking.as_ref().ok_or_else(|| {
        Error::unsupported(format!(
            "{} states no tracking task: there is no error to learn from. Online adaptation needs an environment that does, as QuadTrack-v1",
            spec.id
        ))
    })
}

/// Bounds of an environment's actions, one for each axis of the task.
///
/// # Errors
/// `Unsupported` for other actions.
pub fn tracking_bounds<'a>(spec: &'a EnvironmentSpec, task: &TrackingTask) -> Result<(&'a [f32], &'a [f32])> {
    match &spec.action {
        Space::Box { low, high, .. } if low.len() == task.axes.len() => Ok((low, high)),
        action => Err(Error::unsupported(format!(
            "actions of {} are {action}; online adaptation needs a box of {} numbers, one for each axis of its tracking task",
            spec.id,
            task.axes.len()
        ))),
    }
}
