use opendr_engine::target::{BoundingBox, BoundingBoxList, Rle, Segment, Segmentation};

use super::*;

const PERSON: u32 = 1;
const SKY: u32 = 7;

fn segment(id: u32, class: u32) -> PanopticSegment {
    PanopticSegment { id, class, is_crowd: false }
}

fn new() -> Panoptic {
    let params = PanopticParams { things: vec![PERSON], ignore: Some(255) };
    Panoptic::new(&params).unwrap()
}

fn counted(
    found: (&[u32], &[PanopticSegment]),
    ground_truth: (&[u32], &[PanopticSegment]),
) -> BTreeMap<u32, (u64, u64, u64, f64)> {
    let mut metric = new();
    let map = |(ids, segments)| PanopticMap { ids, segments };
    metric.count(&map(found), &map(ground_truth)).unwrap();
    let numbers = |counts: &PanopticCounts| {
        (counts.true_positives, counts.false_positives, counts.false_negatives, counts.iou())
    };
    metric.counts().iter().map(|(class, counts)| (*class, numbers(counts))).collect()
}

/// Person 1 of pixels 0 to 3 is detected in 0 to 2 (3 of 4); person 2 of 4 and 5 is missed; the sky of 6 to 9 is detected in
/// 5 to 9 (4 of 5). Person: PQ 0.75 / 1.5 = 0.5; sky: 0.8; all: 0.65.
#[test]
fn hand_computed() {
    let ground_truth =
        ([1, 1, 1, 1, 2, 2, 3, 3, 3, 3], [segment(1, PERSON), segment(2, PERSON), segment(3, SKY)]);
    let found = ([5, 5, 5, 0, 0, 9, 9, 9, 9, 9], [segment(5, PERSON), segment(9, SKY)]);
    let counts = counted((&found.0, &found.1), (&ground_truth.0, &ground_truth.1));
    assert_eq!(counts, BTreeMap::from([(PERSON, (1, 0, 1, 0.75)), (SKY, (1, 0, 0, 0.8))]));

    let labels = |map: &[u32], segments: &[PanopticSegment]| {
        let label = |id: &u32| match segments.iter().find(|segment| segment.id == *id) {
            Some(segment) if segment.class == SKY => SKY * 1000,
            Some(segment) => segment.class * 1000 + id,
            None => 255_000,
        };
        Heatmap::from_labels(map.iter().map(label).collect(), &[2, 5]).unwrap()
    };
    let mut metric = new();
    let quality =
        metric.update(0, &labels(&found.0, &found.1), &labels(&ground_truth.0, &ground_truth.1)).unwrap();
    assert_eq!(quality, 1.55 / 2.5);
    let report = metric.finish();
    let near = |key: &str, expected: f64| {
        let value = report.statistics.get(key).unwrap();
        assert!((value - expected).abs() < 1e-12, "{key}: {value} is not {expected}");
    };
    near("pq", 0.65);
    near("pq_things", 0.5);
    near("pq_stuff", 0.8);
    near("sq", 0.775);
    near("sq_things", 0.75);
    near("rq", 5.0 / 6.0);
    near("rq_things", 2.0 / 3.0);
    assert_eq!(report.tables[0].rows[0].1[3..], [Some(1.0), Some(0.0), Some(1.0)]);
}

/// Half of the union is too little for a match.
#[test]
fn half_is_not_enough() {
    let counts = counted((&[1, 0], &[segment(1, SKY)]), (&[1, 1], &[segment(1, SKY)]));
    assert_eq!(counts, BTreeMap::from([(SKY, (0, 1, 1, 0.0))]));
}

/// Pixels in void are removed from the union of a match: 2 of 2, although the prediction has 3 more in void.
#[test]
fn void_is_removed_from_the_union() {
    let counts = counted((&[1; 5], &[segment(1, SKY)]), (&[0, 0, 0, 4, 4], &[segment(4, SKY)]));
    assert_eq!(counts, BTreeMap::from([(SKY, (1, 0, 0, 1.0))]));
}

/// A prediction is ignored if more than half of it is in void or in a crowd of its class; half is too little, and a crowd
/// of another class does not count.
#[test]
fn predictions_in_void_and_crowd_are_ignored() {
    let crowd = PanopticSegment { is_crowd: true, ..segment(3, PERSON) };
    let ground_truth = ([3, 0, 8, 3, 8, 8], [crowd, segment(8, SKY)]);
    let of = |found: [u32; 6], class| {
        let counts = counted((&found, &[segment(1, class)]), (&ground_truth.0, &ground_truth.1));
        counts.get(&class).copied().unwrap_or_default()
    };
    assert_eq!(of([1, 1, 1, 0, 0, 0], PERSON), (0, 0, 0, 0.0));
    assert_eq!(of([0, 0, 1, 1, 0, 0], PERSON), (0, 1, 0, 0.0));
    assert_eq!(of([1, 1, 0, 0, 0, 0], 5), (0, 1, 0, 0.0));
    assert_eq!(of([0, 1, 0, 0, 0, 0], 5), (0, 0, 0, 0.0));
    // The crowd itself is neither a true positive nor missed.
    assert_eq!(of([1, 0, 0, 1, 0, 0], PERSON), (0, 0, 0, 0.0));
}

