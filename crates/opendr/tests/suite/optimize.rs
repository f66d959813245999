//! NanoDet in INT8 and FP16, evaluated before and after.

use std::path::{Path, PathBuf};

use opendr::dataset::{DatasetIterator, ExternalDataset};
use opendr::datasets::Problems;
use opendr::optimize::{OptimizeJob, OptimizeOptions, Precision, Report};
use opendr::{Device, Silent};

use crate::models::Models;

struct Output(PathBuf);

impl Drop for Output {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

fn coco128(models: &Models, split: &str) -> Box<dyn DatasetIterator> {
    let entry = opendr::registry().find("nanodet").unwrap();
    let metric = opendr::metrics::find(opendr::evaluation::metric_of(entry.spec.task).unwrap()).unwrap();
    let data = ExternalDataset::new(models.data("coco128/object_detection"), "yolo");
    opendr::evaluation::open_for_metric(metric, &data, Some(split.to_owned()), &Problems::strict()).unwrap()
}

fn optimized(models: &Models, model: &Path, precision: Precision) -> Report {
    let output =
        std::env::temp_dir().join(format!("opendr-nanodet-{}-{}", precision.name(), std::process::id()));
    let output = Output(output);
    let (train, val) = (coco128(models, "train"), coco128(models, "val"));
    let job = OptimizeJob {
        entry: opendr::registry().find("nanodet").unwrap(),
        model,
        options: &OptimizeOptions {
            precision,
            samples: 16,
            measured_by: Some("map50".to_owned()),
            ..OptimizeOptions::default()
        },
        calibration: Some(&*train),
        validation: Some(&*val),
        output: &output.0,
        device: Device::Cpu,
        progress: &Silent,
    };
    job.run().unwrap()
}

#[test]
fn nanodet_in_a_quarter_and_in_a_half_of_its_size() {
    let Some(models) = Models::find() else { return };
    let Some(model) = models.get("nanodet") else { return };
    for (precision, most_bytes, most_drop) in [(Precision::Int8, 0.3, 0.02), (Precision::Fp16, 0.52, 0.002)] {
        let report = optimized(&models, &model, precision);
        println!("{report}");
        let accuracy = report.accuracy.as_ref().unwrap();
        assert!(accuracy.before > 0.4, "{report}");
        assert!(accuracy.before - accuracy.after <= most_drop, "{report}");
        assert!(report.bytes[1] as f64 <= most_bytes * report.bytes[0] as f64, "{report}");
    }
}
