//! Matching of predicted poses with ground-truth poses.

use opendr_engine::target::Pose;
use opendr_engine::{Error, Result};

use super::places::{place_of, places_like};

/// Maximum number of pairs of poses per image.
const MAX_PAIRS: usize = 1 << 20;

/// Returns for each ground-truth pose the index of the matched prediction. The two poses that are nearest to each other are
/// matched, then the two nearest of the others, and so on. The distance of two poses is the mean distance of the joints
/// that both have, infinite without common joints. Of equal distances the first pair is matched.
///
/// # Errors
/// Returns `InvalidInput` for more than 2^20 pairs.
pub(super) fn nearest(ground_truth: &[Pose], predicted: &[Pose]) -> Result<Vec<Option<usize>>> {
    let pairs = ground_truth.len().saturating_mul(predicted.len());
    if pairs > MAX_PAIRS {
        let (expected, given) = (ground_truth.len(), predicted.len());
        return Err(Error::invalid_input(format!(
            "{given} predicted and {expected} true poses in an image; give at most {MAX_PAIRS} pairs"
        )));
    }
    let mut ranked = Vec::with_capacity(pairs);
    for (row, pose) in ground_truth.iter().enumerate() {
        ranked.extend(
            predicted
                .iter()
                .enumerate()
                .map(|(column, prediction)| (distance(pose, prediction), row, column)),
        );
    }
    ranked.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut matches = vec![None; ground_truth.len()];
    let mut taken = vec![false; predicted.len()];
    for (_, row, column) in ranked {
        if matches[row].is_none() && !taken[column] {
            matches[row] = Some(column);
            taken[column] = true;
        }
    }
    Ok(matches)
}

/// Returns the distance of a ground-truth pose and a predicted one.
fn distance(one: &Pose, other: &Pose) -> f64 {
    let both = one.keypoints.iter().zip(places_like(one, other));
    let both = both.filter_map(|(one, other)| Some((place_of(one)?, other?)));
    let distances = both.map(|([x0, y0], [x1, y1])| (x1 - x0).hypot(y1 - y0));
    crate::average::mean(distances).unwrap_or(f64::INFINITY)
}
