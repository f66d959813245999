//! Panoptic segmentation with real weights.

use opendr::data::Image;
use opendr::dataset::{DatasetIterator as _, ExternalDataset};
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::learner::{AnyLearner, Ports};
use opendr::metrics::{Metric as _, Panoptic, PanopticParams};
use opendr::params::ParamMap;
use opendr::target::{Heatmap, HeatmapValues};
use opendr::{Device, Value, ValueType};

use crate::models::Models;

fn efficient_ps(models: &Models) -> Option<Box<dyn AnyLearner>> {
    let model = models.get("efficient_ps")?;
    let entry = opendr::registry().find("efficient_ps").unwrap();
    let mut learner = entry.make(&ParamMap::new(), Device::Cpu).unwrap();
    learner.load(&model).unwrap();
    Some(learner)
}

fn maps(learner: &mut dyn AnyLearner, image: &Image) -> [Heatmap; 2] {
    let answer = learner.infer(&Ports::one(image)).unwrap();
    ["instance", "semantic"].map(|name| match answer.get(name) {
        Some(Value::Heatmap(map)) => map.clone(),
        _ => panic!("{answer:?}"),
    })
}

fn labels(map: &Heatmap) -> &[u32] {
    match map.values() {
        HeatmapValues::Labels(labels) => labels,
        HeatmapValues::Scores(_) => panic!("no labels"),
    }
}

#[test]
fn the_bus_and_those_before_it() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = efficient_ps(&models) else { return };
    let image = opendr::vision::open(models.data("photos/bus.jpg")).unwrap();
    let [instance, semantic] = maps(&mut *learner, &image);
    assert_eq!([instance.shape(), semantic.shape()], [[1080, 810]; 2]);
    for (label, class) in labels(&instance).iter().zip(labels(&semantic)) {
        assert_eq!(label / 1000, *class);
    }
    let share = |wanted: u32| {
        let count = labels(&instance).iter().filter(|label| **label == wanted).count();
        count as f64 / (1080.0 * 810.0)
    };
    // Persons are class 0, buses class 5.
    assert!(share(5001) > 0.2 && share(5002) == 0.0, "{instance:#}");
    assert!((1..=3).all(|person| share(person) > 0.015), "{instance:#}");
}

#[test]
fn nothing_is_seen_in_the_dark() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = efficient_ps(&models) else { return };
    let black = Image::from_rgb8(vec![0; 64 * 48 * 3], 64, 48).unwrap();
    let [instance, _] = maps(&mut *learner, &black);
    assert!(labels(&instance).iter().all(|label| label % 1000 == 0), "{instance:#}");
}

#[test]
fn quality_on_coco() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = efficient_ps(&models) else { return };
    let pictures = ExternalDataset::new(models.data("coco128/panoptic_segmentation"), "coco_panoptic");
    let options = OpenOptions { target: Some(ValueType::Heatmap), ..OpenOptions::default() };
    let pictures = open(&pictures, &options, &Problems::strict()).unwrap();
    let params = PanopticParams { things: (0..80).collect(), ..PanopticParams::default() };
    let mut metric = Panoptic::new(&params).unwrap();
    for index in 0..pictures.len() {
        let sample = pictures.get(index).unwrap();
        let (Some(Value::Image(image)), Some(Value::Heatmap(ground_truth))) =
            (sample.data.first(), &sample.target)
        else {
            panic!("no maps")
        };
        let [instance, _] = maps(&mut *learner, image);
        metric.update(index, &instance, ground_truth).unwrap();
    }
    let report = metric.finish();
    let number = |key: &str| report.statistics.get(key).unwrap();
    let [quality, things, stuff] = ["pq", "pq_things", "pq_stuff"].map(number);
    let person = metric.counts()[&0].quality();
    println!(
        "{} pictures: PQ {quality:.4}, things {things:.4}, stuff {stuff:.4}, persons {person:.4}",
        pictures.len()
    );
    assert!(quality >= 0.11 && things >= 0.18 && person >= 0.27);
}
