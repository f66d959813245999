//! Frames that are no key frames allocate nothing once all memory is in use.

use opendr_odometry::{CameraFrame, CameraKind, OdometryParams, PinholeCamera, Tracking, VisualOdometry};
use opendr_simulation::drive::{Course, Drive, DriveOptions};
use opendr_test_allocator::{CountingAllocator, allocations_of_thread};

#[global_allocator]
static ALLOCATOR: CountingAllocator = CountingAllocator;

#[test]
fn a_frame_allocates_only_for_the_history_of_poses() {
    let options = DriveOptions { seed: 1, course: Course::Straight, length: 20.0, ..DriveOptions::default() };
    let drive = Drive::new(&options).unwrap();
    let (focal_length, principal_point) = drive.intrinsics();
    let camera = PinholeCamera {
        size: options.size,
        focal_length: [focal_length; 2],
        principal_point,
        baseline: f64::from(options.baseline),
    };
    let mut odometry = VisualOdometry::new(camera, CameraKind::Stereo, OdometryParams::default()).unwrap();
    let mut counts = Vec::new();
    for number in 0..drive.frames() {
        let frame = drive.render(number).unwrap();
        let before = allocations_of_thread();
        let outcome =
            odometry.track(&CameraFrame::Stereo { left: &frame.left, right: &frame.right }).unwrap();
        let Tracking::Tracked { is_key_frame, .. } = outcome else { panic!("{outcome:?}") };
        if number > 18 && !is_key_frame {
            counts.push(allocations_of_thread() - before);
        }
    }
    // Lists grow to their largest size now and then.
    assert!(counts.len() > 3, "{counts:?}");
    assert!(counts.iter().sum::<usize>() <= 1, "{counts:?}");
}
