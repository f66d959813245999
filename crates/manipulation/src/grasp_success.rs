//! Success of predicted grasps in physics.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::target::PoseList;
use opendr_simulation::RegisteredEnvironment as _;
use opendr_simulation::planar_grasp::{Grasp, Outcome, PlanarGrasp, PlanarGraspParams};

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
    /// Grasps whose fingers came down on the object.
    pub collided: u64,
    /// Grasps that closed on nothing.
    pub missed: u64,
    /// Grasps out of which the object slipped.
    pub slipped: u64,
    /// Grasps within the tolerance that held.
    pub successes: u64,
    /// Mean distance of the predicted grasps from the demonstrated ones, m.
    pub mean_distance: f64,
    /// Mean angle, rad.
    pub mean_angle: f64,
}

/// First seed of the evaluated poses.
pub(crate) const FIRST_SEED: u64 = 1_000_000;

/// The images of the camera over the table.
#[derive(Debug, Clone, Copy)]
pub struct View<'a> {
    /// Colour.
    pub image: &'a Image,
    /// Depth of the same size, floats in metres.
    pub depth: &'a Image,
}

/// Measures grasps that `predict` returns for the views of `poses` episodes: the first of each list is attempted.
///
/// # Errors
/// Errors of `predict`, `InvalidParam` for parameters of the environment out of range.
pub fn grasp_success(
    params: &PlanarGraspParams,
    poses: u64,
    tolerance: &GraspTolerance,
    predict: &mut dyn FnMut(View<'_>) -> Result<PoseList>,
) -> Result<GraspSuccess> {
    let mut environment = PlanarGrasp::new(params)?;
    let mut seen = vec![0.0; environment.spec().observation.len()];
    let mut counts = GraspSuccess { poses, ..GraspSuccess::default() };
    for seed in FIRST_SEED..FIRST_SEED + poses {
        environment.reset(Some(seed), &ResetOptions::new(), &mut seen)?;
        let Some(grasp) = nth_grasp(&environment, 0, predict)? else { continue };
        let (distance, angle) = grasp.difference(&environment.shown_grasp()?);
        let near = distance <= tolerance.distance && angle <= tolerance.angle;
        let outcome = environment.test_grasp(&grasp)?;
        let held = outcome == Outcome::Held;
        counts.predicted += 1;
        counts.mean_distance += distance;
        counts.mean_angle += angle;
        counts.near += u64::from(near);
        let counted = match outcome {
            Outcome::Held => &mut counts.held,
            Outcome::Collided => &mut counts.collided,
            Outcome::Missed => &mut counts.missed,
            Outcome::Slipped => &mut counts.slipped,
        };
        *counted += 1;
        counts.successes += u64::from(near && held);
    }
    if counts.predicted > 0 {
        counts.mean_distance /= counts.predicted as f64;
        counts.mean_angle /= counts.predicted as f64;
    }
    Ok(counts)
}

/// Returns grasp `nth` of those that `predict` returns for the present view, counted on from the first where there are fewer; none
/// without one.
pub(crate) fn nth_grasp(
    environment: &PlanarGrasp,
    nth: usize,
    predict: &mut dyn FnMut(View<'_>) -> Result<PoseList>,
) -> Result<Option<Grasp>> {
    let poses = predict(View { image: &environment.image()?, depth: &environment.depth()? })?.poses;
    let chosen = poses.get(nth % poses.len().max(1));
    let Some([left, right, ..]) = chosen.map(|pose| &pose.keypoints[..]) else { return Ok(None) };
    Ok(Some(environment.camera().grasp([[left.x, left.y], [right.x, right.y]])))
}
