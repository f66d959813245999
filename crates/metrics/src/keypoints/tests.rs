use opendr_engine::target::{BoundingBox, Keypoint};

use super::*;

fn pose(places: &[[f32; 2]]) -> Pose {
    let joints = places.iter().map(|[x, y]| Keypoint { x: *x, y: *y, confidence: 1.0 });
    Pose { keypoints: joints.collect(), ..Pose::default() }
}

fn in_box(mut pose: Pose, width: f32, height: f32) -> Pose {
    pose.region = Some(Box::new(BoundingBox::new(0, 0.0, 0.0, width, height, 1.0)));
    pose
}

fn with(normalize: PoseSize, threshold: f64, joints: &[usize]) -> Keypoints {
    Keypoints::new(&KeypointsParams { normalize, threshold, joints: joints.to_vec() }).unwrap()
}

#[test]
fn numbers_by_hand() {
    let mut keypoints = Keypoints::default();
    let ground_truth = [Some([0.0, 0.0]), Some([10.0, 0.0]), None];
    assert_eq!(
        keypoints.add(&ground_truth, &[Some([3.0, 4.0]), Some([10.0, 0.0]), Some([0.0, 0.0])], 10.0).unwrap(),
        Some(0.5)
    );
    assert_eq!(keypoints.add(&ground_truth[..1], &[Some([0.0, 1.0])], 10.0).unwrap(), Some(1.0));
    assert_eq!(keypoints.add(&ground_truth[2..], &[None], 10.0).unwrap(), None);
    // Joint 0: 0.5 and 0.1 off, joint 1: not at all.
    assert_eq!(keypoints.pck(), Some(0.75));
    assert_eq!(keypoints.pooled_pck(), Some(2.0 / 3.0));
    assert!((keypoints.normalized_mean_error().unwrap() - 0.2).abs() < 1e-12);
    assert_eq!(keypoints.end_point_error(), Some(2.0));
    // Over the 20 thresholds joint 0 is right (9 + 17) / 2 times, joint 1 19 times.
    assert!((keypoints.area().unwrap() - (13.0 + 19.0) / 40.0).abs() < 1e-12);
}

#[test]
fn joints_not_predicted_are_incorrect_and_have_no_distance() {
    let mut keypoints = Keypoints::default();
    keypoints.add(&[Some([0.0, 0.0]), Some([1.0, 1.0])], &[None, Some([1.0, 1.0])], 10.0).unwrap();
    assert_eq!((keypoints.pooled_pck(), keypoints.end_point_error()), (Some(0.5), Some(0.0)));
}

#[test]
fn distance_equal_to_the_threshold() {
    let hit = |normalize| {
        let mut keypoints = with(normalize, 0.5, &[0, 1]);
        keypoints.add(&[Some([0.0, 0.0])], &[Some([5.0, 0.0])], 10.0).unwrap()
    };
    assert_eq!((hit(PoseSize::Box), hit(PoseSize::Head)), (Some(0.0), Some(1.0)));
}

#[test]
fn sizes_of_poses() {
    let size =
        |normalize, joints: &[usize], pose: &Pose| with(normalize, 0.2, joints).params.size_of_pose(pose);
    let framed = in_box(pose(&[[0.0, 0.0], [6.0, 8.0], [6.0, 0.0], [0.0, 8.0]]), 16.0, 9.0);
    assert_eq!(size(PoseSize::Box, &[], &framed), Some(16.0));
    assert_eq!(size(PoseSize::Area, &[], &framed), Some(12.0));
    assert_eq!(size(PoseSize::Head, &[], &framed), Some(0.6 * 337_f64.sqrt()));
    assert_eq!(size(PoseSize::Joints, &[0, 1], &framed), Some(10.0));
    assert_eq!(size(PoseSize::Joints, &[0, 3, 1, 2], &framed), Some(6.0));
    assert_eq!(size(PoseSize::Joints, &[0, 9], &framed), None);
    let bare = pose(&[[0.0, 0.0], [6.0, 8.0], [-1.0, -1.0]]);
    assert_eq!(size(PoseSize::Box, &[], &bare), Some(8.0));
    assert_eq!(size(PoseSize::Joints, &[0, 2], &bare), None);
    assert_eq!(size(PoseSize::Torso, &[], &bare), None);
    let mut person = pose(&[[-1.0, -1.0]; 18]);
    person.keypoints[5] = Keypoint { x: 0.0, y: 0.0, confidence: 1.0 };
    person.keypoints[8] = Keypoint { x: 3.0, y: 4.0, confidence: 1.0 };
    assert_eq!(size(PoseSize::Torso, &[], &person), Some(5.0));
}

