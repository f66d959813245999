//! Trains the panoptic segmentation of lidar scans on simulated streets and measures it on other streets.
//!
//! ```console
//! $ cargo run --release -p opendr-panoptic --features training --example train_scans -- out 4000
//! ```
//!
//! The second argument is the number of optimiser steps, of four scans each; with 0 the example only measures the model in
//! `out`. An interrupted training resumes.

use std::path::Path;
use std::time::Instant;

use opendr_clouds::object_detection_3d::Scan;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{Device, Error, Result, Value};
use opendr_metrics::{Metric, Panoptic, PanopticParams};
use opendr_panoptic::panoptic_segmentation::{EfficientLps, EfficientLpsFitParams, EfficientLpsParams};
use opendr_simulation::street::StreetSegments;
use opendr_training::TrainingParams;

/// Seeds and numbers of the streets for training and testing.
const TRAINING: (u64, usize) = (1, 40_000);
const TEST: (u64, usize) = (2, 100);

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [output, steps] = &arguments[..] else {
        return Err(Error::invalid_param("usage: train_scans OUTPUT_FOLDER STEPS"));
    };
    let steps: u64 =
        steps.parse().map_err(|_| Error::invalid_param("the second argument must be a number of steps"))?;
    let things = StreetSegments::THINGS.to_vec();
    let params = EfficientLpsParams { things: things.clone(), ..Default::default() };
    let mut handle = Handle::<EfficientLps>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, resume: true, ..FitJob::new(Path::new(output)) };
    if steps > 0 {
        let defaults = EfficientLpsFitParams::default();
        let training = TrainingParams {
            max_steps: steps,
            epochs: (4 * steps as usize).div_ceil(TRAINING.1),
            checkpoint_after_iter: 100,
            ..defaults.training
        };
        let fit_params = EfficientLpsFitParams { training, ..defaults };
        let streets = StreetSegments::new(TRAINING.0, TRAINING.1);
        println!("{}", handle.fit(&fit_params, (&streets as &dyn DatasetIterator).into(), None, &job)?);
    } else {
        handle.load(job.model())?;
    }
    let streets = StreetSegments::new(TEST.0, TEST.1);
    let mut metric = Panoptic::new(&PanopticParams { things, ..Default::default() })?;
    let mut seconds = 0.0;
    for index in 0..streets.len() {
        let sample = streets.get(index)?;
        let (Some(Value::PointCloudWithCalibration(scan)), Some(Value::Heatmap(ground_truth))) =
            (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("the sample has no labelled scan"));
        };
        let begin = Instant::now();
        let found = handle.infer(Scan::from(scan))?;
        seconds += begin.elapsed().as_secs_f64();
        metric.update(index, &found.instance, ground_truth)?;
    }
    for (name, value) in &metric.finish().statistics.scalars {
        println!("{name} {value:.4}");
    }
    println!("{} streets, {:.1} ms each", streets.len(), 1e3 * seconds / streets.len() as f64);
    Ok(())
}
