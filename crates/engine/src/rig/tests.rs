use proptest::prelude::*;

use super::*;
use crate::ErrorKind;
use crate::target::ActionBase as _;

fn pose() -> impl Strategy<Value = ViewPose> {
    (-4.0..4.0, -2.0..2.0, 0.0..9.0).prop_map(|(azimuth, elevation, distance)| ViewPose {
        azimuth,
        elevation,
        distance,
        fourth: 0.0,
    })
}

fn deflections() -> impl Strategy<Value = Vec<f32>> {
    prop::collection::vec(-1.0f32..=1.0, 3)
}

/// A sphere without limits in reach: 40 movements of a thousandth of the room.
fn wide() -> ViewSphere {
    let axes = vec![
        ViewAxis::turning("azimuth", 0.6),
        ViewAxis::limited("elevation", 0.001, -1.0, 1.0),
        ViewAxis::limited("distance", -0.01, 0.5, 10.0),
        ViewAxis::limited("roll", 0.01, -3.0, 3.0),
    ];
    ViewSphere::new(axes, ViewPose { distance: 5.0, ..ViewPose::default() }).unwrap()
}

proptest! {
    #[test]
    fn poses_stay_on_the_sphere(begin in pose(), moves in prop::collection::vec(deflections(), 0..30)) {
        let mut sphere = ViewSphere::camera(begin).unwrap();
        for axes in moves {
            let before = sphere.pose();
            let achieved = sphere.apply(&Action::new(&axes).unwrap()).unwrap();
            let pose = achieved.pose;
            prop_assert_eq!(pose, sphere.pose());
            let size = pose.position().iter().map(|part| part * part).sum::<f64>().sqrt();
            prop_assert!((size - pose.distance).abs() < 1e-12 * pose.distance);
            prop_assert!((-0.9..=0.9).contains(&pose.elevation) && (2.7..=4.5).contains(&pose.distance));
            prop_assert!((-3.15..3.15).contains(&pose.azimuth));
            // Exactly as many axes as declared, each in [-1, 1], and the pose is where they lead to.
            prop_assert_eq!(achieved.action.axes().len(), sphere.axes().len());
            let raised = f64::from(achieved.action.axes()[1]) * sphere.axes()[1].step;
            prop_assert!((before.elevation + raised - pose.elevation).abs() < 1e-6);
            // A limit is reported exactly where the movement was cut short.
            for (at, limit) in achieved.limits.iter().take(3).enumerate() {
                prop_assert_eq!(limit.is_some(), achieved.action.axes()[at] != axes[at]);
            }
            prop_assert_eq!(achieved.limits[0], None);
        }
    }

    #[test]
    fn movements_compose_exactly(
        moves in prop::collection::vec(prop::collection::vec(-1.0f32..=1.0, 4), 1..40),
        shift in 0usize..40,
    ) {
        let (mut there, mut rotated) = (wide(), wide());
        let begin = there.pose();
        let actions: Vec<_> = moves.iter().map(|axes| Action::new(axes).unwrap()).collect();
        for action in &actions {
            prop_assert!(there.apply(action).unwrap().is_complete());
        }
        let mut other = actions.clone();
        other.rotate_left(shift % actions.len());
        for action in &other {
            rotated.apply(action).unwrap();
        }
        prop_assert_eq!(there.pose(), rotated.pose());
        for action in &actions {
            let back: Vec<f32> = action.axes().iter().map(|axis| -axis).collect();
            there.apply(&Action::new(&back).unwrap()).unwrap();
        }
        prop_assert_eq!(there.pose(), begin);
    }

    #[test]
    fn json_leads_back_to_the_same_place(begin in pose(), axes in deflections()) {
        let mut sphere = ViewSphere::camera(begin).unwrap();
        let achieved = sphere.apply(&Action::new(&axes).unwrap()).unwrap();
        let text = serde_json::to_string(&achieved).unwrap();
        let read = serde_json::from_str::<Achieved>(&text).unwrap();
        prop_assert_eq!((read.action, read.limits), (achieved.action, achieved.limits));
        // JSON may lose the last bit of a number; the nearest tick is the same.
        let mut other = ViewSphere::camera(ViewPose::default()).unwrap();
        other.place(read.pose).unwrap();
        prop_assert_eq!(other.pose(), achieved.pose);
        let text = serde_json::to_string(sphere.axes()).unwrap();
        prop_assert_eq!(&serde_json::from_str::<Vec<ViewAxis>>(&text).unwrap()[..], sphere.axes());
    }
}

#[test]
fn limits_are_named() {
    let mut sphere =
        ViewSphere::camera(ViewPose { elevation: 0.9, distance: 3.0, ..ViewPose::default() }).unwrap();
    let achieved = sphere.apply(&Action::new(&[1.0, 1.0, 1.0]).unwrap()).unwrap();
    // Closer is a positive deflection, and the nearest distance the low limit.
    assert_eq!(achieved.limits, [None, Some(Limit::High), Some(Limit::Low), None]);
    assert_eq!((achieved.action.axes()[1], achieved.pose.distance), (0.0, 2.7));
    assert!((achieved.action.axes()[2] - 0.3 / 0.7).abs() < 1e-6);
    assert!(!achieved.is_complete() && (achieved.effort() - (1.0 + 0.0 + 9.0 / 49.0) / 3.0).abs() < 1e-6);
}

#[test]
fn wrong_axes_are_refused() {
    let mut sphere = ViewSphere::wrist_camera(0.8, [0.2, 0.6], ViewPose::default()).unwrap();
    assert_eq!(sphere.pose().distance, 0.2);
    let error = sphere.apply(&Action::new(&[1.0]).unwrap()).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(error.to_string().contains("azimuth, elevation, distance"), "{error}");
    assert!(ViewSphere::drone([0.0, 3.0], ViewPose::default()).is_err());
    assert!(ViewSphere::new(Vec::new(), ViewPose::default()).is_err());
    for (step, low, high) in [(0.0, 0.0, 1.0), (f64::NAN, 0.0, 1.0), (0.1, 1.0, 1.0), (2.0, 0.0, 1.0)] {
        assert!(
            ViewSphere::new(vec![ViewAxis::limited("zoom", step, low, high)], ViewPose::default()).is_err()
        );
    }
    assert!(sphere.place(ViewPose { azimuth: f64::INFINITY, ..ViewPose::default() }).is_err());
}

#[test]
fn angles_between_views() {
    let view = |azimuth, elevation| ViewPose { azimuth, elevation, distance: 1.0, fourth: 0.0 };
    assert!((view(0.0, 0.0).angle_to(&view(1.0, 0.0)) - 1.0).abs() < 1e-12);
    assert!((view(3.0, 0.2).angle_to(&view(3.0, -0.2)) - 0.4).abs() < 1e-12);
    assert!((view(0.0, 0.0).angle_to(&view(1e-9, 0.0)) - 1e-9).abs() < 1e-15);
    assert!((view(0.0, 0.0).angle_to(&view(std::f64::consts::PI, 0.0)) - std::f64::consts::PI).abs() < 1e-7);
}
