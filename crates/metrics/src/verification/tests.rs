use super::*;

fn counted(folds: usize, pairs: &[(bool, f64)]) -> Verification {
    let params = VerificationParams { folds, ..VerificationParams::default() };
    let mut verification = Verification::new(&params).unwrap();
    for (at, (same, score)) in pairs.iter().enumerate() {
        verification.add(at, *same, *score).unwrap();
    }
    verification
}

#[test]
fn folds_are_consecutive() {
    // Folds 0 1 2, 3 4: the threshold of each is selected on the other.
    let pairs = [(true, 0.9), (false, 0.2), (true, 0.3), (true, 0.5), (false, 0.4)];
    let folds = counted(2, &pairs).fold_accuracies().unwrap();
    let [first, second] = folds[..] else { panic!("{folds:?}") };
    assert_eq!((first.threshold, first.accuracy), (0.5, 2.0 / 3.0));
    assert_eq!((second.threshold, second.accuracy), (0.3, 0.5));
    assert_eq!(counted(10, &pairs).fold_accuracies(), None);
}

#[test]
fn order_is_that_of_the_indices() {
    let pairs = [(true, 0.9), (false, 0.2), (true, 0.3), (true, 0.5), (false, 0.4)];
    let whole = counted(2, &pairs);
    let mut reversed = counted(2, &[]);
    for (at, (same, score)) in pairs.iter().enumerate().rev() {
        let mut part = counted(2, &[]);
        part.add(at, *same, *score).unwrap();
        reversed.merge(part);
    }
    assert_eq!(reversed.finish(), whole.finish());
}

#[test]
fn no_pair_is_the_same() {
    let folds = counted(2, &[(false, 0.5), (false, 0.7)]).fold_accuracies().unwrap();
    assert_eq!(folds[0], FoldAccuracy { threshold: f64::INFINITY, accuracy: 1.0 });
    let report = counted(2, &[(false, 0.5), (false, 0.7)]).finish();
    assert_eq!(report.statistics.get("accuracy"), Some(1.0));
    assert_eq!(report.statistics.get("equal_error_rate"), None);
    assert_eq!(report.statistics.get("tar_at_far_1e-1"), None);
    assert_eq!(report.tables[0].rows[0], ("1".to_owned(), vec![Some(1.0), None]));
}

#[test]
fn rates_of_a_small_curve() {
    let curve = counted(2, &[(true, 0.9), (false, 0.8), (true, 0.7), (false, 0.1)]).curve();
    let found = |rate| curve.at_false_accept_rate(rate).map(|point| (point.threshold, point.true_positives));
    assert_eq!(found(0.0), Some((0.9, 1)));
    assert_eq!(found(0.49), Some((0.9, 1)));
    assert_eq!(found(0.5), Some((0.7, 2)));
    assert_eq!(found(1.0), Some((0.1, 2)));
    assert_eq!(curve.equal_error_rate(), Some(0.5));
    let (point, accuracy) = curve.best_accuracy().unwrap();
    assert_eq!((point.threshold, accuracy), (0.9, 0.75));
}

#[test]
fn equal_error_rate_at_the_ends() {
    let perfect = counted(2, &[(true, 1.0), (false, 0.0)]).curve();
    assert_eq!(perfect.equal_error_rate(), Some(0.0));
    let worst = counted(2, &[(true, 0.0), (false, 1.0)]).curve();
    assert_eq!(worst.equal_error_rate(), Some(1.0));
    let blind = counted(2, &[(true, 0.5), (false, 0.5)]).curve();
    assert_eq!(blind.equal_error_rate(), Some(0.5));
}

#[test]
fn predictions_without_score_are_rejected() {
    let mut verification = Verification::default();
    let ground_truth = Category::new(1, None);
    assert!(verification.update(0, &Category::new(1, None), &ground_truth).is_err());
    assert!(verification.update(0, &Category::new(1, Some(f32::INFINITY)), &ground_truth).is_err());
    assert_eq!(verification.update(0, &Category::new(0, Some(0.25)), &ground_truth).unwrap(), 0.25);
}
