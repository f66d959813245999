//! Success of predicted grasps in physics.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::target::PoseList;
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::planar_grasp::{Outcome, PlanarGrasp, PlanarGraspParams};

/// How far a grasp may be from the demonstrated one.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GraspTolerance {
    /// Distance of the places, m.
    pub distance: f64,
    /// Angle, rad.
    pub angle: f64,
}

impl Default for GraspTolerance {
    /// 1 cm and 15 degrees.
    fn default() -> Self {
        Self { distance: 0.01, angle: 15.0_f64.to_radians() }
    }
}

/// Counts over the poses of an object.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct GraspSuccess {
    /// Number of poses.
    pub poses: u64,
    /// Grasps that were predicted at all.
    pub predicted: u64,
    /// Grasps within the tolerance.
    pub near: u64,
    /// Grasps that held.
    pub held: u64,
    /// Grasps within the tolerance that held.
    pub successes: u64,
    /// Mean distance of the predicted grasps from the demonstrated ones, m.
    pub mean_distance: f64,
    /// Mean angle, rad.
    pub mean_angle: f64,
}

/// First seed of the evaluated poses.
const FIRST_SEED: u64 = 1_000_000;

/// Measures grasps that `predict` returns for the images of `poses` episodes: the first of each list is attempted.
///
/// # Errors
/// Errors of `predict`, `InvalidParam` for parameters of the environment out of range.
pub fn grasp_success(
    params: &PlanarGraspParams,
    poses: u64,
    tolerance: &GraspTolerance,
    predict: &mut dyn FnMut(&Image) -> Result<PoseList>,
) -> Result<GraspSuccess> {
    let mut environment = PlanarGrasp::new(params)?;
    let camera = environment.camera();
    let mut seen = vec![0.0; environment.spec().observation.len()];
    let mut counts = GraspSuccess { poses, ..GraspSuccess::default() };
    for seed in FIRST_SEED..FIRST_SEED + poses {
        environment.reset(Some(seed), &ResetOptions::new(), &mut seen)?;
        let grasps = predict(&environment.image()?)?;
        let Some([left, right, ..]) = grasps.poses.first().map(|pose| &pose.keypoints[..]) else { continue };
        let grasp = camera.grasp([[left.x, left.y], [right.x, right.y]]);
        let (distance, angle) = grasp.difference(&environment.shown_grasp()?);
        let near = distance <= tolerance.distance && angle <= tolerance.angle;
        let held = environment.test_grasp(&grasp)? == Outcome::Held;
        counts.predicted += 1;
        counts.mean_distance += distance;
        counts.mean_angle += angle;
        counts.near += u64::from(near);
        counts.held += u64::from(held);
        counts.successes += u64::from(near && held);
    }
    if counts.predicted > 0 {
        counts.mean_distance /= counts.predicted as f64;
        counts.mean_angle /= counts.predicted as f64;
    }
    Ok(counts)
}
