//! Odometry on rendered drives.

use opendr_engine::data::Image;
use opendr_engine::{ErrorKind, Result};
use opendr_odometry::{
    Alignment, CameraFrame, CameraKind, LossReason, OdometryParams, PinholeCamera, Pose, Stamped, Tracking,
    Trajectory, VisualOdometry, absolute_errors, kitti_drift,
};
use opendr_simulation::drive::{Course, Drive, DriveFrame, DriveOptions};

fn camera(drive: &Drive) -> PinholeCamera {
    let (focal_length, principal_point) = drive.intrinsics();
    let options = drive.options();
    let baseline = f64::from(options.baseline);
    PinholeCamera { size: options.size, focal_length: [focal_length; 2], principal_point, baseline }
}

fn odometry(drive: &Drive, kind: CameraKind, params: OdometryParams) -> VisualOdometry {
    VisualOdometry::new(camera(drive), kind, params).unwrap()
}

fn of(frame: &DriveFrame, kind: CameraKind) -> CameraFrame<'_> {
    match kind {
        CameraKind::Mono => CameraFrame::Mono(&frame.left),
        CameraKind::Stereo => CameraFrame::Stereo { left: &frame.left, right: &frame.right },
        CameraKind::Depth => CameraFrame::Depth { image: &frame.left, depth: &frame.depth },
    }
}

fn truth(drive: &Drive) -> Trajectory {
    let poses =
        (0..drive.frames()).map(|at| Stamped { time: drive.time(at), pose: Pose::from_rows(drive.pose(at)) });
    Trajectory::new(poses.collect()).unwrap()
}

/// Half the size of the examples' images: half the time.
fn options(course: Course) -> DriveOptions {
    DriveOptions { seed: 3, course, length: 40.0, size: [448, 336], ..DriveOptions::default() }
}

#[test]
fn every_camera_drifts_by_less_than_two_percent() {
    let drive = Drive::new(&options(Course::Curves)).unwrap();
    let mut all = [CameraKind::Mono, CameraKind::Stereo, CameraKind::Depth]
        .map(|kind| (kind, odometry(&drive, kind, OdometryParams::default())));
    let mut threaded =
        odometry(&drive, CameraKind::Stereo, OdometryParams { tracking_threads: 2, ..Default::default() });
    for number in 0..drive.frames() {
        let frame = drive.render(number).unwrap();
        for (kind, odometry) in &mut all {
            let outcome = odometry.track(&of(&frame, *kind)).unwrap();
            assert!(!matches!(outcome, Tracking::Lost { .. }), "{number} {kind:?} {outcome:?}");
        }
        threaded.track(&of(&frame, CameraKind::Stereo)).unwrap();
    }
    assert_eq!(threaded.trajectory(), all[1].1.trajectory());
    let truth = truth(&drive);
    for (kind, odometry) in &all {
        assert_eq!(odometry.is_metric(), *kind != CameraKind::Mono);
        let (truth, estimate) = truth.associated(&odometry.trajectory(), 1e-3).unwrap();
        assert!(estimate.len() + 6 > drive.frames(), "{}", estimate.len());
        let alignment = if odometry.is_metric() { Alignment::Rigid } else { Alignment::Scaled };
        let estimate = estimate.aligned_with(&truth, alignment).unwrap();
        let drift = kitti_drift(&truth, &estimate, &[10.0, 20.0, 30.0]).unwrap();
        assert!(drift.translation < 2.0, "{kind:?} {drift:?}");
    }
}

#[test]
fn closing_the_loop_halves_the_error() {
    let options = DriveOptions { block: 55.0, speed: 8.0, ..options(Course::Loop) };
    let drive = Drive::new(&options).unwrap();
    // A short loop drifts little: few corners and a small window.
    let params =
        OdometryParams { max_corners: 110, window: 3, loop_inliers: 15, ..OdometryParams::default() };
    let mut odometry = odometry(&drive, CameraKind::Stereo, params);
    for number in 0..drive.frames() {
        odometry.track(&of(&drive.render(number).unwrap(), CameraKind::Stereo)).unwrap();
    }
    let truth = truth(&drive);
    let error = |odometry: &VisualOdometry| -> Result<f64> {
        let (truth, estimate) = truth.associated(&odometry.trajectory(), 1e-3)?;
        Ok(absolute_errors(&truth, &estimate, Alignment::Rigid)?.rmse)
    };
    let before = error(&odometry).unwrap();
    let report = odometry.close_loops().unwrap();
    let after = error(&odometry).unwrap();
    assert!(report.loops > 0 && after < 0.5 * before, "{before} {after} {report:?}");
    assert_eq!(odometry.close_loops().unwrap().loops, 0);
}

