//! The learner: the poses of the odometry, kinds of cameras, and errors.

use opendr_engine::learner::Learner as _;
use opendr_engine::target::{Odometry, RigidPose};
use opendr_engine::{ErrorKind, Result};
use opendr_odometry::{
    Pose, VisualOdometry, VisualOdometryInputs, VisualOdometryLearner, VisualOdometryParams,
};
use opendr_simulation::drive::{Course, Drive, DriveOptions};

fn drive() -> Drive {
    let options =
        DriveOptions { seed: 4, course: Course::Curves, length: 6.0, size: [448, 336], ..Default::default() };
    Drive::new(&options).unwrap()
}

/// A learner with one stream.
struct Stream(VisualOdometryLearner, Option<VisualOdometry>);

impl Stream {
    fn new(params: VisualOdometryParams) -> Self {
        Self(VisualOdometryLearner::with_params(params), None)
    }

    fn infer(&mut self, input: VisualOdometryInputs<'_>) -> Result<Odometry> {
        let mut target = Odometry::default();
        self.0.infer_into(&mut self.1, input, &mut target).map(|()| target)
    }
}

fn stream(drive: &Drive) -> Stream {
    let (focal_length, [principal_point_x, principal_point_y]) = drive.intrinsics();
    let baseline = f64::from(drive.options().baseline);
    Stream::new(VisualOdometryParams {
        focal_length,
        principal_point_x,
        principal_point_y,
        baseline,
        loop_interval: 2,
        ..Default::default()
    })
}

#[test]
fn poses_follow_the_drive() {
    let drive = drive();
    let [mut stereo, mut depths] = [(); 2].map(|()| stream(&drive));
    let last = drive.frames() - 1;
    let world = Pose::from_rows(drive.pose(0)).inverse();
    for number in 0..=last {
        let frame = drive.render(number).unwrap();
        let (image, right, depth) = (&frame.left, Some(&frame.right), Some(&frame.depth));
        let truth = world.then(&Pose::from_rows(drive.pose(number))).position;
        for target in [
            stereo.infer(VisualOdometryInputs { image, right, depth: None }).unwrap(),
            depths.infer(VisualOdometryInputs { image, right: None, depth }).unwrap(),
        ] {
            let pose = target.pose.unwrap();
            let error = (0..3).map(|axis| (pose.position[axis] - truth[axis]).abs()).fold(0.0, f64::max);
            assert!(error < 0.15, "{number}: {pose:?} of {truth:?}");
            let length: f64 = pose.orientation.iter().map(|part| part * part).sum();
            assert!((length - 1.0).abs() < 1e-9 && target.num_landmarks >= 15);
        }
    }
}

#[test]
fn unknown_poses_and_errors() {
    let drive = drive();
    let frame = drive.render(0).unwrap();
    let mut mono = stream(&drive);
    let single = |image| VisualOdometryInputs { image, right: None, depth: None };
    assert_eq!(mono.infer(single(&frame.left)).unwrap().pose, Some(RigidPose::default()));
    let both =
        VisualOdometryInputs { right: Some(&frame.right), depth: Some(&frame.depth), ..single(&frame.left) };
    assert_eq!(mono.infer(both).unwrap_err().kind(), ErrorKind::InvalidInput);
    let small = opendr_engine::data::Image::from_rgb8(vec![0; 3 * 40 * 400], 40, 400).unwrap();
    assert_eq!(stream(&drive).infer(single(&small)).unwrap_err().kind(), ErrorKind::InvalidInput);
    // A single camera does not know the depths of its first frames.
    let next = drive.render(1).unwrap();
    let target = mono.infer(single(&next.left)).unwrap();
    assert_eq!((target.pose, target.num_landmarks), (None, 0));
    // The stream is of a single camera.
    let next = drive.render(2).unwrap();
    let pair = VisualOdometryInputs { right: Some(&next.right), ..single(&next.left) };
    assert_eq!(mono.infer(pair).unwrap_err().kind(), ErrorKind::InvalidInput);

    for (params, needed) in [
        (VisualOdometryParams::default(), "focal_length"),
        (VisualOdometryParams { focal_length: 300.0, ..Default::default() }, "baseline"),
    ] {
        let pair = VisualOdometryInputs { right: Some(&frame.right), ..single(&frame.left) };
        let error = Stream::new(params).infer(pair).unwrap_err();
        assert!(error.kind() == ErrorKind::InvalidParam && error.to_string().contains(needed), "{error}");
    }
}
