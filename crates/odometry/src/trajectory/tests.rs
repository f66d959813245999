use opendr_engine::{ErrorKind, Random};

use super::*;
use crate::geometry::{Pose, Similarity3, exponential};

fn way(count: usize, noise: f64) -> Trajectory {
    let mut random = Random::new(7);
    let poses = (0..count).map(|at| {
        let angle = 0.05 * at as f64;
        let position = [20.0 * angle.sin(), 0.3 * angle, 20.0 * (1.0 - angle.cos())];
        let position = position.map(|part| part + noise * random.normal());
        let rotation = exponential([noise * random.normal() * 0.1, angle, 0.0]);
        Stamped { time: 0.1 * at as f64, pose: Pose { rotation, position } }
    });
    Trajectory::new(poses.collect()).unwrap()
}

#[test]
fn files_are_read_as_they_were_written() {
    let own = way(50, 0.1);
    let tum = Trajectory::from_tum(&own.to_tum()).unwrap();
    let kitti = Trajectory::from_kitti(&own.to_kitti(), 10.0).unwrap();
    for read in [tum, kitti] {
        assert_eq!(read.len(), 50);
        for (a, b) in own.poses().iter().zip(read.poses()) {
            assert!((a.time - b.time).abs() < 1e-12);
            let pairs = a.pose.rows().into_iter().flatten().zip(b.pose.rows().into_iter().flatten());
            assert!(pairs.into_iter().all(|(a, b)| (a - b).abs() < 1e-12));
        }
    }
}

#[test]
fn hostile_files_are_refused_with_their_line() {
    let cases = [
        ("1 2 3", "line 1"),
        ("# a\n0 0 0 0 0 0 0 1\n0 0 0 0 0 0 0 1", "line 3"),
        ("0 0 0 0 0 0 0 0", "quaternion"),
        ("0 0 0 nan 0 0 0 1", "nan"),
        ("0 0 0 1e400 0 0 0 1", "1e400"),
        ("0 0 0 0 0 0 0 1 9", "more than 8"),
        ("\u{0}\u{ffff}", "line 1"),
    ];
    for (text, part) in cases {
        let error = Trajectory::from_tum(text).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Format);
        assert!(error.to_string().contains(part), "{error}");
    }
    for text in ["1 2 3", "1 0 0 0 0 1 0 0 0 0 5 0", "0 0 0 0 0 0 0 0 0 0 0 0", "inf 0 0 0 0 1 0 0 0 0 1 0"] {
        assert_eq!(Trajectory::from_kitti(text, 10.0).unwrap_err().kind(), ErrorKind::Format, "{text}");
    }
    assert_eq!(Trajectory::from_kitti("", 0.0).unwrap_err().kind(), ErrorKind::InvalidParam);
    assert!(Trajectory::from_tum("").unwrap().is_empty());
}

#[test]
fn alignment_removes_motion_and_scale() {
    let truth = way(80, 0.0);
    let pose = Pose { rotation: exponential([0.3, 1.0, -0.4]), position: [3.0, -8.0, 1.0] };
    let turned = truth.transformed(&Similarity3 { scale: 1.0, pose });
    let scaled = truth.transformed(&Similarity3 { scale: 0.2, pose });
    assert!(absolute_errors(&truth, &turned, Alignment::None).unwrap().rmse > 1.0);
    assert!(absolute_errors(&truth, &turned, Alignment::Rigid).unwrap().largest < 1e-9);
    assert!(absolute_errors(&truth, &scaled, Alignment::Rigid).unwrap().rmse > 1.0);
    assert!(absolute_errors(&truth, &scaled, Alignment::Scaled).unwrap().largest < 1e-9);
    let errors = relative_errors(&truth, &turned, 5).unwrap();
    assert!(errors.translation.largest < 1e-9 && errors.rotation.largest < 1e-7, "{errors:?}");
}

#[test]
fn a_scale_error_of_one_percent_is_one_percent_of_drift() {
    let straight = |scale: f64| {
        let poses = (0..300).map(|at| Stamped {
            time: f64::from(at),
            pose: Pose { position: [0.0, 0.0, scale * f64::from(at)], ..Pose::IDENTITY },
        });
        Trajectory::new(poses.collect()).unwrap()
    };
    let drift = kitti_drift(&straight(1.0), &straight(1.01), &KITTI_LENGTHS).unwrap();
    // The kit compares up to the first pose beyond the length.
    assert!((drift.translation - 1.01).abs() < 0.01 && drift.rotation < 1e-9, "{drift:?}");
    assert!(kitti_drift(&straight(1.0), &straight(1.0), &[1e6]).is_err());
    assert!(relative_errors(&straight(1.0), &straight(1.0), 0).is_err());
    assert!(absolute_errors(&way(3, 0.0), &way(4, 0.0), Alignment::None).is_err());
}

#[test]
fn poses_are_associated_by_time() {
    let own = way(20, 0.0);
    let moved = own
        .poses()
        .iter()
        .skip(3)
        .step_by(2)
        .map(|stamped| Stamped { time: stamped.time + 0.004, ..*stamped });
    let other = Trajectory::new(moved.collect()).unwrap();
    let (a, b) = own.associated(&other, 0.01).unwrap();
    assert_eq!((a.len(), b.len()), (other.len(), other.len()));
    assert!(a.poses().iter().zip(b.poses()).all(|(a, b)| a.pose == b.pose));
    assert!(own.associated(&other, 0.001).is_err());
    let backwards = own.poses().iter().rev().copied().collect();
    assert_eq!(Trajectory::new(backwards).unwrap_err().kind(), ErrorKind::InvalidInput);
}
