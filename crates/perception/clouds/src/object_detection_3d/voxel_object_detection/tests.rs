//! Tests of the whole detector: trained on simulated streets, exported, loaded, checked.

use std::path::PathBuf;

use opendr_engine::data::{PointCloud, PointCloudWithCalibration};
use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{CheckOptions, Fit, FitJob, Handle, check_learner};
use opendr_engine::overlap::UprightBox3D;
use opendr_engine::target::BoundingBox3D;
use opendr_engine::{Device, ErrorKind, Random, Result, Statistics, Value};
use opendr_simulation::street::StreetScans;
use opendr_training::{ScheduleKind, TrainingParams};

use super::*;

fn fit_params(steps: u64) -> VoxelObjectDetection3dFitParams {
    let defaults = VoxelObjectDetection3dFitParams::default();
    let training = TrainingParams {
        epochs: 1000,
        max_steps: steps,
        batch_size: 2,
        num_workers: 0,
        lr: 3e-3,
        lr_schedule: ScheduleKind::Constant,
        warmup_steps: 0,
        ..defaults.training
    };
    VoxelObjectDetection3dFitParams { ahead: 25.6, aside: 12.8, augment: false, training, ..defaults }
}

fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-pillars-{name}-{}", std::process::id()));
    std::fs::remove_dir_all(&folder).ok();
    folder
}

fn trained(params: &VoxelObjectDetection3dFitParams, job: &FitJob<'_>) -> Result<Statistics> {
    let dataset = StreetScans::new(9, 2);
    let dataset: DatasetRef<'_> = (&dataset as &dyn DatasetIterator).into();
    VoxelObjectDetection3d::fit(None, &Default::default(), params, dataset, None, job)
}

fn standing(found: &BoundingBox3D) -> UprightBox3D {
    let (size, place) = (found.dimensions.map(f64::from), found.location.map(f64::from));
    UprightBox3D::from_kitti(size, place, f64::from(found.rotation_y))
}

fn scan_of(value: &Value) -> &PointCloudWithCalibration {
    match value {
        Value::PointCloudWithCalibration(scan) => scan,
        other => panic!("{other:?}"),
    }
}

/// A few steps on two streets overfit to their cars, on any runtime.
#[test]
fn overfits_two_streets() {
    let folder = scratch("overfit");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let statistics = trained(&fit_params(120), &job).unwrap();
    let losses = &statistics.curves["loss"];
    let (first, last) = (losses[0], losses[losses.len() - 1]);
    assert!(last < 0.2 * first, "{first} {last}");

    let mut learner = Handle::<VoxelObjectDetection3d>::new(Default::default(), Device::Cpu).unwrap();
    learner.load(job.model()).unwrap();
    let (mut asked, mut hit) = (0, 0);
    for index in 0..2 {
        let sample = StreetScans::new(9, 2).get(index).unwrap();
        let Some(Value::BoundingBox3DList(ground_truth)) = &sample.target else { panic!() };
        let found = learner.infer(Scan::from(scan_of(&sample.data[0]))).unwrap();
        let near = |car: &&BoundingBox3D| {
            car.name == "Car".into()
                && car.occluded < 2
                && car.location[2] < 22.0
                && car.location[0].abs() < 10.0
        };
        for car in ground_truth.boxes.iter().filter(near) {
            asked += 1;
            hit += usize::from(found.boxes.iter().any(|found| standing(found).iou(&standing(car)) > 0.5));
        }
        // Without a calibration the same cars are offset by the distance of lidar and camera.
        let bare = learner.infer(Scan::from(&scan_of(&sample.data[0]).cloud)).unwrap();
        assert!(bare.boxes.len() >= found.boxes.len());
    }
    assert!(asked >= 2 && 2 * hit > asked, "{hit} of {asked}");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_trained_container_meets_the_learner_contract() {
    let folder = scratch("promises");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    trained(&fit_params(1), &job).unwrap();
    let clouds =
        (0..3).map(|index| scan_of(&StreetScans::new(4, 3).get(index).unwrap().data[0]).cloud.clone());
    let calls: Vec<_> = clouds.map(|cloud| vec![("point_cloud", Value::from(cloud))]).collect();
    let registry = opendr_engine::learners![VoxelObjectDetection3d];
    let entry = registry.find("voxel_object_detection_3d").unwrap();
    let options = CheckOptions { model: &job.model(), scratch: &folder, calls: &calls };
    check_learner(entry, &options).unwrap();
    assert!(entry.capabilities.fit);
    std::fs::remove_dir_all(folder).unwrap();
}

/// Clouds of 0, 1 and 5 million points, some of them not finite: boxes are finite, and without points there are none.
#[test]
fn hostile_clouds_never_panic() {
    let folder = scratch("hostile");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    trained(&fit_params(1), &job).unwrap();
    let params = VoxelObjectDetection3dParams { threshold: 0.0, ..Default::default() };
    let mut learner = Handle::<VoxelObjectDetection3d>::new(params, Device::Cpu).unwrap();
    learner.load(job.model()).unwrap();
    let mut random = Random::new(1);
    for (count, channels) in [(0, 4), (1, 3), (5_000_000, 3), (2000, 7), (0, 3)] {
        let mut strange = || match random.below(20) {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => -f32::INFINITY,
            3 => f32::MAX,
            _ => random.uniform(-30.0, 60.0),
        };
        let numbers: Vec<f32> = (0..count * channels).map(|_| strange()).collect();
        let cloud = PointCloud::new(numbers, [count, channels]).unwrap();
        let found = learner.infer(Scan::from(&cloud)).unwrap();
        assert!(found.boxes.len() <= 100 && (count > 0 || found.boxes.is_empty()));
        for found in &found.boxes {
            let numbers =
                found.dimensions.iter().chain(&found.location).chain([&found.rotation_y, &found.confidence]);
            assert!(numbers.into_iter().all(|number| number.is_finite()), "{found:?}");
        }
    }
    let nowhere = PointCloud::new(vec![f32::NAN; 400], [100, 4]).unwrap();
    assert!(learner.infer(Scan::from(&nowhere)).unwrap().boxes.is_empty());
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn invalid_trainings_are_refused() {
    let folder = scratch("report");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let ahead = VoxelObjectDetection3dFitParams { ahead: 25.0, ..fit_params(1) };
    let error = trained(&ahead, &job).unwrap_err();
    assert!(
        error.kind() == ErrorKind::InvalidParam && error.to_string().contains("multiples of 8"),
        "{error}"
    );
    let classes = VoxelObjectDetection3dFitParams { classes: vec!["Tram".to_owned()], ..fit_params(1) };
    assert!(trained(&classes, &job).unwrap_err().to_string().contains("Cyclist"));
    std::fs::remove_dir_all(folder).ok();
}
