//! Errors of trajectories.

use opendr_engine::{Error, Result};

use super::Trajectory;
use crate::geometry::{Pose, Similarity3, distance, length};

/// How an estimated trajectory is aligned with the truth before they are compared.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Alignment {
    /// Not at all.
    None,
    /// By rotation and translation.
    Rigid,
    /// By rotation, translation and scale, for a camera that does not observe scale.
    Scaled,
}

/// Statistics of errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Statistics {
    /// Root of the mean square.
    pub rmse: f64,
    /// Mean.
    pub mean: f64,
    /// Median; the mean of the middle two for an even number.
    pub median: f64,
    /// Largest.
    pub largest: f64,
}

/// Relative pose errors.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelativeErrors {
    /// Of translations, in metres.
    pub translation: Statistics,
    /// Of rotations, in radians.
    pub rotation: Statistics,
}

/// Drift as KITTI's benchmark measures it.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DriftErrors {
    /// Mean error of translation relative to the length of the way, in percent.
    pub translation: f64,
    /// Mean error of rotation, in degrees per metre.
    pub rotation: f64,
    /// Number of pieces of the way that were compared.
    pub pieces: usize,
}

/// Lengths of the pieces that KITTI's benchmark compares, in metres.
pub const KITTI_LENGTHS: [f64; 8] = [100.0, 200.0, 300.0, 400.0, 500.0, 600.0, 700.0, 800.0];

/// Returns the distances of the positions after alignment, in metres: the absolute trajectory error (ATE) of Sturm et al. 2012.
/// Both trajectories have the same poses in the same order, see [`Trajectory::associated`].
///
/// # Errors
/// `InvalidInput` for different numbers of poses, none, or positions that determine no alignment.
pub fn absolute_errors(
    truth: &Trajectory,
    estimate: &Trajectory,
    alignment: Alignment,
) -> Result<Statistics> {
    let aligned = aligned(truth, estimate, alignment)?;
    let pairs = truth.poses().iter().zip(aligned.poses());
    Statistics::of(pairs.map(|(a, b)| distance(a.pose.position, b.pose.position)).collect())
}

/// Returns the estimate after alignment with the truth.
///
/// # Errors
/// As [`absolute_errors`].
pub(crate) fn aligned(truth: &Trajectory, estimate: &Trajectory, alignment: Alignment) -> Result<Trajectory> {
    check(truth, estimate)?;
    let with_scale = match alignment {
        Alignment::None => return Ok(estimate.clone()),
        Alignment::Rigid => false,
        Alignment::Scaled => true,
    };
    let positions = |trajectory: &Trajectory| -> Vec<[f64; 3]> {
        trajectory.poses().iter().map(|stamped| stamped.pose.position).collect()
    };
    let found = Similarity3::aligning(&positions(estimate), &positions(truth), with_scale);
    let found = found.ok_or_else(|| {
        Error::invalid_input(
            "the positions determine no alignment; give at least 3 poses that do not coincide",
        )
    })?;
    Ok(estimate.transformed(&found))
}

impl Trajectory {
    /// Returns the trajectory aligned with the truth, whose poses it has in the same order.
    ///
    /// # Errors
    /// As [`absolute_errors`].
    pub fn aligned_with(&self, truth: &Self, alignment: Alignment) -> Result<Self> {
        aligned(truth, self, alignment)
    }
}

/// Returns the errors of the motions from each pose to the one `step` poses later: the relative pose error (RPE) of Sturm et al. 2012.
///
/// # Errors
/// `InvalidInput` for different numbers of poses, or not more than `step`; `InvalidParam` for a step of 0.
pub fn relative_errors(truth: &Trajectory, estimate: &Trajectory, step: usize) -> Result<RelativeErrors> {
    check(truth, estimate)?;
    if step == 0 {
        return Err(Error::invalid_param("the step of relative errors is 0; give at least 1 pose"));
    }
    let (mut translations, mut rotations) = (Vec::new(), Vec::new());
    for from in 0..truth.len().saturating_sub(step) {
        let error = motion_error(truth, estimate, from, from + step);
        translations.push(length(error.position));
        rotations.push(error.angle());
    }
    Ok(RelativeErrors { translation: Statistics::of(translations)?, rotation: Statistics::of(rotations)? })
}

/// Returns the drift over pieces of the way of these lengths in metres, which begin at every tenth pose, as the development kit of KITTI's
/// odometry benchmark; it uses [`KITTI_LENGTHS`].
///
/// # Errors
/// `InvalidInput` for different numbers of poses, or a way shorter than all lengths.
pub fn kitti_drift(truth: &Trajectory, estimate: &Trajectory, lengths: &[f64]) -> Result<DriftErrors> {
    check(truth, estimate)?;
    let mut way = vec![0.0];
    for pair in truth.poses().windows(2) {
        let step = distance(pair[0].pose.position, pair[1].pose.position);
        way.push(way.last().copied().unwrap_or(0.0) + step);
    }
    let (mut translation, mut rotation, mut pieces) = (0.0, 0.0, 0);
    for from in (0..truth.len()).step_by(10) {
        for length_of_piece in lengths.iter().filter(|length| **length > 0.0) {
            // The kit takes the first pose beyond the length.
            let to = way.partition_point(|at| *at <= way[from] + length_of_piece);
            if to < truth.len() {
                let error = motion_error(truth, estimate, from, to);
                translation += length(error.position) / length_of_piece;
                rotation += error.angle() / length_of_piece;
                pieces += 1;
            }
        }
    }
    if pieces == 0 {
        return Err(Error::invalid_input(format!(
            "the way of {:.1} m is shorter than all lengths of pieces {lengths:?}; give shorter ones",
            way.last().copied().unwrap_or(0.0)
        )));
    }
    let count = pieces as f64;
    Ok(DriftErrors {
        translation: 100.0 * translation / count,
        rotation: (rotation / count).to_degrees(),
        pieces,
    })
}

fn motion_error(truth: &Trajectory, estimate: &Trajectory, from: usize, to: usize) -> Pose {
    let motion = |trajectory: &Trajectory| {
        let pose = |at: usize| trajectory.poses()[at].pose;
        pose(from).inverse().then(&pose(to))
    };
    motion(estimate).inverse().then(&motion(truth))
}

fn check(truth: &Trajectory, estimate: &Trajectory) -> Result<()> {
    if truth.len() != estimate.len() || truth.is_empty() {
        return Err(Error::invalid_input(format!(
            "the truth has {} poses and the estimate {}; associate them by time first",
            truth.len(),
            estimate.len()
        )));
    }
    Ok(())
}

impl Statistics {
    fn of(mut errors: Vec<f64>) -> Result<Self> {
        if errors.is_empty() {
            return Err(Error::invalid_input(
                "there are no pairs of poses to compare; give a longer trajectory",
            ));
        }
        errors.sort_by(f64::total_cmp);
        let count = errors.len() as f64;
        let middle = |at: usize| errors[at.min(errors.len() - 1)];
        Ok(Self {
            rmse: (errors.iter().map(|error| error * error).sum::<f64>() / count).sqrt(),
            mean: errors.iter().sum::<f64>() / count,
            median: 0.5 * (middle(errors.len() / 2) + middle((errors.len() - 1) / 2)),
            largest: middle(errors.len() - 1),
        })
    }
}
