//! Tests of the whole tracker: training on simulated drives, export, loading, the learner's contract.

use std::path::PathBuf;

use opendr_engine::data::{PointCloud, PointCloudWithCalibration};
use opendr_engine::dataset::{DatasetIterator, DatasetRef};
use opendr_engine::learner::{CheckOptions, Fit, FitJob, Handle, check_learner};
use opendr_engine::target::BoundingBox3D;
use opendr_engine::{ErrorKind, Random, Statistics, Value};
use opendr_simulation::street::{StreetDrives, StreetScans};
use opendr_training::TrainingParams;

use super::*;

fn scratch(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-vpit-{name}-{}", std::process::id()));
    std::fs::remove_dir_all(&folder).ok();
    folder
}

fn drive() -> StreetDrives {
    StreetDrives::new(6, 1, 6)
}

fn trained(steps: u64, job: &FitJob<'_>) -> Result<Statistics> {
    let defaults = VpitFitParams::default();
    let training = TrainingParams {
        epochs: 1000,
        max_steps: steps,
        batch_size: 2,
        num_workers: 0,
        warmup_steps: 0,
        ..defaults.training
    };
    let dataset = drive();
    let dataset: DatasetRef<'_> = (&dataset as &dyn DatasetIterator).into();
    Vpit::fit(None, &Default::default(), &VpitFitParams { training, ..defaults }, dataset, None, job)
}

fn frame(index: usize) -> (PointCloudWithCalibration, TrackingAnnotation3DList) {
    let sample = drive().get(index).unwrap();
    match (sample.data.into_iter().next(), sample.target) {
        (Some(Value::PointCloudWithCalibration(scan)), Some(Value::TrackingAnnotation3DList(tracks))) => {
            (scan, tracks)
        }
        other => panic!("{other:?}"),
    }
}

fn box_of(tracks: &TrackingAnnotation3DList, id: i64) -> Option<&BoundingBox3D> {
    tracks.annotations.iter().find(|track| track.id == id).map(|track| &track.bounding_box_3d)
}

/// A few steps on a drive suffice to track its cars, with any runtime.
#[test]
fn cars_of_a_drive_are_followed() {
    let folder = scratch("overfit");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let losses = trained(60, &job).unwrap().curves["loss"].clone();
    let (first, last) = (losses[0], losses[losses.len() - 1]);
    assert!(last < 0.75 * first, "{first} {last}");

    let mut learner = Handle::<Vpit>::new(Default::default(), Device::Cpu).unwrap();
    learner.load(job.model()).unwrap();
    let frames: Vec<_> = (0..6).map(frame).collect();
    let (mut followed, mut evaluated) = (0, 0);
    let cars = frames[0].1.annotations.iter().filter(|track| {
        let found = &track.bounding_box_3d;
        found.name == "Car".into() && found.occluded == 0 && found.location[2] < 30.0
    });
    for car in cars {
        learner.reset();
        let first = BoundingBox3DList::from(vec![car.bounding_box_3d.clone()]);
        for (at, (scan, tracks)) in frames.iter().enumerate() {
            let init_box = (at == 0).then_some(&first);
            let output = learner.infer(VpitInputs { scan: Scan::from(scan), init_box }).unwrap();
            let [followed_car] = &output.annotations[..] else { panic!("{output:?}") };
            assert_eq!((followed_car.id, followed_car.frame), (0, Some(at as i64 + 1)));
            let Some(ground_truth) = box_of(tracks, car.id).filter(|ground_truth| ground_truth.occluded < 2)
            else {
                continue;
            };
            let offset =
                [0, 2].map(|axis| followed_car.bounding_box_3d.location[axis] - ground_truth.location[axis]);
            if at == 0 {
                assert!(offset[0].hypot(offset[1]) < 1e-3, "{offset:?}");
            } else {
                evaluated += 1;
                followed += usize::from(offset[0].hypot(offset[1]) < 0.8);
            }
        }
    }
    assert!(evaluated >= 5 && 3 * followed >= 2 * evaluated, "{followed} of {evaluated}");
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn a_trained_container_passes_the_learner_checks() {
    let folder = scratch("promises");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    trained(1, &job).unwrap();
    let first = BoundingBox3DList::from(frame(0).1.bounding_box_3d_list().boxes);
    let calls: Vec<_> = (0..3)
        .map(|index| {
            let mut call = vec![("point_cloud", Value::from(frame(index).0.cloud))];
            if index == 0 {
                call.push(("init_box", first.clone().into()));
            }
            call
        })
        .collect();
    let registry = opendr_engine::learners![Vpit];
    let entry = registry.find("vpit").unwrap();
    check_learner(entry, &CheckOptions { model: &job.model(), scratch: &folder, calls: &calls }).unwrap();
    assert!(entry.capabilities.fit && entry.stateful);
    std::fs::remove_dir_all(folder).unwrap();
}

/// 0 to 5 million points, some of them not finite: the box stays finite.
#[test]
fn hostile_clouds_never_panic() {
    let folder = scratch("hostile");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    trained(1, &job).unwrap();
    let mut learner = Handle::<Vpit>::new(Default::default(), Device::Cpu).unwrap();
    learner.load(job.model()).unwrap();
    let first = BoundingBox3DList::from(frame(0).1.bounding_box_3d_list().boxes);
    let mut random = Random::new(1);
    let mut cloud = |count: usize, channels: usize| {
        let mut strange = || match random.below(20) {
            0 => f32::NAN,
            1 => f32::INFINITY,
            2 => -f32::INFINITY,
            3 => f32::MAX,
            _ => random.uniform(-30.0, 60.0),
        };
        let numbers: Vec<f32> = (0..count * channels).map(|_| strange()).collect();
        PointCloud::new(numbers, [count, channels]).unwrap()
    };
    let nothing = cloud(0, 4);
    let input = VpitInputs { scan: Scan::from(&nothing), init_box: None };
    assert_eq!(learner.infer(input).unwrap_err().kind(), ErrorKind::InvalidInput);
    learner.infer(VpitInputs { init_box: Some(&first), ..input }).unwrap();
    for (count, channels) in [(0, 4), (1, 3), (5_000_000, 3), (2000, 7), (0, 3)] {
        let cloud = cloud(count, channels);
        let output = learner.infer(VpitInputs { scan: Scan::from(&cloud), init_box: None }).unwrap();
        let found = &output.annotations[0].bounding_box_3d;
        let numbers =
            found.dimensions.iter().chain(&found.location).chain([&found.rotation_y, &found.confidence]);
        assert!(numbers.into_iter().all(|number| number.is_finite()), "{found:?}");
        assert!(count > 0 || found.confidence == 0.0);
    }
    std::fs::remove_dir_all(folder).unwrap();
}

#[test]
fn invalid_trainings_are_refused() {
    let folder = scratch("report");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
    let scans = StreetScans::new(1, 2);
    let scans: DatasetRef<'_> = (&scans as &dyn DatasetIterator).into();
    let error = Vpit::fit(None, &Default::default(), &Default::default(), scans, None, &job).unwrap_err();
    assert!(error.to_string().contains("kitti_tracking"), "{error}");
    std::fs::remove_dir_all(folder).ok();
}
