//! Priors of `QuadTrack-v1`.

use opendr_engine::Result;
use opendr_engine::environment::{Space, TrackingTask};
use opendr_rl::prior::{BoxedController, Prior, unread_space};
use opendr_simulation::make;
use opendr_simulation::quad_track::MAX_ACCELERATION;

use crate::lqr::Lqr;
use crate::online::tracking_task;
use crate::pid::PidGains;
use crate::tracking::{TrackingLqr, TrackingPid};

const PID: &str = "quad-track-pid";
const LQR: &str = "quad-track-lqr";

/// Weights of the squared position error (1/m^2), velocity error (s^2/m^2) and acceleration (s^4/m^2): gains of about 5 and 4 in
/// continuous time, those of the task's conventional law of the horizontal axes.
const WEIGHTS: [f64; 3] = [25.0, 6.0, 1.0];

pub(super) fn priors() -> Vec<Prior> {
    let limit = MAX_ACCELERATION;
    let pid = Prior::new(PID, 1, |space: &Space| -> Result<BoxedController> {
        let task = task(PID, space)?;
        Ok(Box::new(TrackingPid::new(task.layout, &tuned_gains(), task.period)?))
    });
    let lqr = Prior::new(LQR, 1, move |space: &Space| -> Result<BoxedController> {
        let task = task(LQR, space)?;
        let [error, rate, effort] = WEIGHTS;
        let regulator = Lqr::double_integrator(task.period, error, rate, effort)?;
        Ok(Box::new(TrackingLqr::new(task.layout, regulator, f64::from(limit))?))
    });
    vec![
        pid.about("PID of each axis, tuned on the nominal plant, with the reference's acceleration, in QuadTrack-v1"),
        lqr.about("LQR of each axis as a double integrator, with the reference's acceleration, in QuadTrack-v1"),
    ]
}

/// Returns the gains of the three axes of `QuadTrack-v1`, tuned on the nominal plant by
/// `cargo run --release -p opendr-control --example tune_pid 400`.
pub fn tuned_gains() -> [PidGains; 3] {
    let limit = f64::from(MAX_ACCELERATION);
    let horizontal = PidGains { kp: 8.344, ki: 0.384, kd: 5.199, filter: 0.00427, limit };
    let vertical = PidGains { kp: 15.449, ki: 0.0732, kd: 2.909, filter: 0.0399, limit };
    [horizontal, horizontal, vertical]
}

/// Returns the tracking task, for observations of `space`.
fn task(prior: &str, space: &Space) -> Result<TrackingTask> {
    let track = make("QuadTrack-v1")?;
    match *space == track.spec().observation {
        true => tracking_task(track.spec()).cloned(),
        false => Err(unread_space(prior, space)),
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::environment::ResetOptions;

    use super::*;

    /// The true distance to the reference over the last 20 s of a flight on the nominal plant, RMS in metres.
    fn distance(prior: &Prior) -> f64 {
        let mut track = make("QuadTrack-v1").unwrap();
        let mut controller = prior.controller(&track.spec().observation).unwrap();
        let (mut observation, mut action) = ([0.0; 17], [0.0; 3]);
        track.reset(Some(3), &ResetOptions::new(), &mut observation).unwrap();
        let mut squares = Vec::new();
        loop {
            controller.act(&observation, &mut action).unwrap();
            let step = track.step(&action, &mut observation).unwrap();
            squares.push(step.info.get("error").unwrap().powi(2));
            if step.is_over() {
                assert!(step.truncated, "the quadrotor was lost");
                let last = &squares[squares.len() - 2000..];
                return (last.iter().sum::<f64>() / 2000.0).sqrt();
            }
        }
    }

    /// docs/online_adaptation.md has 0.057 m for the tuned PID on 500 episodes.
    #[test]
    fn both_track_the_reference() {
        let [pid, lqr] = &priors()[..] else { panic!("two priors") };
        let (pid, lqr) = (distance(pid), distance(lqr));
        assert!(pid < 0.08, "{pid}");
        assert!(lqr < 0.12, "{lqr}");
    }
}
