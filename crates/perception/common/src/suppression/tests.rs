use proptest::prelude::*;

use super::{Candidate, Suppression, SuppressionKind, iou};

fn candidate(index: u32, [x, y, w, h]: [f32; 4], score: f32, class: u32) -> Candidate {
    Candidate { corners: [x, y, x + w, y + h], score, class, index }
}

fn run(kind: SuppressionKind, mut candidates: Vec<Candidate>) -> Vec<Candidate> {
    Suppression { kind, iou_threshold: 0.5, threshold: 0.1, max_boxes: 100 }
        .run(&mut candidates, &mut Vec::new());
    candidates
}

fn kept(kind: SuppressionKind, candidates: Vec<Candidate>) -> Vec<u32> {
    run(kind, candidates).iter().map(|candidate| candidate.index).collect()
}

/// Returns three boxes in a row, each overlapping only its neighbours, and one of another class.
fn row() -> Vec<Candidate> {
    vec![
        candidate(0, [4.0, 0.0, 10.0, 10.0], 0.6, 0),
        candidate(1, [2.0, 0.0, 10.0, 10.0], 0.8, 0),
        candidate(2, [0.0, 0.0, 10.0, 10.0], 0.9, 0),
        candidate(3, [0.0, 0.0, 10.0, 10.0], 0.5, 1),
        candidate(4, [0.0, 0.0, 1.0, 1.0], 0.05, 0),
    ]
}

#[test]
fn each_method_on_a_row() {
    assert_eq!(kept(SuppressionKind::Hard, row()), [2, 0, 3]);
    assert_eq!(kept(SuppressionKind::Cluster, row()), [2, 0, 3]);
    assert_eq!(kept(SuppressionKind::Fast, row()), [2, 3]);
    let soft = run(SuppressionKind::Soft, row());
    assert_eq!(soft.iter().map(|candidate| candidate.index).collect::<Vec<_>>(), [2, 3, 0, 1]);
    let shared: f32 = 8.0 / 12.0;
    let (third, second) = (soft[2].score, soft[3].score);
    assert!((third - 0.6 * (-(6.0f32 / 14.0).powi(2) / 0.5).exp()).abs() < 1e-6, "{third}");
    assert!((second - 0.8 * (-shared * shared / 0.5).exp().powi(2)).abs() < 1e-6, "{second}");
}

#[test]
fn most_is_a_limit() {
    let mut candidates: Vec<_> =
        (0..5000).map(|at| candidate(at, [at as f32 * 20.0, 0.0, 10.0, 10.0], 0.5, 0)).collect();
    Suppression { kind: SuppressionKind::Hard, iou_threshold: 0.5, threshold: 0.1, max_boxes: 7 }
        .run(&mut candidates, &mut Vec::new());
    assert_eq!(candidates.iter().map(|candidate| candidate.index).collect::<Vec<_>>(), [0, 1, 2, 3, 4, 5, 6]);
}

fn any_candidates() -> impl Strategy<Value = Vec<Candidate>> {
    let edge = prop_oneof![9 => -50.0f32..50.0, 1 => Just(f32::NAN), 1 => Just(f32::INFINITY)];
    let one = (edge.clone(), edge, -5.0f32..40.0, -5.0f32..40.0, 0.0f32..1.0, 0u32..3);
    prop::collection::vec(one, 0..60).prop_map(|boxes| {
        let number =
            |(index, (x, y, w, h, score, class))| candidate(index as u32, [x, y, w, h], score, class);
        boxes.into_iter().enumerate().map(number).collect()
    })
}

proptest! {
    #[test]
    fn cluster_equals_hard(candidates in any_candidates()) {
        prop_assert_eq!(kept(SuppressionKind::Cluster, candidates.clone()), kept(SuppressionKind::Hard, candidates));
    }

    #[test]
    fn fast_keeps_no_more_than_hard(candidates in any_candidates()) {
        let hard = kept(SuppressionKind::Hard, candidates.clone());
        prop_assert!(kept(SuppressionKind::Fast, candidates).iter().all(|index| hard.contains(index)));
    }

    #[test]
    fn survivors_are_sorted_finite_and_apart(candidates in any_candidates()) {
        for kind in [SuppressionKind::Hard, SuppressionKind::Soft, SuppressionKind::Fast, SuppressionKind::Cluster] {
            let survivors = run(kind, candidates.clone());
            prop_assert!(survivors.windows(2).all(|pair| pair[0].score >= pair[1].score));
            prop_assert!(survivors.iter().flat_map(|candidate| candidate.corners).all(f32::is_finite));
            if kind != SuppressionKind::Soft {
                for (at, one) in survivors.iter().enumerate() {
                    let apart = |other: &Candidate| {
                        other.class != one.class || iou(&other.corners, &one.corners) <= 0.5
                    };
                    prop_assert!(survivors[..at].iter().all(apart));
                }
            }
        }
    }
}
