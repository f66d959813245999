use proptest::prelude::*;

use super::*;

/// An image of one class: objects (box, area, crowd) and detections (box, score).
type ImageBoxes = (Vec<([f64; 4], f64, bool)>, Vec<([f64; 4], f64)>);

fn count(
    accumulator: &mut Accumulator<i64>,
    class: i64,
    at: u32,
    (annotated, detected): &ImageBoxes,
) -> Option<f64> {
    let ground_truth = |(_, area, crowd): &([f64; 4], f64, bool)| GroundTruth {
        area: *area,
        crowd: *crowd,
        ignored: *crowd,
    };
    let ground_truths: Vec<_> = annotated.iter().map(ground_truth).collect();
    let detection =
        |(bounds, score): &([f64; 4], f64)| Detection { score: *score, area: bounds[2] * bounds[3] };
    let detections: Vec<_> = detected.iter().map(detection).collect();
    let overlap = |detection: usize, ground_truth: usize| {
        Ok(box_iou(detected[detection].0, annotated[ground_truth].0, annotated[ground_truth].2))
    };
    accumulator.add(&class, at, &ground_truths, &detections, overlap).unwrap()
}

fn stats(images: &[ImageBoxes]) -> Vec<f64> {
    let mut accumulator = Accumulator::new(Protocol::objects(100));
    for (at, image) in (0..).zip(images) {
        count(&mut accumulator, 1, at, image);
    }
    accumulator.finish(1).stats()
}

const PLACE: [f64; 4] = [0.0, 0.0, 50.0, 50.0];
const ELSEWHERE: [f64; 4] = [100.0, 0.0, 50.0, 50.0];

#[test]
fn half_of_the_objects_detected_gives_half_the_recall() {
    let image = (vec![(PLACE, 2500.0, false), (ELSEWHERE, 2500.0, false)], vec![(PLACE, 0.9)]);
    let stats = stats(&[image]);
    // Recalls 0 to .5 have precision 1: 51 of 101; both objects are medium.
    for ap in [0, 1, 2, 4] {
        assert!((stats[ap] - 51.0 / 101.0).abs() < 1e-12, "{stats:?}");
    }
    assert_eq!((stats[3], stats[5], stats[8], stats[10]), (-1.0, -1.0, 0.5, 0.5));
}

#[test]
fn detections_in_crowds_are_ignored() {
    let crowd = (
        vec![(PLACE, 2500.0, true), (ELSEWHERE, 2500.0, false)],
        vec![([1.0, 1.0, 5.0, 5.0], 0.99), ([9.0, 9.0, 5.0, 5.0], 0.98), (ELSEWHERE, 0.5)],
    );
    assert!((stats(std::slice::from_ref(&crowd))[0] - 1.0).abs() < 1e-12);
    let only = (vec![(PLACE, 2500.0, true)], crowd.1.clone());
    assert_eq!(stats(&[only]), [-1.0; 12]);
}

#[test]
fn ties_are_sorted_by_image_and_detection() {
    let right = (vec![(PLACE, 2500.0, false)], vec![(PLACE, 0.5), (ELSEWHERE, 0.5)]);
    let wrong = (vec![(PLACE, 2500.0, false)], vec![(ELSEWHERE, 0.5), (PLACE, 0.5)]);
    // True, false, false, true: precision 1 up to half the recall, 2/4 beyond.
    let first = stats(&[right.clone(), wrong.clone()])[0];
    assert!((first - (51.0 + 50.0 * 0.5) / 101.0).abs() < 1e-12);
    // False, true, true, false: 2/3 at every recall.
    assert!((stats(&[wrong, right])[0] - 2.0 / 3.0).abs() < 1e-12);
}

#[test]
fn only_the_highest_scores_count() {
    let many = (0..150).map(|at| (ELSEWHERE, 0.9 - f64::from(at) * 1e-3));
    let last = many.clone().chain([(PLACE, 0.1)]).collect();
    assert_eq!(stats(&[(vec![(PLACE, 2500.0, false)], last)])[8], 0.0);
    let tenth = many.take(9).chain([(PLACE, 0.1)]).collect();
    let stats = stats(&[(vec![(PLACE, 2500.0, false)], tenth)]);
    assert_eq!((stats[6], stats[7], stats[8]), (0.0, 1.0, 1.0));
}

#[test]
fn nan_scores_are_rejected_and_not_counted() {
    let mut accumulator = Accumulator::new(Protocol::objects(100));
    let detection = Detection { score: f64::NAN, area: 1.0 };
    assert!(accumulator.add(&1, 0, &[], &[detection], |_, _| Ok(0.0)).is_err());
    assert_eq!(accumulator.finish(1).stats(), [-1.0; 12]);
}

fn bounds() -> impl Strategy<Value = [f64; 4]> {
    (0u8..4, 0u8..4, 1u8..12, 1u8..12)
        .prop_map(|(x, y, w, h)| [x, y, w, h].map(|side| f64::from(side) * 10.0))
}

fn image() -> impl Strategy<Value = ImageBoxes> {
    let annotated = (bounds(), any::<bool>()).prop_map(|(place, crowd)| (place, place[2] * place[3], crowd));
    let detected = (bounds(), 0u8..4).prop_map(|(place, score)| (place, f64::from(score) / 4.0));
    (proptest::collection::vec(annotated, 0..5), proptest::collection::vec(detected, 0..8))
}

proptest! {
    #[test]
    fn distribution_over_accumulators_does_not_matter(
        images in proptest::collection::vec((0i64..3, image(), 0usize..3), 0..9),
    ) {
        let mut parts = [(); 3].map(|()| Accumulator::new(Protocol::objects(100)));
        let mut whole = Accumulator::new(Protocol::objects(100));
        for (at, (class, image, part)) in (0..).zip(&images) {
            let quality = count(&mut whole, *class, at, image);
            prop_assert_eq!(count(&mut parts[*part], *class, at, image), quality);
            prop_assert!(quality.is_none_or(|quality| (0.0..=1.0).contains(&quality)));
        }
        let [mut last, middle, first] = parts;
        last.merge(first);
        last.merge(middle);
        prop_assert_eq!(last.finish(3), whole.finish(1));
    }
}
