use std::collections::BTreeMap;

use opendr_engine::target::{BoundingBox, BoundingBoxList};

use super::*;

/// CamVid's eleven classes.
pub(super) const CAMVID: [&str; 11] = [
    "Sky",
    "Building",
    "Pole",
    "Road",
    "Pavement",
    "Tree",
    "SignSymbol",
    "Fence",
    "Car",
    "Pedestrian",
    "Bicyclist",
];

fn classes(names: &[&str]) -> Classes {
    names.iter().copied().collect()
}

fn map(learner: &[&str], dataset: &[&str]) -> ClassMap {
    ClassMap::new(classes(learner), classes(dataset), &ClassMatching::default()).unwrap()
}

fn labels(map: &Value) -> &[u32] {
    match map {
        Value::Heatmap(map) => match map.values() {
            HeatmapValues::Labels(labels) => labels,
            HeatmapValues::Scores(_) => panic!("scores"),
        },
        _ => panic!("another type"),
    }
}

#[test]
fn boxes_are_renamed_and_others_dropped() {
    let mut map = map(&["pedestrian", "kite", "airplane"], &["cat", "Person", "aeroplane"]);
    let boxes = [0, 1, 2].map(|class| BoundingBox::new(class, 0.0, 0.0, 1.0, 1.0, 0.5));
    let mut prediction = Value::from(BoundingBoxList::from(boxes.to_vec()));
    map.apply(&mut prediction).unwrap();
    let Value::BoundingBoxList(list) = prediction else { panic!("another type") };
    let names: Vec<_> = list.boxes.iter().map(|found| list.classes.label(&found.name).unwrap()).collect();
    assert_eq!(names, ["Person", "aeroplane"]);
    let report = map.report();
    assert_eq!((report.learner_only, report.dataset_only), (vec!["kite".into()], vec!["cat".into()]));
    assert!(report.pairs.iter().all(|pair| pair.by == MatchedBy::Synonym));
}

#[test]
fn categories_keep_their_probabilities() {
    let mut map = map(&["yes", "_silence_", "bed"], &["bed", "silence", "stop", "yes"]);
    let category = |class, probabilities: &[f32]| {
        Value::from(Category { probabilities: probabilities.to_vec(), ..Category::new(class, Some(0.75)) })
    };
    let mut prediction = category(1, &[0.125, 0.75, 0.125]);
    map.apply(&mut prediction).unwrap();
    let Value::Category(mapped) = &prediction else { panic!("another type") };
    assert_eq!((mapped.class, mapped.description.as_deref()), (1, Some("silence")));
    assert_eq!(mapped.probabilities, [0.125, 0.75, 0.0, 0.125]);
    assert!(map.apply(&mut category(0, &[0.5, 0.5])).is_err());
}

#[test]
fn an_unknown_category_is_wrong_and_named() {
    let mut map = map(&["a", "stranger", "b", "other"], &["b", "a"]);
    let probabilities = vec![0.0, 0.25, 0.25, 0.5];
    let mut prediction = Value::from(Category { probabilities, ..Category::new(3, Some(0.5)) });
    map.apply(&mut prediction).unwrap();
    let Value::Category(mapped) = &prediction else { panic!("another type") };
    assert_eq!((mapped.class, mapped.description.as_deref()), (3, Some("other")));
    assert_eq!(mapped.probabilities, [0.25, 0.0, 0.25, 0.5]);
    assert!(map.is_beyond(mapped.class) && !map.is_beyond(1));
}

#[test]
fn pixels_of_several_classes_merge_into_one() {
    let mut map = map(&["road", "rider", "bicycle", "moon"], &CAMVID);
    let mut heatmap = Heatmap::from_labels(vec![0, 1, 2, 3, 255], &[1, 5]).unwrap();
    heatmap.classes = classes(&["road", "rider", "bicycle", "moon"]);
    let mut prediction = Value::from(heatmap);
    map.apply(&mut prediction).unwrap();
    assert_eq!(labels(&prediction), [3, 10, 10, Heatmap::NO_CLASS, Heatmap::NO_CLASS]);
}

