use std::f64::consts::PI;

use opendr_engine::target::BoundingBox3D;

use super::*;

/// A car 60 pixels high and 4 x 2 x 1.5 metres, at `x` metres to the right and 20 `x` pixels.
fn car(x: f64, score: f64) -> KittiObject {
    KittiObject {
        class: "Car".to_owned(),
        truncated: 0.0,
        occluded: 0,
        alpha: 0.0,
        bbox2d: [20.0 * x, 100.0, 20.0 * x + 80.0, 160.0],
        dimensions: [4.0, 1.5, 2.0],
        location: [x, 1.6, 20.0],
        rotation_y: 0.0,
        score,
    }
}

fn score_of(
    images: &[(Vec<KittiObject>, Vec<KittiObject>)],
    overlap: KittiOverlap,
    difficulty: KittiDifficulty,
) -> Option<KittiScore> {
    let mut metric = Kitti::default();
    for (at, (found, ground_truth)) in images.iter().enumerate() {
        metric.count(at, found, ground_truth).unwrap();
    }
    metric.scores().into_iter().find(|score| {
        score.class == KittiClass::Car
            && !score.is_loose
            && (score.overlap, score.difficulty) == (overlap, difficulty)
    })
}

fn r40(score: &KittiScore) -> f64 {
    score.numbers().next().unwrap().2
}

/// Four cars are detected with scores 0.9, 0.8, 0.7 and 0.6, and there is a false positive at 0.75. The thresholds are the
/// four true scores, so only the first four of 41 points are filled, each with the highest precision from there on:
/// 1/1, 2/2, then 3/4 and 4/5, that is 1, 1, 0.8, 0.8. Of 40 points: (1 + 0.8 + 0.8) / 40; of 11: 1 / 11.
#[test]
fn precision_by_hand() {
    let ground_truth: Vec<_> = (0..4).map(|at| car(10.0 * f64::from(at), 0.0)).collect();
    let mut found: Vec<_> = (0..4).map(|at| car(10.0 * f64::from(at), 0.9 - 0.1 * f64::from(at))).collect();
    found.push(car(55.0, 0.75));
    for overlap in KittiOverlap::ALL {
        let images = [(found.clone(), ground_truth.clone())];
        let score = score_of(&images, overlap, KittiDifficulty::Moderate).unwrap();
        assert_eq!(score.precision[..5], [1.0, 1.0, 0.8, 0.8, 0.0]);
        let (kind, r11, r40) = score.numbers().next().unwrap();
        assert_eq!(kind, overlap.name());
        assert!((r40 - 2.6 / 40.0).abs() < 1e-12 && (r11 - 1.0 / 11.0).abs() < 1e-12);
    }
}

/// The orientation similarity is (1 + cos) / 2 of every true positive: half for a quarter turn.
#[test]
fn orientation_by_hand() {
    let rotated = |alpha: f64| KittiObject { alpha, ..car(0.0, 0.9) };
    let of = |alpha: f64| {
        let images = [(vec![rotated(alpha)], vec![car(0.0, 0.0)])];
        score_of(&images, KittiOverlap::Image, KittiDifficulty::Easy).unwrap().orientation
    };
    assert_eq!(of(0.0).unwrap()[0], 1.0);
    assert!((of(PI / 2.0).unwrap()[0] - 0.5).abs() < 1e-12);
    assert!(of(PI).unwrap()[0].abs() < 1e-12);
    assert_eq!(of(-10.0), None);
}

/// A 4 x 2 base rotated by t = 0.2 about its center, c = cos t, s = sin t. Its short sides lie on c x + s y = 2, which
/// meets x = 2 at y = 2 (1 - c) / s: off the corner (2, 1) they cut a right triangle with sides p = 1 - 2 (1 - c) / s and
/// p tan t. Its long sides lie on -s x + c y = 1, which meets y = 1 at x = -(1 - c) / s: off (-2, 1) they cut one with
/// sides q = 2 - (1 - c) / s and q tan t. The opposite corners lose the same.
#[test]
fn overlap_of_rotated_cars() {
    let turn = 0.2f64;
    let (c, s) = (turn.cos(), turn.sin());
    let short = (1.0 - 2.0 * (1.0 - c) / s).powi(2) * turn.tan() / 2.0;
    let long = (2.0 - (1.0 - c) / s).powi(2) * turn.tan() / 2.0;
    let shared = 8.0 - 2.0 * (short + long);
    let rotated = KittiObject { rotation_y: turn, ..car(0.0, 0.9) };
    let (floor, other) = (rotated.upright_box(), car(0.0, 0.0).upright_box());
    let overlap = shared / (16.0 - shared);
    assert!((floor.iou(&other) - overlap).abs() < 1e-12, "{} is not {overlap}", floor.iou(&other));
    // The development kit's front of a car: x = cos(rotation_y), z = -sin(rotation_y).
    let (sin, cos) = floor.base.angle.sin_cos();
    assert!((cos - c).abs() < 1e-12 && (sin + s).abs() < 1e-12);
}

