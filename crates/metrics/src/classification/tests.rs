use super::*;

fn counted(pairs: &[(i64, i64)]) -> Classification {
    let mut classification = Classification::default();
    pairs.iter().for_each(|(ground_truth, predicted)| classification.add(*ground_truth, *predicted));
    classification
}

/// The example of scikit-learn's documentation: cat, dog, pig.
fn example() -> Classification {
    counted(&[(0, 0), (1, 2), (2, 1), (0, 0), (1, 0), (2, 1)])
}

#[test]
fn averages_match_the_documentation_of_scikit_learn() {
    let scores = example().scores();
    let third = Some(1.0 / 3.0);
    assert_eq!(scores.micro, PrecisionRecall { precision: third, recall: third, f1: third });
    assert_eq!(scores.macro_.precision, Some(2.0 / 9.0));
    assert_eq!(scores.macro_.recall, third);
    assert!((scores.macro_.f1.unwrap() - 0.8 / 3.0).abs() < 1e-12);
    assert_eq!(scores.classes[0].scores.f1, Some(0.8));
    assert_eq!(scores.classes[0].support, 2);
    assert_eq!(counted(&[(0, 0), (0, 1)]).balanced_accuracy(), Some(0.5));
}

#[test]
fn equal_scores_rank_by_class_number() {
    let mut classification = Classification::default();
    classification.add_scores(1, &[0.25, 0.25, 0.5]).unwrap();
    classification.add_scores(0, &[0.25, 0.25, 0.5]).unwrap();
    assert_eq!([1, 2, 3, 9].map(|k| classification.top_k(k)), [0.0, 0.5, 1.0, 1.0].map(Some));
    assert_eq!(Classification::default().top_k(1), None);
}

#[test]
fn rejected_predictions_are_not_counted() {
    let mut classification = Classification::default();
    let ground_truth = Category::new(1, None);
    let mut rejected = |class, confidence, probabilities: &[f32]| {
        let prediction =
            Category { probabilities: probabilities.to_vec(), ..Category::new(class, confidence) };
        classification.update(0, &prediction, &ground_truth).unwrap_err().to_string()
    };
    assert!(rejected(0, None, &[1.0]).starts_with("class 1 has none of 1 scores"));
    assert_eq!(rejected(0, None, &[1.0, f32::NAN]), "score of class 1 is NaN; give numbers");
    assert!(rejected(0, Some(f32::NAN), &[0.5, 0.5]).contains("NaN is not in 0..=1"));
    assert!(rejected(0, Some(1.5), &[]).contains("1.5 is not in 0..=1"));
    assert_eq!(classification.finish(), Classification::default().finish());
}

#[test]
fn duplicate_labels_are_rejected() {
    let params = ClassificationParams { labels: vec![3, 1, 3], ..ClassificationParams::default() };
    let error = Classification::new(&params).unwrap_err();
    assert_eq!(error.to_string(), "labels contain class 3 twice; give each class once");
}

#[test]
fn confusion_matrix_covers_classes_that_occur() {
    let classification = counted(&[(5, -1), (5, 5), (5, 5)]);
    assert_eq!(classification.labels(), [-1, 5]);
    assert_eq!(classification.confusion(&[-1, 5]), [0, 0, 1, 2]);
    let many: Vec<_> = (0..1001).map(|class| (class, class)).collect();
    assert!(counted(&many).finish().figures.is_empty());
}

#[test]
fn parts_merge_to_the_whole() {
    let samples =
        [(0, [0.5, 0.25, 0.25]), (1, [0.25, 0.0, 0.75]), (2, [0.0, 1.0, 0.0]), (2, [0.5, 0.5, 0.0])];
    let [mut whole, mut even, mut odd] = [(); 3].map(|()| Classification::default());
    for (at, (ground_truth, probabilities)) in samples.iter().enumerate() {
        let best = if probabilities[1] >= 0.5 { 1 } else { 0 };
        let prediction = Category { probabilities: probabilities.to_vec(), ..Category::new(best, None) };
        let ground_truth =
            Category { description: Some("thing".into()), ..Category::new(*ground_truth, None) };
        for part in [&mut whole, if at % 2 == 0 { &mut even } else { &mut odd }] {
            part.update(at, &prediction, &ground_truth).unwrap();
        }
    }
    odd.merge(even);
    let report = odd.finish();
    assert_eq!(report, whole.finish());
    assert_eq!(report.statistics.get("samples"), Some(4.0));
    assert_eq!(report.statistics.get("accuracy"), Some(0.25));
    assert_eq!(report.tables[0].rows[2].0, "thing");
}

#[test]
fn empty_accumulator() {
    let report = Classification::default().finish();
    assert_eq!(report.statistics.get("samples"), Some(0.0));
    assert_eq!(report.statistics.get("accuracy"), None);
    assert!(report.figures.is_empty());
}