#[test]
fn a_covered_lens_is_lost_and_the_place_is_recognised_after() {
    let drive = Drive::new(&options(Course::Straight)).unwrap();
    let mut odometry = odometry(&drive, CameraKind::Stereo, OdometryParams::default());
    let black = |image: &Image| {
        Image::from_rgb8(vec![9; 3 * image.width() * image.height()], image.width(), image.height())
            .unwrap()
            .with_header(image.header.clone())
    };
    // Back to where the camera was when the lens was covered, and on.
    let places = (0..20).chain(20..30).chain(14..30);
    let mut lost = 0;
    let mut recovered = None;
    for (at, place) in places.enumerate() {
        let mut frame = drive.render(place).unwrap();
        if (20..30).contains(&at) {
            (frame.left, frame.right) = (black(&frame.left), black(&frame.right));
        }
        frame.left.header.stamp_ns = Some(at as i64 * 100_000_000);
        match odometry.track(&of(&frame, CameraKind::Stereo)).unwrap() {
            Tracking::Lost { reason, frames } => {
                lost += 1;
                assert_eq!(frames, lost);
                assert!(matches!(reason, LossReason::TooFewCorners { .. }), "{reason}");
            }
            Tracking::Tracked { is_recovered: true, .. } => recovered = Some(at),
            Tracking::Tracked { .. } => {}
            Tracking::Starting => panic!("a stereo pair starts at once"),
        }
    }
    assert_eq!((lost, recovered), (10, Some(30)));
    let trajectory = odometry.trajectory();
    // No pose was made up for the frames without one.
    assert_eq!(trajectory.len(), 36);
    assert!(!trajectory.poses().iter().any(|stamped| (1.95..2.95).contains(&stamped.time)));
    let way = |place: usize| drive.pose(place)[0][3] - drive.pose(0)[0][3];
    let last = trajectory.poses().last().unwrap().pose.position[2];
    assert!((last - way(29)).abs() < 0.3, "{last} {}", way(29));
}

#[test]
fn without_texture_tracking_does_not_start() {
    let drive = Drive::new(&DriveOptions { texture: 0.0, noise: 1.0, ..options(Course::Straight) }).unwrap();
    let blank = Image::from_rgb8(vec![128; 3 * 448 * 336], 448, 336).unwrap();
    let mut odometry = odometry(&drive, CameraKind::Mono, OdometryParams::default());
    for frames in 1..4 {
        let outcome = odometry.track(&CameraFrame::Mono(&blank)).unwrap();
        let reason = LossReason::TooFewCorners { found: 0 };
        assert_eq!(outcome, Tracking::Lost { reason, frames });
    }
    assert!(odometry.trajectory().is_empty());
}

#[test]
fn wrong_frames_are_refused() {
    let drive = Drive::new(&options(Course::Straight)).unwrap();
    let frame = drive.render(0).unwrap();
    let mut odometry = odometry(&drive, CameraKind::Stereo, OdometryParams::default());
    let small = Image::from_rgb8(vec![0; 3 * 64 * 64], 64, 64).unwrap();
    let refused = [
        CameraFrame::Mono(&frame.left),
        CameraFrame::Stereo { left: &frame.left, right: &small },
        CameraFrame::Stereo { left: &small, right: &frame.right },
    ];
    for wrong in &refused {
        assert_eq!(odometry.track(wrong).unwrap_err().kind(), ErrorKind::InvalidInput);
    }
    odometry.track(&of(&frame, CameraKind::Stereo)).unwrap();
    // The same time again.
    assert_eq!(odometry.track(&of(&frame, CameraKind::Stereo)).unwrap_err().kind(), ErrorKind::InvalidInput);
    let broken = PinholeCamera { focal_length: [f64::NAN, 400.0], ..camera(&drive) };
    let error = VisualOdometry::new(broken, CameraKind::Mono, OdometryParams::default()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
}