#[test]
fn scores_become_the_class_of_the_highest() {
    let mut map = map(&["dog", "cat"], &["cat", "dog"]);
    let mut heatmap = Heatmap::from_scores(vec![0.9, 0.2, 0.1, 0.8], &[2, 1, 2]).unwrap();
    heatmap.classes = classes(&["dog", "cat"]);
    let mut prediction = Value::from(heatmap);
    map.apply(&mut prediction).unwrap();
    assert_eq!(labels(&prediction), [1, 0]);
    // A depth map is not a class map.
    let depths = Value::from(Heatmap::from_scores(vec![1.0, 2.0], &[1, 2]).unwrap());
    let mut same = depths.clone();
    map.apply(&mut same).unwrap();
    assert_eq!(same, depths);
}

#[test]
fn segments_that_merge_into_a_class_are_renumbered() {
    let mut map = map(&["road", "car", "truck"], &CAMVID).with_labels(MapLabels::Segments);
    let mut heatmap = Heatmap::from_labels(vec![0, 1001, 1001, 2001, 1002, 2001], &[2, 3]).unwrap();
    heatmap.classes = classes(&["road", "car", "truck"]);
    let mut prediction = Value::from(heatmap);
    map.apply(&mut prediction).unwrap();
    assert_eq!(labels(&prediction), [3000, 8001, 8001, 8002, 8003, 8002]);
}

#[test]
fn unknown_classes_are_an_error_that_names_both_sides() {
    let unknown = map(&["cat", "dog", "kite"], &["gizmo", "widget", "cat"]);
    let error = unknown.check(None, "Do this").unwrap_err().to_string();
    for part in ["only 1 of 3", "cat, dog, kite", "gizmo, widget, cat", "Do this"] {
        assert!(error.contains(part), "{part:?} is not in {error:?}");
    }
    // Only classes that occur count.
    unknown.check(Some(&[2]), "").unwrap();
    // A learner whose only class matches is accepted.
    map(&["person"], &["gizmo", "widget", "person"]).check(None, "").unwrap();
}

#[test]
fn the_user_maps_or_compares_numbers() {
    let matching = ClassMatching {
        pairs: BTreeMap::from([
            ("lorry".to_owned(), "Gizmo".to_owned()),
            ("kite".to_owned(), "widget".to_owned()),
        ]),
        by_number: false,
    };
    let sides = || (classes(&["lorry", "kite"]), classes(&["widget", "gizmo"]));
    let (learner, dataset) = sides();
    let mut mapped = ClassMap::new(learner, dataset, &matching).unwrap();
    mapped.check(None, "").unwrap();
    assert_eq!(mapped.index(&Name::Index(0), &Classes::default()), Some(1));
    let matching = ClassMatching { by_number: true, ..ClassMatching::default() };
    let (learner, dataset) = sides();
    let mut numbered = ClassMap::new(learner, dataset, &matching).unwrap();
    assert_eq!(numbered.index(&Name::Index(0), &Classes::default()), Some(0));
    assert_eq!(numbered.report().by_number, Some(ByNumber::Requested));
    let wrong = ClassMatching { pairs: BTreeMap::from([("lorry".into(), "moon".into())]), by_number: false };
    let (learner, dataset) = sides();
    let error = ClassMap::new(learner, dataset, &wrong).unwrap_err().to_string();
    assert!(error.contains("moon") && error.contains("widget, gizmo"), "{error}");
}

#[test]
fn sides_without_names_are_compared_by_number_and_reported() {
    let nameless = map(&["cat"], &[]);
    assert_eq!(nameless.report().by_number, Some(ByNumber::DatasetUnnamed));
    let mut unnamed = map(&[], &["cat", "dog"]);
    assert_eq!(unnamed.report().by_number, None);
    assert_eq!(unnamed.index(&Name::Index(1), &Classes::default()), Some(1));
    assert_eq!(unnamed.report().by_number, Some(ByNumber::LearnerUnnamed));
    // A number in a list with names is not a class.
    let mut partly = map(&["cat"], &["cat", "dog"]);
    assert_eq!(partly.index(&Name::Index(1), &Classes::default()), None);
    assert_eq!(partly.report().learner_only, ["class 1"]);
}