#[test]
fn difficulty_selects_ground_truth() {
    let hidden = KittiObject { occluded: 1, ..car(10.0, 0.0) };
    let cut = KittiObject { truncated: 0.5, ..car(20.0, 0.0) };
    let low = KittiObject { bbox2d: [600.0, 100.0, 680.0, 125.0], ..car(30.0, 0.0) };
    let ground_truth = vec![car(0.0, 0.0), hidden, cut, low];
    let found =
        ground_truth.iter().cloned().map(|object| KittiObject { score: 0.5, ..object }).collect::<Vec<_>>();
    // Predictions of ignored objects are not false positives; missing them does not count either.
    for (difficulty, recalled) in KittiDifficulty::ALL.into_iter().zip([1, 2, 3]) {
        let score =
            score_of(&[(found.clone(), ground_truth.clone())], KittiOverlap::Space, difficulty).unwrap();
        assert_eq!(score.precision.iter().filter(|precision| **precision == 1.0).count(), recalled);
        let alone = vec![found[0].clone()];
        let score = score_of(&[(alone, ground_truth.clone())], KittiOverlap::Space, difficulty).unwrap();
        assert_eq!(score.precision[0], 1.0);
    }
}

#[test]
fn neighbours_and_dont_care_are_not_false_positives() {
    let of = |class: &str, x: f64| KittiObject { class: class.to_owned(), ..car(x, 0.0) };
    let found = vec![car(0.0, 0.9), car(10.0, 0.9), car(20.0, 0.9), car(30.0, 0.9)];
    let ground_truth = vec![car(0.0, 0.0), of("Van", 10.0), of("DontCare", 20.0), of("Truck", 30.0)];
    let score = |overlap| {
        score_of(&[(found.clone(), ground_truth.clone())], overlap, KittiDifficulty::Easy).unwrap().precision
            [0]
    };
    // The truck is a false positive; in bird's-eye view and in space, regions without boxes ignore nothing.
    assert_eq!((score(KittiOverlap::Image), score(KittiOverlap::Space)), (0.5, 1.0 / 3.0));
}

#[test]
fn images_merge_in_any_order() {
    let images: Vec<_> = (0..6)
        .map(|at| {
            let x = 3.0 * f64::from(at);
            (
                vec![car(x + 0.1 * f64::from(at), 0.5 + 0.05 * f64::from(at))],
                vec![car(x, 0.0), car(x + 30.0, 0.0)],
            )
        })
        .collect();
    let (mut whole, mut even, mut odd) = (Kitti::default(), Kitti::default(), Kitti::default());
    for (at, (found, ground_truth)) in images.iter().enumerate() {
        whole.count(at, found, ground_truth).unwrap();
        if at % 2 == 0 { &mut even } else { &mut odd }.count(at, found, ground_truth).unwrap();
    }
    odd.merge(even);
    assert_eq!(odd.finish(), whole.finish());
    assert!(whole.finish().statistics.get("map_3d_moderate_r40").unwrap() > 0.0);
}

#[test]
fn decimals_of_the_file_are_compared_with_the_limits() {
    let found = BoundingBox3D {
        name: "Car".into(),
        truncated: 0.15,
        bbox2d: [0.0, 187.13, 80.0, 227.13],
        dimensions: [4.0, 1.5, 2.0],
        ..BoundingBox3D::default()
    };
    let [object] = object::objects_from_list(&vec![found].into()).unwrap().try_into().unwrap();
    assert_eq!((object.truncated, object.bbox2d[1]), (0.15, 187.13));
    let ground_truth = vec![object];
    assert!(score_of(&[(vec![], ground_truth)], KittiOverlap::Image, KittiDifficulty::Easy).is_none());
}

#[test]
fn invalid_boxes_are_rejected() {
    let mut metric = Kitti::default();
    assert!(metric.count(0, &[car(f64::NAN, 0.5)], &[]).is_err());
    assert!(metric.count(0, &vec![car(0.0, 0.5); 5000], &[]).is_err());
    let no_class = BoundingBox3D { bbox2d: [1.0; 4], ..BoundingBox3D::default() };
    let no_place = BoundingBox3D { name: "Car".into(), ..BoundingBox3D::default() };
    for invalid in [no_class, no_place] {
        assert!(metric.update(0, &vec![invalid].into(), &BoundingBox3DList::default()).is_err());
    }
    assert_eq!(metric.finish().statistics.get("map_3d_moderate_r40"), None);
    assert_eq!(score_of(&[(vec![car(0.0, 0.5)], vec![])], KittiOverlap::Image, KittiDifficulty::Easy), None);
    let missed = score_of(&[(vec![], vec![car(0.0, 0.5)])], KittiOverlap::Image, KittiDifficulty::Easy);
    assert_eq!(r40(&missed.unwrap()), 0.0);
}
