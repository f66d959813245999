//! Data sets are opened with the annotations that their user needs.

use std::fs;
use std::path::Path;

use opendr_datasets::{OpenOptions, Problems, open, open_for};
use opendr_engine::dataset::{DatasetRef, ExternalDataset};
use opendr_engine::params::ParamMap;
use opendr_engine::{ErrorKind, Silent, ValueType};
use opendr_evaluation::{DatasetOpener, score_coco_results};
use opendr_metrics::find;

#[test]
fn annotations_that_a_format_does_not_have_are_refused() {
    let pictures = ExternalDataset::new("none", "camvid");
    let options = OpenOptions { split: None, target: Some(ValueType::BoundingBoxList) };
    let error = open(&pictures, &options, &Problems::strict()).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    let expected = "a data set of format camvid has Heatmap, not BoundingBoxList";
    assert!(error.to_string().contains(expected), "{error}");
    let wanted = [ValueType::BoundingBoxList, ValueType::PoseList];
    let error = open_for("Somebody needs the annotations", &wanted, &pictures, None, &Problems::strict())
        .err()
        .unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    let expected = "Somebody needs the annotations BoundingBoxList or PoseList";
    assert!(error.to_string().contains(expected), "{error}");
}

#[test]
fn coco_results_are_not_compared_with_another_format() {
    let (metric, yolo) = (find("coco_detection").unwrap(), ExternalDataset::new("none", "yolo"));
    let error = score_coco_results(metric, &ParamMap::new(), Path::new("results.json"), &yolo, None, 1);
    assert_eq!(error.err().unwrap().kind(), ErrorKind::InvalidParam);
}

#[test]
fn a_training_reads_the_training_split() {
    let folder = std::env::temp_dir().join(format!("opendr-opening-{}", std::process::id()));
    for file in ["train/cat/1.jpg", "val/cat/2.jpg", "val/cat/3.jpg"] {
        let file = folder.join(file);
        fs::create_dir_all(file.parent().unwrap()).unwrap();
        fs::write(file, b"").unwrap();
    }
    let (external, problems) = (ExternalDataset::new(&folder, "imagenet"), Problems::strict());
    let accepted = vec![ValueType::Category];
    let opener = DatasetOpener { learner: "Somebody", accepted, problems: &problems, progress: &Silent };
    let given = || DatasetRef::External(&external);
    assert_eq!(opener.open_training(given(), None).unwrap().len(), 1);
    assert_eq!(opener.open_training(given(), Some("val")).unwrap().len(), 2);
    assert_eq!(opener.open_validation(given(), None).unwrap().len(), 2);
    fs::remove_dir_all(folder).unwrap();
}
