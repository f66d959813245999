use super::*;

fn new() -> Hota {
    Hota::new(&HotaParams { rules: MotRules::All }).unwrap()
}

/// One object over four frames: track 7 covers the first three (overlap 0.8, 0.8, 0.5), track 8 the last (0.8).
///
/// At 0.8 and below 0.5: matches 3 and 1. AssA = (3·3/(4+3-3) + 1·1/(4+1-1)) / 4 = (9/4 + 1/4) / 4 = 0.625.
/// At 0.65: matches 2 and 1. AssA = (2·2/(4+3-2) + 1/4) / 3 = (0.8 + 0.25) / 3 = 0.35, DetA = 3/(3+1+1) = 0.6.
#[test]
fn hand_computed() {
    let mut metric = new();
    for (track, overlap) in [(7, 0.8), (7, 0.8), (7, 0.5), (8, 0.8)] {
        metric.count(&TrackingFrame::new(vec![1], vec![track], vec![overlap]).unwrap());
    }
    let scores = metric.counts().scores();
    let near =
        |value: f64, expected: f64| assert!((value - expected).abs() < 1e-12, "{value} is not {expected}");
    near(scores.deta[0], 1.0);
    near(scores.assa[0], 0.625);
    near(scores.hota[0], 0.625f64.sqrt());
    near(scores.loca[0], 2.9 / 4.0);
    near(scores.deta[12], 0.6);
    near(scores.assa[12], 0.35);
    near(scores.assre[12], (2.0 * 2.0 / 4.0 + 1.0 / 4.0) / 3.0);
    near(scores.asspr[12], (2.0 * 2.0 / 3.0 + 1.0) / 3.0);
    assert_eq!((scores.hota[18], scores.loca[18]), (0.0, 1.0));
    // 0.5 is reached at 0.5, the tenth threshold, in spite of its rounding.
    assert_eq!(metric.counts().true_positives[9..11], [4, 3]);
}

#[test]
fn sequences_are_independent_and_merge() {
    let frame = |track| TrackingFrame::new(vec![1], vec![track], vec![1.0]).unwrap();
    let mut one = new();
    one.count(&frame(5));
    one.end_sequence();
    one.count(&frame(6));
    let (mut left, mut right) = (new(), new());
    left.count(&frame(5));
    right.count(&frame(6));
    left.merge(right);
    assert_eq!(left.counts(), one.counts());
    assert_eq!(one.finish().statistics.get("hota"), Some(1.0));
}

#[test]
fn frames_without_matches_count() {
    let mut metric = new();
    metric.count(&TrackingFrame::new(vec![1, 2], vec![], vec![]).unwrap());
    metric.count(&TrackingFrame::new(vec![], vec![3], vec![]).unwrap());
    let counts = metric.counts();
    assert_eq!((counts.false_negatives[0], counts.false_positives[18]), (2, 1));
    let report = metric.finish();
    assert_eq!((report.statistics.get("hota"), report.statistics.get("loca")), (Some(0.0), Some(1.0)));
}
