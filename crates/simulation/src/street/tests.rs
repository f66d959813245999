use opendr_engine::Value;
use opendr_engine::dataset::DatasetIterator as _;
use opendr_engine::target::{BoundingBox3DList, LidarBox};

use super::*;

fn scan(index: usize) -> (opendr_engine::data::PointCloudWithCalibration, BoundingBox3DList) {
    let sample = StreetScans::new(5, 20).get(index).unwrap();
    match (sample.data.into_iter().next(), sample.target) {
        (Some(Value::PointCloudWithCalibration(cloud)), Some(Value::BoundingBox3DList(boxes))) => {
            (cloud, boxes)
        }
        other => panic!("{other:?}"),
    }
}

#[test]
fn a_scan_follows_from_seed_and_number() {
    let (cloud, boxes) = scan(3);
    assert_eq!((cloud.clone(), boxes.clone()), scan(3));
    assert_ne!(cloud.cloud, scan(4).0.cloud);
    assert!(cloud.cloud.len() > 8000, "{}", cloud.cloud.len());
    assert!(StreetScans::new(5, 20).get(20).is_err());
}

#[test]
fn boxes_hold_what_was_seen_of_their_objects() {
    let mut cars = 0;
    for index in 0..8 {
        let (scan, boxes) = scan(index);
        for found in boxes.boxes.iter().filter(|found| found.occluded < 2 && found.truncated < 0.1) {
            let place = LidarBox::from_camera(found, &scan.calibration).unwrap();
            let (sin, cos) = place.yaw.sin_cos();
            let inside = |point: &&[f32]| {
                let [x, y, z] = [0, 1, 2].map(|axis| f64::from(point[axis]) - place.center[axis]);
                (cos * x + sin * y).abs() < place.size[0] / 2.0 + 0.1
                    && (cos * y - sin * x).abs() < place.size[1] / 2.0 + 0.1
                    && (0.1..place.size[2] + 0.1).contains(&z)
            };
            let count = scan.cloud.points().filter(inside).count();
            assert!(count >= 4, "{found:?}: {count}");
            cars += usize::from(found.name == "Car".into());
        }
    }
    assert!(cars > 15, "{cars}");
}

#[test]
fn cars_have_the_sizes_of_kittis() {
    let cars: Vec<_> =
        (0..12).flat_map(|index| scan(index).1.boxes).filter(|found| found.name == "Car".into()).collect();
    let mean = |axis: usize| cars.iter().map(|car| car.dimensions[axis]).sum::<f32>() / cars.len() as f32;
    assert!((mean(0) - 3.9).abs() < 0.3 && (mean(1) - 1.56).abs() < 0.1 && (mean(2) - 1.6).abs() < 0.1);
    assert!(cars.iter().any(|car| car.occluded == 0) && cars.iter().any(|car| car.occluded > 0));
}
