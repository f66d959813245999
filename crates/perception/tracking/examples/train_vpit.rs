//! Trains VPIT on simulated drives, and evaluates it on others.
//!
//! The scans are synthetic: cars, trucks and pedestrians that move and stand on sloping streets, from a moving car with a ray
//! caster with the geometry, noise and dropouts of KITTI's lidar (`opendr_simulation::street`). It trains the zoo's
//! `vpit/streets`:
//!
//! ```console
//! $ cargo run --release -p opendr-tracking --features training --example train_vpit -- out 1500
//! ```
//!
//! The second argument is the number of optimiser steps, of eight pairs of scans each. With 0 it only evaluates the model in
//! `out`. A further call resumes the training.

use std::path::Path;
use std::time::Instant;

use opendr_clouds::object_detection_3d::Scan;
use opendr_engine::data::PointCloudWithCalibration;
use opendr_engine::dataset::DatasetIterator;
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::overlap::UprightBox3D;
use opendr_engine::target::{BoundingBox3D, BoundingBox3DList, TrackingAnnotation3DList};
use opendr_engine::{Device, Error, Progress, Result, Unit, Value};
use opendr_simulation::street::StreetDrives;
use opendr_tracking::object_tracking_3d::{Extrapolation, Vpit, VpitFitParams, VpitInputs, VpitParams};
use opendr_training::TrainingParams;

/// Drives for training and for evaluation: seed, number of drives, frames per drive.
const TRAINING: (u64, usize, usize) = (11, 4000, 8);
const TEST: (u64, usize, usize) = (12, 20, 40);

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [output, steps, rest @ ..] = &arguments[..] else {
        return Err(Error::invalid_param("give a folder for the model and a number of steps"));
    };
    let steps: u64 =
        steps.parse().map_err(|_| Error::invalid_param("the second argument is a number of steps"))?;
    let job =
        FitJob { device: Device::Cpu, resume: true, progress: &Lines, ..FitJob::new(Path::new(output)) };
    let mut handle = Handle::<Vpit>::new(VpitParams::default(), Device::Cpu)?;
    if steps > 0 {
        let defaults = VpitFitParams::default();
        let training = TrainingParams {
            max_steps: steps,
            epochs: (8 * steps as usize).div_ceil(TRAINING.1 * TRAINING.2),
            checkpoint_after_iter: 100,
            log_after: 10,
            ..defaults.training
        };
        let drives = StreetDrives::new(TRAINING.0, TRAINING.1, TRAINING.2);
        let fit_params = VpitFitParams { training, ..defaults };
        println!("{}", handle.fit(&fit_params, (&drives as &dyn DatasetIterator).into(), None, &job)?);
    }
    let drives = StreetDrives::new(TEST.0, TEST.1, TEST.2);
    let frames = (0..drives.len()).map(|index| frame(&drives, index)).collect::<Result<Vec<_>>>()?;
    let number = |at: usize, usual: f32| rest.get(at).and_then(|text| text.parse().ok()).unwrap_or(usual);
    let params = VpitParams {
        window_influence: number(0, VpitParams::default().window_influence),
        target_feature_merge_scale: number(1, 0.0),
        offset_interpolation: number(2, 1.0),
        min_top_score: number(3, 0.0),
        ..VpitParams::default()
    };
    measure("VPIT", params.clone(), &job, &frames)?;
    // The baseline of a box that does not move.
    let blind = VpitParams { min_top_score: 1.0, extrapolation_mode: Extrapolation::None, ..params };
    measure("a box that does not move", blind, &job, &frames)
}

type Frame = (PointCloudWithCalibration, TrackingAnnotation3DList);

fn frame(drives: &StreetDrives, index: usize) -> Result<Frame> {
    let sample = drives.get(index)?;
    match (sample.data.into_iter().next(), sample.target) {
        (Some(Value::PointCloudWithCalibration(scan)), Some(Value::TrackingAnnotation3DList(tracks))) => {
            Ok((scan, tracks))
        }
        _ => Err(Error::invalid_input("the sample is not a scan with tracks")),
    }
}

fn standing(found: &BoundingBox3D) -> UprightBox3D {
    let (size, place) = (found.dimensions.map(f64::from), found.location.map(f64::from));
    UprightBox3D::from_kitti(size, place, f64::from(found.rotation_y))
}

/// Tracks each car and each pedestrian that is clearly visible in the first frame of a drive to its end, and prints success
/// and precision of single-object tracking (areas under the curves over the overlap, 0 to 1, and over the distance, 0 to 2
/// m; in percent), over the frames in which it is visible.
fn measure(what: &str, params: VpitParams, job: &FitJob<'_>, frames: &[Frame]) -> Result<()> {
    let mut handle = Handle::<Vpit>::new(params, Device::Cpu)?;
    handle.load(job.model())?;
    for class in ["Car", "Pedestrian"] {
        let (mut success, mut precision, mut count, mut seconds, mut objects) = (0.0, 0.0, 0, 0.0, 0);
        for drive in frames.chunks_exact(TEST.2) {
            let is_clear = |found: &BoundingBox3D| {
                found.name == class.into() && found.occluded == 0 && found.location[2] < 30.0
            };
            let first = drive.first().map(|(_, tracks)| tracks.annotations.as_slice()).unwrap_or_default();
            for object in first.iter().filter(|track| is_clear(&track.bounding_box_3d)) {
                objects += 1;
                handle.reset();
                let init = BoundingBox3DList::from(vec![object.bounding_box_3d.clone()]);
                for (at, (scan, tracks)) in drive.iter().enumerate() {
                    let init_box = (at == 0).then_some(&init);
                    let begin = Instant::now();
                    let target = handle.infer(VpitInputs { scan: Scan::from(scan), init_box })?;
                    seconds += begin.elapsed().as_secs_f64();
                    let ground_truth = tracks.annotations.iter().find(|track| track.id == object.id);
                    let Some(ground_truth) = ground_truth.map(|ground_truth| &ground_truth.bounding_box_3d)
                    else {
                        break;
                    };
                    if at == 0 || ground_truth.occluded > 1 {
                        continue;
                    }
                    let Some(found) = target.annotations.first() else { continue };
                    let found = &found.bounding_box_3d;
                    let distance = (0..3)
                        .map(|axis| (found.location[axis] - ground_truth.location[axis]).powi(2))
                        .sum::<f32>();
                    success += standing(found).iou(&standing(ground_truth));
                    precision += 1.0 - f64::from(distance.sqrt().min(2.0)) / 2.0;
                    count += 1;
                }
            }
        }
        let share = |sum: f64| 100.0 * sum / f64::from(count.max(1));
        let each = 1e3 * seconds / f64::from(count.max(1));
        println!(
            "{what}, {class}: success {:.1}, precision {:.1}; {objects} objects, {count} frames, {each:.1} ms each",
            share(success),
            share(precision)
        );
    }
    Ok(())
}

/// Progress as lines on the terminal.
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
