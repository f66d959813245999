use opendr_engine::Random;

use super::*;

fn map(labels: &[u32]) -> Heatmap {
    Heatmap::from_labels(labels.to_vec(), &[1, labels.len()]).unwrap()
}

fn ignoring(ignore: Option<u32>) -> Segmentation {
    Segmentation::new(&SegmentationParams { ignore }).unwrap()
}

/// The definition, pixel by pixel.
fn by_hand(ignore: Option<u32>, ground_truth: &[u32], predicted: &[u32], class: u32) -> ClassPixels {
    let mut pixels = ClassPixels::default();
    for (ground_truth, predicted) in
        ground_truth.iter().zip(predicted).filter(|(ground_truth, _)| Some(**ground_truth) != ignore)
    {
        pixels.ground_truth += u64::from(*ground_truth == class);
        pixels.predicted += u64::from(*predicted == class && Some(class) != ignore);
        pixels.hits += u64::from(*ground_truth == class && *predicted == class);
    }
    pixels
}

#[test]
fn numbers_by_hand() {
    let mut segmentation = Segmentation::default();
    let scores = segmentation.add(&[0, 0, 1, 1, 255, 3], &[0, 1, 1, 255, 0, 3]).unwrap();
    let ious: Vec<_> = scores.classes.iter().map(ClassPixels::iou).collect();
    assert_eq!(ious, [Some(0.5), Some(1.0 / 3.0), None, Some(1.0)]);
    assert_eq!(scores.mean_iou(), Some((0.5 + 1.0 / 3.0 + 1.0) / 3.0));
    assert_eq!(scores.pixel_accuracy(), Some(0.6));
    assert_eq!(scores.mean_accuracy(), Some(2.0 / 3.0));
    assert!((scores.frequency_weighted_iou().unwrap() - (1.0 + 2.0 / 3.0 + 1.0) / 5.0).abs() < 1e-12);
}

#[test]
fn random_maps_equal_the_definition() {
    let mut random = Random::new(7);
    for ignore in [None, Some(0), Some(2), Some(255), Some(u32::MAX)] {
        let mut segmentation = ignoring(ignore);
        let (mut ground_truths, mut predictions) = (Vec::new(), Vec::new());
        for size in [1, 15, 16, 17, 400] {
            let classes = 1 + random.below(9);
            let mut draw = |void: Option<u32>| {
                // Runs of a label, as in images, whose ends differ between the two maps.
                let mut labels = Vec::new();
                while labels.len() < size {
                    let label = random.below(classes + 1) as u32;
                    let label = if label as usize == classes { void.unwrap_or(0) } else { label };
                    labels.extend(vec![label; 1 + random.below(40)]);
                }
                labels.truncate(size);
                labels
            };
            let (ground_truth, prediction) = (draw(ignore), draw(ignore));
            segmentation.add(&ground_truth, &prediction).unwrap();
            ground_truths.extend(ground_truth);
            predictions.extend(prediction);
        }
        for (class, pixels) in segmentation.scores().classes.into_iter().enumerate() {
            assert_eq!(
                pixels,
                by_hand(ignore, &ground_truths, &predictions, class as u32),
                "{class} {ignore:?}"
            );
        }
    }
}

#[test]
fn parts_merge_to_the_whole() {
    let images = [(vec![0, 1, 255], vec![0, 0, 1]), (vec![5, 5, 2], vec![5, 255, 2]), (vec![1], vec![3])];
    let [mut whole, mut first, mut second] = [(); 3].map(|()| Segmentation::default());
    for (at, (ground_truth, prediction)) in images.iter().enumerate() {
        whole.update(at, &map(prediction), &map(ground_truth)).unwrap();
        let part = if at == 1 { &mut first } else { &mut second };
        part.update(at, &map(prediction), &map(ground_truth)).unwrap();
    }
    second.merge(first);
    assert_eq!(second.finish(), whole.finish());
    let mut empty = Segmentation::default();
    empty.merge(whole.clone());
    empty.merge(Segmentation::default());
    assert_eq!(empty.finish(), whole.finish());
}

#[test]
fn invalid_maps_are_rejected() {
    let mut segmentation = Segmentation::default();
    let mut rejected = |prediction: &Heatmap, ground_truth: &Heatmap| {
        segmentation.update(0, prediction, ground_truth).unwrap_err().to_string()
    };
    assert!(rejected(&map(&[0]), &map(&[0, 0])).contains("cannot be compared with one of [1, 2]"));
    assert!(rejected(&map(&[0]), &map(&[1024])).contains("label 1024 is not a class index below 1024"));
    assert!(rejected(&map(&[u32::MAX - 1]), &map(&[0])).contains("4294967294"));
    let scores = Heatmap::from_scores(vec![f32::NAN; 2], &[2, 1, 1]).unwrap();
    assert!(rejected(&scores, &map(&[0])).contains("NaN"));
    assert!(rejected(&map(&[0]), &scores).contains("map of labels"));
    assert!(
        rejected(&Heatmap::from_scores(vec![], &[0, 1, 1]).unwrap(), &map(&[0])).contains("without scores")
    );
    assert_eq!(segmentation.finish(), Segmentation::default().finish());
}

#[test]
fn highest_score_is_the_prediction() {
    let scores = Heatmap::from_scores(vec![0.5, 0.0, 0.5, 0.25, 0.0, 1.0], &[3, 1, 2]).unwrap();
    let (labels, shape) = scores.class_labels().unwrap();
    assert_eq!((&labels[..], shape), (&[0, 2][..], &[1, 2][..]));
    let mut segmentation = Segmentation::default();
    assert_eq!(segmentation.update(0, &scores, &map(&[0, 2])).unwrap(), 1.0);
}

#[test]
fn only_ignored_pixels() {
    let mut segmentation = Segmentation::default();
    assert_eq!(segmentation.update(0, &map(&[3]), &map(&[255])).unwrap(), 1.0);
    let report = segmentation.finish();
    assert_eq!(report.statistics.get("miou"), None);
    assert!(report.tables[0].rows.is_empty() && report.figures.is_empty());
}
