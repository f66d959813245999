//! Input features of gesture networks from hands and paths of finger tips.
//!
//! The features are those of Kazuhito Takahashi's hand-gesture-recognition-using-mediapipe (Apache-2.0).

use opendr_engine::target::Pose;

/// Number of joints of a hand.
const JOINTS: usize = 21;

/// Returns x and y of each of 21 joints relative to the wrist, divided by the largest absolute value: 42 values in -1..=1.
/// `None` when the pose has another number of joints, one is not finite, or all are one point.
pub fn features_of_hand(hand: &Pose) -> Option<[f32; 2 * JOINTS]> {
    let points = &hand.keypoints[..];
    if points.len() != JOINTS {
        return None;
    }
    let wrist = points.first()?;
    let mut features = [0.0; 2 * JOINTS];
    for (pair, point) in features.as_chunks_mut::<2>().0.iter_mut().zip(points) {
        *pair = [point.x - wrist.x, point.y - wrist.y];
    }
    let longest = features.iter().fold(0.0f32, |most, part| most.max(part.abs()));
    if !features.iter().all(|part| part.is_finite()) || longest == 0.0 {
        return None;
    }
    features.iter_mut().for_each(|part| *part /= longest);
    Some(features)
}

/// Writes x and y of each point of a path relative to its first, divided by the image's width and height, into `out`, which
/// has two values per point. Returns `false` when the number of points differs, or one is not finite.
pub fn features_of_path(
    points: impl ExactSizeIterator<Item = [f32; 2]>,
    [width, height]: [usize; 2],
    out: &mut [f32],
) -> bool {
    if 2 * points.len() != out.len() || width == 0 || height == 0 {
        return false;
    }
    let mut first = None;
    for (pair, [x, y]) in out.as_chunks_mut::<2>().0.iter_mut().zip(points) {
        let [x0, y0] = *first.get_or_insert([x, y]);
        *pair = [(x - x0) / width as f32, (y - y0) / height as f32];
    }
    out.iter().all(|part| part.is_finite())
}

#[cfg(test)]
mod tests {
    use opendr_engine::target::{Keypoint, Skeleton};

    use super::*;

    #[test]
    fn features_ignore_position_and_size() {
        let hand = |scale: f32, left: f32| Pose {
            keypoints: (0..JOINTS)
                .map(|at| Keypoint {
                    x: left + scale * (at * 7 % 5) as f32,
                    y: 9.0 - scale * (at % 4) as f32,
                    confidence: 1.0,
                })
                .collect(),
            skeleton: Skeleton::LeftHand21,
            ..Pose::default()
        };
        let features = features_of_hand(&hand(1.0, 5.0)).unwrap();
        assert_eq!(&features[..4], &[0.0, 0.0, 0.5, -0.25]);
        let larger = features_of_hand(&hand(8.0, 300.0)).unwrap();
        assert!(features.iter().zip(larger).all(|(a, b)| (a - b).abs() < 1e-5));
        assert!(features_of_hand(&hand(0.0, 5.0)).is_none());
        assert!(features_of_hand(&hand(f32::NAN, 5.0)).is_none());
        assert!(features_of_hand(&Pose::default()).is_none());
    }

    #[test]
    fn paths_begin_at_zero() {
        let path = [[10.0, 10.0], [20.0, 5.0]];
        let mut out = [1.0; 4];
        assert!(features_of_path(path.into_iter(), [100, 50], &mut out));
        assert_eq!(out, [0.0, 0.0, 0.1, -0.1]);
        assert!(!features_of_path(path.into_iter(), [100, 50], &mut [0.0; 6]));
        assert!(!features_of_path(path.into_iter(), [0, 50], &mut out));
        assert!(!features_of_path([[f32::NAN, 0.0], [1.0, 1.0]].into_iter(), [100, 50], &mut out));
    }
}
