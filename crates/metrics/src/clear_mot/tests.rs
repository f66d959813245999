use super::*;

/// One frame: (object, position) and (track, position); equal positions overlap fully, others not at all.
type Places<'a> = (&'a [(i64, i32)], &'a [(i64, i32)]);

fn counted(frames: &[Places<'_>]) -> ClearMotCounts {
    let place = |(id, place): &(i64, i32)| {
        let left = 10.0 * f64::from(*place);
        (*id, [left, 0.0, left + 5.0, 5.0])
    };
    let mut metric = ClearMot::new(&TrackMatchingParams::default()).unwrap();
    for (ground_truth, found) in frames {
        let ground_truth: Vec<_> = ground_truth.iter().map(place).collect();
        let found: Vec<_> = found.iter().map(place).collect();
        metric.count(&TrackingFrame::from_boxes(&ground_truth, &found).unwrap());
    }
    metric.counts()
}

#[test]
fn switch_and_transfer() {
    let counts = counted(&[
        (&[(1, 0), (2, 1)], &[(7, 0), (8, 1)]),
        (&[(1, 0), (2, 1)], &[(8, 0), (7, 1)]),
        (&[(1, 0), (3, 1)], &[(9, 0), (8, 1)]),
    ]);
    assert_eq!((counts.matches, counts.switches, counts.transfers), (3, 3, 3));
    assert_eq!((counts.ascends, counts.migrates), (1, 1));
    assert_eq!((counts.misses, counts.false_positives, counts.unique_objects), (0, 0, 3));
    assert_eq!((counts.mota(), counts.motp()), (0.5, 0.0));
}

#[test]
fn a_gap_is_a_fragmentation_only_between_matches() {
    let here = [(1, 0)];
    let frames = [0, 1, 0, 0, 1, 1, 0].map(|found| (&here[..], &here[..found]));
    let counts = counted(&frames);
    assert_eq!((counts.fragmentations, counts.misses, counts.matches, counts.switches), (1, 4, 3, 0));
    assert_eq!((counts.mostly_tracked, counts.partially_tracked, counts.mostly_lost), (0, 1, 0));
}

/// An object keeps its track while their overlap suffices, even if another track overlaps more.
#[test]
fn earlier_matches_are_kept() {
    let mut metric = ClearMot::new(&TrackMatchingParams::default()).unwrap();
    metric.count(&TrackingFrame::new(vec![1], vec![5], vec![0.9]).unwrap());
    let share = metric.count(&TrackingFrame::new(vec![1], vec![4, 5], vec![1.0, 0.5]).unwrap());
    assert_eq!(share, 0.5);
    let counts = metric.counts();
    assert_eq!((counts.matches, counts.switches, counts.false_positives), (2, 0, 1));
    assert!((counts.motp() - 0.3).abs() < 1e-12);
}

#[test]
fn sequences_are_independent_and_merge() {
    let frame = |track| TrackingFrame::new(vec![1], vec![track], vec![1.0]).unwrap();
    let new = || ClearMot::new(&TrackMatchingParams::default()).unwrap();
    let mut one = new();
    one.count(&frame(5));
    one.end_sequence();
    one.count(&frame(6));
    let (mut left, mut right) = (new(), new());
    left.count(&frame(5));
    right.count(&frame(6));
    left.merge(right);
    assert_eq!(left.counts(), one.counts());
    assert_eq!((one.counts().switches, one.counts().unique_objects), (0, 2));
}

#[test]
fn accuracy_is_undefined_without_objects() {
    let report = ClearMot::new(&TrackMatchingParams::default()).unwrap().finish();
    assert_eq!((report.statistics.get("mota"), report.statistics.get("objects")), (None, Some(0.0)));
    assert!(counted(&[(&[], &[(1, 0)])]).mota().is_nan());
}
