//! `eval` of trackers on the detections of a MOT data set.

use std::fmt::Write as _;
use std::fs;
use std::path::PathBuf;

use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::evaluation::EvalOptions;
use opendr::params::ParamMap;
use opendr::{Device, Silent, TuneData, TuneOptions};

use crate::models::Models;

/// Two videos in which two persons walk past each other; one in ten boxes is missing, and each video has a false positive.
fn folder(name: &str) -> PathBuf {
    let root = std::env::temp_dir().join(format!("opendr-{name}-{}", std::process::id()));
    fs::remove_dir_all(&root).ok();
    for video in 0..2 {
        let (mut ground_truth, mut found) = (String::new(), String::new());
        for frame in 1..=60 {
            for person in 0..2 {
                let left = if person == 0 { 5 * frame } else { 400 - 5 * frame };
                let top = 40 + 70 * person;
                writeln!(ground_truth, "{frame},{},{left},{top},40,100,1,1,1", person + 1).unwrap();
                if (frame + 5 * person + video) % 10 != 0 {
                    writeln!(found, "{frame},-1,{left},{top},40,100,0.9").unwrap();
                }
            }
        }
        writeln!(found, "30,-1,600,300,40,100,0.8").unwrap();
        for (file, text) in [("gt/gt.txt", ground_truth), ("det/det.txt", found)] {
            let path = root.join(format!("train/V{video}")).join(file);
            fs::create_dir_all(path.parent().unwrap()).unwrap();
            fs::write(path, text).unwrap();
        }
    }
    root
}

#[test]
fn trackers_are_measured_on_what_was_found() {
    let Some(models) = Models::find() else { return };
    let folder = folder("tracker-eval");
    for name in ["sort", "byte_track", "oc_sort", "c_biou"] {
        let entry = opendr::registry().find(name).unwrap();
        let mut learner = entry.make(&ParamMap::new(), Device::Cpu).unwrap();
        learner.load(&models.get(name).unwrap()).unwrap();
        let external = ExternalDataset::new(folder.clone(), "mot");
        let score = |metric: &str, learner: &mut _| {
            let options = EvalOptions { metric: Some(metric.to_owned()), ..EvalOptions::default() };
            let dataset = DatasetRef::External(&external);
            let outcome = options.run(learner, entry, dataset, &Silent).unwrap();
            assert!(outcome.complete && outcome.counted == 120, "{name}");
            outcome.report.statistics.scalars.clone()
        };
        let (hota, identity) = (score("hota", &mut learner), score("identity", &mut learner));
        println!("{name}: HOTA {:.3}, IDF1 {:.3}", hota["hota"], identity["idf1"]);
        assert!(hota["hota"] > 0.85 && identity["idf1"] > 0.9, "{name}: {hota:?} {identity:?}");
    }
    fs::remove_dir_all(&folder).ok();
}

#[test]
fn a_tracker_is_tuned_without_a_training() {
    let Some(models) = Models::find() else { return };
    let (folder, output) =
        (folder("tracker-tune"), std::env::temp_dir().join(format!("opendr-tuned-{}", std::process::id())));
    fs::remove_dir_all(&output).ok();
    let entry = opendr::registry().find("byte_track").unwrap();
    let container = models.get("byte_track").unwrap();
    let make = |params: &ParamMap| {
        let mut learner = entry.make(params, Device::Cpu)?;
        learner.load(&container)?;
        Ok(learner)
    };
    let external = ExternalDataset::new(folder.clone(), "mot");
    let data = TuneData::Inference {
        make: &make,
        dataset: DatasetRef::External(&external),
        split: None,
        metric: Some("identity"),
    };
    // Boxes have 0.9: above that no track begins.
    let options = |trials| TuneOptions {
        search: vec!["new_threshold=0.3,0.95".into(), "track_buffer=1..30".into()],
        fit_params: ParamMap::new(),
        params: ParamMap::new(),
        trials,
        seeds: 3,
        steps: 1000,
        interval: 10,
        pruner: "asha".into(),
        jobs: 1,
        timeout: None,
        seed: 1,
        device: Device::Cpu,
    };
    let tune = |trials| opendr::tune(entry, data, &options(trials), &output, &|_, _| (), &Silent).unwrap();
    let first = tune(4);
    assert!(first.complete && first.trials == 4 && first.fresh_values.is_empty(), "{first}");
    let tuned = tune(10);
    assert!(tuned.complete && tuned.trials == 10 && tuned.value.unwrap() > 0.9, "{tuned}");
    assert_eq!(tuned.params.unwrap()["new_threshold"], 0.3);
    let mut other = options(1);
    other.search = vec!["lr".into()];
    let error = opendr::tune(entry, data, &other, &output, &|_, _| (), &Silent).unwrap_err();
    assert!(error.to_string().contains("track_buffer"), "{error}");
    fs::remove_dir_all(&folder).ok();
    fs::remove_dir_all(&output).ok();
}