#[test]
fn nearest_poses_are_matched() {
    let list = |places: &[f32]| -> PoseList {
        places.iter().map(|x| in_box(pose(&[[*x, 0.0]]), 10.0, 10.0)).collect::<Vec<_>>().into()
    };
    let mut keypoints = Keypoints::default();
    // The second object matches 11, so the first has to match 100; 200 is left over.
    let score = keypoints.update(0, &list(&[100.0, 11.0, 200.0]), &list(&[5.0, 10.0])).unwrap();
    assert_eq!((score, keypoints.end_point_error()), (0.5, Some(48.0)));
    assert_eq!(keypoints.update(1, &list(&[]), &list(&[5.0])).unwrap(), 0.0);
    assert_eq!(keypoints.update(2, &list(&[5.0]), &list(&[])).unwrap(), 1.0);
    let report = keypoints.finish();
    assert_eq!(report.statistics.get("poses"), Some(3.0));
    // These points have no skeleton.
    assert_eq!(report.tables[0].rows[0].0, "0");
}

#[test]
fn other_skeletons_are_compared_by_name() {
    use opendr_engine::target::Skeleton::{Coco17, Opendr18};
    let place = |name: &str| -> [f32; 2] {
        let at = Coco17.joints().iter().position(|joint| *joint == name).map_or(99, |at| 10 * at);
        [at as f32, 0.0]
    };
    let of = |skeleton: opendr_engine::target::Skeleton| {
        let places: Vec<_> = skeleton.joints().iter().map(|name| place(name)).collect();
        PoseList::from(vec![Pose { skeleton, ..pose(&places) }])
    };
    let mut keypoints = Keypoints::default();
    assert_eq!(keypoints.update(0, &of(Opendr18), &of(Coco17)).unwrap(), 1.0);
    assert_eq!(keypoints.finish().tables[0].rows[1].0, "l_eye");
    // The neck is not among COCO's joints.
    let mut keypoints = Keypoints::default();
    assert_eq!(keypoints.update(0, &of(Coco17), &of(Opendr18)).unwrap(), 17.0 / 18.0);
}

#[test]
fn poses_without_size_are_ignored() {
    let mut keypoints = Keypoints::default();
    let point = PoseList::from(vec![pose(&[[1.0, 1.0]])]);
    assert_eq!(keypoints.update(0, &point, &point).unwrap(), 1.0);
    let report = keypoints.finish();
    assert!(report.tables[0].rows.is_empty());
    assert_eq!(report.statistics.get("poses_without_size"), Some(1.0));
    assert_eq!((report.statistics.get("pck"), report.figures.len()), (None, 0));
}

#[test]
fn parts_merge_to_the_whole() {
    let [mut whole, mut first, mut second] = [(); 3].map(|()| Keypoints::default());
    for at in 0..5_u8 {
        let ground_truth = PoseList::from(vec![in_box(pose(&[[1.0, 1.0], [2.0, 4.0]]), 8.0, 8.0)]);
        let prediction = PoseList::from(vec![pose(&[[1.0, f32::from(at)], [2.0, 4.5]])]);
        whole.update(at.into(), &prediction, &ground_truth).unwrap();
        if at < 2 { &mut first } else { &mut second }.update(at.into(), &prediction, &ground_truth).unwrap();
    }
    second.merge(first);
    assert_eq!(second.finish(), whole.finish());
}

#[test]
fn invalid_poses_are_rejected() {
    let mut keypoints = Keypoints::default();
    let list = |places: &[[f32; 2]]| PoseList::from(vec![in_box(pose(places), 8.0, 8.0)]);
    assert!(keypoints.update(0, &list(&[[1.0, 1.0]]), &list(&[[1.0, 1.0]; 2])).is_err());
    assert!(keypoints.update(0, &list(&[[f32::NAN, 1.0]]), &list(&[[1.0, 1.0]])).is_err());
    assert!(keypoints.add(&[None], &[None], 0.0).is_err());
    assert!(keypoints.add(&[None], &[None], f64::NAN).is_err());
    assert_eq!(keypoints.finish(), Keypoints::default().finish());
    let odd = KeypointsParams { normalize: PoseSize::Joints, joints: vec![1], ..KeypointsParams::default() };
    assert!(Keypoints::new(&odd).is_err());
}
