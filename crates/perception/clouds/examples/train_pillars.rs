//! Trains PointPillars on simulated streets and measures it on other streets.
//!
//! The scans are synthetic: boxes with hoods and roofs on sloping ground, scanned by a ray caster with the geometry, noise and
//! losses of KITTI's lidar (`opendr_simulation::street`). The example produces the zoo's
//! `voxel_object_detection_3d/pointpillars_car`:
//!
//! ```console
//! $ cargo run --release -p opendr-clouds --features training --example train_pillars -- out 4000
//! ```
//!
//! The second argument is the number of optimiser steps, of four scans each. With 0 the example only measures the model in
//! `out`. With a folder of KITTI's object benchmark as third argument, its cars within 30 metres are counted, too. An
//! interrupted training resumes.

use std::path::Path;
use std::time::Instant;

use opendr_clouds::object_detection_3d::{
    Scan, VoxelObjectDetection3d, VoxelObjectDetection3dFitParams, VoxelObjectDetection3dParams,
};
use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::overlap::UprightBox3D;
use opendr_engine::target::{BoundingBox3D, BoundingBox3DList};
use opendr_engine::{Device, Error, Progress, Result, Unit, Value};
use opendr_metrics::{Kitti, Metric};
use opendr_simulation::street::StreetScans;
use opendr_training::TrainingParams;

/// Seeds and numbers of the streets for training and testing.
const TRAINING: (u64, usize) = (1, 40_000);
const TEST: (u64, usize) = (2, 200);

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (output, steps, kitti) = match &arguments[..] {
        [output, steps] => (Path::new(output), steps, None),
        [output, steps, kitti] => (Path::new(output), steps, Some(kitti)),
        _ => return Err(Error::invalid_param("usage: train_pillars OUTPUT_FOLDER STEPS [KITTI_FOLDER]")),
    };
    let steps: u64 =
        steps.parse().map_err(|_| Error::invalid_param("the second argument must be a number of steps"))?;
    let params = VoxelObjectDetection3dParams { threshold: 0.05, ..Default::default() };
    let mut handle = Handle::<VoxelObjectDetection3d>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, resume: true, progress: &Lines, ..FitJob::new(output) };
    if steps > 0 {
        let defaults = VoxelObjectDetection3dFitParams::default();
        let training = TrainingParams {
            max_steps: steps,
            epochs: (4 * steps as usize).div_ceil(TRAINING.1),
            checkpoint_after_iter: 250,
            log_after: 10,
            lr: 3e-3,
            ..defaults.training
        };
        let fit_params = VoxelObjectDetection3dFitParams { pillar: 0.4, training, ..defaults };
        let streets = StreetScans::new(TRAINING.0, TRAINING.1);
        println!("{}", handle.fit(&fit_params, (&streets as &dyn DatasetIterator).into(), None, &job)?);
    } else {
        handle.load(job.model())?;
    }
    let streets = StreetScans::new(TEST.0, TEST.1);
    let mut metric = Kitti::default();
    let (mut seconds, mut near) = (0.0, [0; 3]);
    for index in 0..streets.len() {
        let (found, ground_truth, took) = predict(&mut handle, &streets, index)?;
        metric.update(index, &found, &ground_truth)?;
        seconds += took;
        // Fully hidden cars are ignored; KITTI's occlusion 3 is "unknown".
        let counted = within_30_metres(&found, &ground_truth, 3);
        near = [0, 1, 2].map(|at| near[at] + counted[at]);
    }
    for (name, value) in &metric.finish().statistics.scalars {
        if name.starts_with("car") {
            println!("{name} {value:.4}");
        }
    }
    println!("{} streets, {:.1} ms each", streets.len(), 1e3 * seconds / streets.len() as f64);
    println!("cars within 30 m: {} detected, {} missed, {} false positives", near[0], near[1], near[2]);
    let Some(kitti) = kitti else { return Ok(()) };
    let dataset =
        open(&ExternalDataset::new(kitti, "kitti"), &OpenOptions::default(), &Problems::skipping())?;
    for index in 0..dataset.len() {
        let (found, ground_truth, took) = predict(&mut handle, &*dataset, index)?;
        let [hit, missed, wrong] = within_30_metres(&found, &ground_truth, i32::MAX);
        println!(
            "KITTI {}: {hit} detected, {missed} missed, {wrong} false positives within 30 m; {:.0} ms",
            dataset.name(index),
            1e3 * took
        );
        println!("{found:#}");
    }
    Ok(())
}

fn predict(
    handle: &mut Handle<VoxelObjectDetection3d>,
    dataset: &dyn DatasetIterator,
    index: usize,
) -> Result<(BoundingBox3DList, BoundingBox3DList, f64)> {
    let sample = dataset.get(index)?;
    let scan = match sample.data.first() {
        Some(Value::PointCloudWithCalibration(scan)) => Scan::from(scan),
        Some(Value::PointCloud(cloud)) => Scan::from(cloud),
        _ => return Err(Error::invalid_input("the sample has no scan")),
    };
    let Some(Value::BoundingBox3DList(ground_truth)) = sample.target else {
        return Err(Error::invalid_input("the sample has no boxes"));
    };
    let begin = Instant::now();
    let found = handle.infer(scan)?;
    Ok((found, ground_truth, begin.elapsed().as_secs_f64()))
}

/// Minimum score of a counted detection.
const MIN_SCORE: f32 = 0.3;

/// Returns the numbers of detected, missed and falsely detected cars within 30 metres; boxes match from a volume IoU of 0.5.
/// Cars with an occlusion of at least `hidden` are ignored.
fn within_30_metres(found: &BoundingBox3DList, ground_truth: &BoundingBox3DList, hidden: i32) -> [usize; 3] {
    let near = |found: &&BoundingBox3D| {
        found.location[0].hypot(found.location[2]) < 30.0 && found.name == "Car".into()
    };
    let standing = |found: &BoundingBox3D| {
        let (size, place) = (found.dimensions.map(f64::from), found.location.map(f64::from));
        UprightBox3D::from_kitti(size, place, f64::from(found.rotation_y))
    };
    let all: Vec<_> = ground_truth
        .boxes
        .iter()
        .filter(|ground_truth| ground_truth.name == "Car".into())
        .map(standing)
        .collect();
    let predicted: Vec<_> =
        found.boxes.iter().filter(near).filter(|found| found.confidence >= MIN_SCORE).map(standing).collect();
    let asked = ground_truth
        .boxes
        .iter()
        .filter(near)
        .filter(|ground_truth| ground_truth.occluded < hidden)
        .map(standing);
    let (mut hit, mut missed) = (0, 0);
    for car in asked {
        let is_found = predicted.iter().any(|object| object.iou(&car) > 0.5);
        *if is_found { &mut hit } else { &mut missed } += 1;
    }
    let wrong = predicted.iter().filter(|object| all.iter().all(|car| object.iou(car) <= 0.5)).count();
    [hit, missed, wrong]
}

/// Prints the progress.
struct Lines;

impl Progress for Lines {
    fn begin(&self, what: &str, total: Option<u64>, _: Unit) {
        println!("{what}: {total:?}");
    }

    fn advance(&self, _: u64) {}

    fn end(&self) {}

    fn status(&self, text: &str) {
        println!("{text}");
    }

    fn note(&self, line: &str) {
        println!("{line}");
    }
}