#[test]
fn truth_of_thing_zero_is_a_crowd() {
    let crowd = Heatmap::from_labels(vec![1000; 4], &[2, 2]).unwrap();
    let mut metric = new();
    metric.update(0, &crowd, &crowd).unwrap();
    assert_eq!(metric.finish().statistics.get("pq"), None);
    let sky = Heatmap::from_labels(vec![7000; 4], &[2, 2]).unwrap();
    metric.update(1, &sky, &sky).unwrap();
    assert_eq!(metric.finish().statistics.get("pq"), Some(1.0));
    assert_eq!(metric.finish().statistics.get("pq_things"), None);
}

#[test]
fn merging_does_not_depend_on_order() {
    let image = |at: u32| {
        let ground_truth =
            (0..60).map(|pixel| 7000 * u32::from(pixel < 40 + at) + 1001 * u32::from(pixel >= 40 + at));
        let found = (0..60).map(|pixel| 7000 * u32::from(pixel < 43) + 1002 * u32::from(pixel >= 43));
        (
            Heatmap::from_labels(found.collect(), &[6, 10]).unwrap(),
            Heatmap::from_labels(ground_truth.collect(), &[6, 10]).unwrap(),
        )
    };
    let (mut whole, mut parts) = (new(), [new(), new(), new()]);
    for at in 0..9 {
        let (found, ground_truth) = image(at);
        whole.update(at as usize, &found, &ground_truth).unwrap();
        parts[at as usize % 3].update(at as usize, &found, &ground_truth).unwrap();
    }
    let [mut first, second, mut third] = parts;
    third.merge(second);
    third.merge(std::mem::replace(&mut first, new()));
    assert_eq!(third.finish(), whole.finish());
}

#[test]
fn invalid_maps_are_rejected() {
    let one = [segment(1, SKY)];
    let rejected = |found: (&[u32], &[PanopticSegment]), ground_truth: (&[u32], &[PanopticSegment])| {
        let map = |(ids, segments)| PanopticMap { ids, segments };
        new().count(&map(found), &map(ground_truth)).is_err()
    };
    assert!(rejected((&[1], &one), (&[1, 1], &one)));
    assert!(rejected((&[2], &one), (&[1], &one)));
    assert!(rejected((&[1], &one), (&[2], &one)));
    assert!(rejected((&[1], &[one[0], one[0]]), (&[1], &one)));
    assert!(rejected((&[0], &one), (&[1], &one)));
    assert!(rejected((&[0], &[segment(0, SKY)]), (&[1], &one)));
    let labels = Heatmap::from_labels(vec![0; 4], &[2, 2]).unwrap();
    let wide = Heatmap::from_labels(vec![0; 4], &[1, 4]).unwrap();
    assert!(new().update(0, &labels, &wide).is_err());
    assert!(new().update(0, &Heatmap::from_scores(vec![0.0; 4], &[2, 2]).unwrap(), &labels).is_err());
    assert_eq!(
        new()
            .count(&PanopticMap { ids: &[], segments: &[] }, &PanopticMap { ids: &[], segments: &[] })
            .unwrap(),
        1.0
    );
}

/// Masks become labels: the first of a list on top, crowds of the ground truth as object 0, void where there is none.
#[test]
fn masks_as_labels() {
    let masked = |class: i64, counts: &[u32], iscrowd| {
        let rle = Rle::new(2, 3, counts.to_vec()).unwrap();
        let segment = Segment { segmentation: Segmentation::Rle(rle), area: 0.0, iscrowd };
        BoundingBox { segment: Some(Box::new(segment)), ..BoundingBox::new(class, 0.0, 0.0, 1.0, 1.0, 1.0) }
    };
    let list = BoundingBoxList::from(vec![
        masked(1, &[0, 1, 5], false),
        masked(7, &[0, 2, 4], false),
        masked(1, &[4, 2], true),
        masked(1, &[3, 1, 2], false),
    ]);
    let labels = |is_truth| {
        let map = masks::labels_from_masks(&list, is_truth).unwrap();
        let HeatmapValues::Labels(labels) = map.values() else { panic!("{map}") };
        assert_eq!(map.shape(), [2, 3]);
        labels.to_vec()
    };
    assert_eq!(labels(true), [1001, VOID_LABEL, 1000, 7001, 1002, 1000]);
    assert_eq!(labels(false), [1001, VOID_LABEL, 1002, 7001, 1003, 1002]);
    let ground_truth = Panoptic::ground_truth(ValueRef::BoundingBoxList(&list)).unwrap();
    let mut metric = new();
    assert_eq!(metric.update(0, &ground_truth, &ground_truth).unwrap(), 1.0);
    assert_eq!(metric.update(1, &Heatmap::default(), &ground_truth).unwrap(), 0.0);
    assert_eq!(metric.counts()[&PERSON].false_negatives, 2);
    let without_mask = BoundingBoxList::from(vec![BoundingBox::default()]);
    assert!(masks::labels_from_masks(&without_mask, true).is_none());
    let of_no_class = BoundingBoxList::from(vec![masked(-1, &[0, 6], false)]);
    assert!(masks::labels_from_masks(&of_no_class, true).is_none());
}
