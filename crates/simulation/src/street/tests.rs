use opendr_engine::Value;
use opendr_engine::data::{PointCloud, PointCloudWithCalibration};
use opendr_engine::dataset::DatasetIterator as _;
use opendr_engine::target::{BoundingBox3DList, LidarBox, TrackingAnnotation3DList};

use super::*;

fn scan(index: usize) -> (PointCloudWithCalibration, BoundingBox3DList) {
    let sample = StreetScans::new(5, 20).get(index).unwrap();
    match (sample.data.into_iter().next(), sample.target) {
        (Some(Value::PointCloudWithCalibration(cloud)), Some(Value::BoundingBox3DList(boxes))) => {
            (cloud, boxes)
        }
        other => panic!("{other:?}"),
    }
}

/// Counts the points within 10 cm of a box, except those near the ground.
fn points_in(place: &LidarBox, cloud: &PointCloud) -> usize {
    let (sin, cos) = place.yaw.sin_cos();
    let inside = |point: &&[f32]| {
        let [x, y, z] = [0, 1, 2].map(|axis| f64::from(point[axis]) - place.center[axis]);
        (cos * x + sin * y).abs() < place.size[0] / 2.0 + 0.1
            && (cos * y - sin * x).abs() < place.size[1] / 2.0 + 0.1
            && (0.1..place.size[2] + 0.1).contains(&z)
    };
    cloud.points().filter(inside).count()
}

#[test]
fn a_scan_depends_on_seed_and_index() {
    let (cloud, boxes) = scan(3);
    assert_eq!((cloud.clone(), boxes.clone()), scan(3));
    assert_ne!(cloud.cloud, scan(4).0.cloud);
    assert!(cloud.cloud.len() > 8000, "{}", cloud.cloud.len());
    assert!(StreetScans::new(5, 20).get(20).is_err());
}

#[test]
fn boxes_contain_the_points_of_their_objects() {
    let mut cars = 0;
    for index in 0..8 {
        let (scan, boxes) = scan(index);
        for found in boxes.boxes.iter().filter(|found| found.occluded < 2 && found.truncated < 0.1) {
            let place = LidarBox::from_camera(found, &scan.calibration).unwrap();
            let count = points_in(&place, &scan.cloud);
            assert!(count >= 4, "{found:?}: {count}");
            cars += usize::from(found.name == "Car".into());
        }
    }
    assert!(cars > 15, "{cars}");
}

#[test]
fn cars_have_the_sizes_of_kitti() {
    let cars: Vec<_> =
        (0..12).flat_map(|index| scan(index).1.boxes).filter(|found| found.name == "Car".into()).collect();
    let mean = |axis: usize| cars.iter().map(|car| car.dimensions[axis]).sum::<f32>() / cars.len() as f32;
    assert!((mean(0) - 3.9).abs() < 0.3 && (mean(1) - 1.56).abs() < 0.1 && (mean(2) - 1.6).abs() < 0.1);
    assert!(cars.iter().any(|car| car.occluded == 0) && cars.iter().any(|car| car.occluded > 0));
}

fn frames(drives: &StreetDrives) -> Vec<(PointCloudWithCalibration, TrackingAnnotation3DList)> {
    let frame = |index| {
        let sample = drives.get(index).unwrap();
        match (sample.data.into_iter().next(), sample.target) {
            (
                Some(Value::PointCloudWithCalibration(cloud)),
                Some(Value::TrackingAnnotation3DList(tracks)),
            ) => (cloud, tracks),
            other => panic!("{other:?}"),
        }
    };
    (0..drives.len()).map(frame).collect()
}

/// Boxes contain the points of their objects in every frame; some objects move, some stand, and none jumps.
#[test]
fn drives_move_their_objects() {
    let drives = StreetDrives::new(6, 2, 8);
    assert!(drives.get(16).is_err() && drives.sequence(7) == Some(0) && drives.sequence(8) == Some(1));
    let frames = frames(&drives);
    assert_eq!(frames, self::frames(&drives));
    let (mut inside, mut pairs) = (0, 0);
    for (at, (scan, tracks)) in frames.iter().enumerate() {
        for track in &tracks.annotations {
            let found = &track.bounding_box_3d;
            let place = LidarBox::from_camera(found, &scan.calibration).unwrap();
            if found.occluded < 2 && found.truncated < 0.1 {
                assert!(points_in(&place, &scan.cloud) >= 4, "frame {at}: {track:?}");
                inside += 1;
            }
            let next = frames.get(at + 1).filter(|_| at % 8 < 7);
            let next = next.and_then(|(_, next)| next.annotations.iter().find(|next| next.id == track.id));
            let Some(next) = next else { continue };
            let next = LidarBox::from_camera(&next.bounding_box_3d, &scan.calibration).unwrap();
            let step = (next.center[0] - place.center[0]).hypot(next.center[1] - place.center[1]);
            assert!(step < 3.5 && next.size == place.size, "{track:?} moves {step} m");
            pairs += 1;
        }
    }
    assert!(inside > 30 && pairs > 30, "{inside} {pairs}");
}
