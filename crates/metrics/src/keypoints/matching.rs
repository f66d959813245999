//! Which predicted pose answers which pose of the truth.

use opendr_engine::target::Pose;
use opendr_engine::{Error, Result};

use super::{place_of, places_like};

/// Most pairs of poses that are compared in one picture.
const MAX_PAIRS: usize = 1 << 20;

/// For every pose of the truth the number of the pose that answers it: the two that are nearest to each other go
/// together, then the two nearest of the others, and so on. How far two poses are apart is the mean distance of the
/// joints that both have; poses without such joints are the furthest apart. Of equal distances the first pair wins.
///
/// # Errors
/// `InvalidInput` for more than 2^20 pairs.
pub(super) fn nearest(truth: &[Pose], predicted: &[Pose]) -> Result<Vec<Option<usize>>> {
    let pairs = truth.len().saturating_mul(predicted.len());
    if pairs > MAX_PAIRS {
        let (wanted, given) = (truth.len(), predicted.len());
        return Err(Error::invalid_input(format!(
            "{given} poses answer {wanted}; give at most {MAX_PAIRS} pairs of them in a picture"
        )));
    }
    let mut ranked = Vec::with_capacity(pairs);
    for (row, pose) in truth.iter().enumerate() {
        ranked.extend(
            predicted.iter().enumerate().map(|(column, answer)| (distance(pose, answer), row, column)),
        );
    }
    ranked.sort_by(|one, other| one.0.total_cmp(&other.0));
    let mut answers = vec![None; truth.len()];
    let mut taken = vec![false; predicted.len()];
    for (_, row, column) in ranked {
        if answers[row].is_none() && !taken[column] {
            answers[row] = Some(column);
            taken[column] = true;
        }
    }
    Ok(answers)
}

/// From a pose of the truth to one that may answer it.
fn distance(one: &Pose, other: &Pose) -> f64 {
    let both = one.keypoints.iter().zip(places_like(one, other));
    let both = both.filter_map(|(one, other)| Some((place_of(one)?, other?)));
    let distances = both.map(|([x0, y0], [x1, y1])| (x1 - x0).hypot(y1 - y0));
    crate::average::mean(distances).unwrap_or(f64::INFINITY)
}
