//! 3D detectors with real weights: cars on simulated streets, and scans of KITTI.

use opendr::data::PointCloud;
use opendr::dataset::{DatasetIterator as _, ExternalDataset};
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::learner::{AnyLearner, Ports};
use opendr::metrics::{Kitti, Metric as _};
use opendr::params::ParamMap;
use opendr::simulation::street::StreetScans;
use opendr::target::BoundingBox3DList;
use opendr::{Device, Value, ValueRef};

use crate::models::Models;

/// Average precision of cars in space at moderate difficulty, 40 points of recall.
const LEAST: f64 = 0.70;

fn detector(models: &Models, threshold: f64) -> Option<Box<dyn AnyLearner>> {
    let model = models.get("voxel_object_detection_3d")?;
    let params: ParamMap = [("threshold".to_owned(), threshold.into())].into_iter().collect();
    let entry = opendr::registry().find("voxel_object_detection_3d").unwrap();
    let mut learner = entry.make(&params, Device::Cpu).unwrap();
    learner.load(&model).unwrap();
    Some(learner)
}

fn boxes(learner: &mut dyn AnyLearner, scan: &Value) -> BoundingBox3DList {
    let scan: ValueRef<'_> = scan.into();
    match learner.infer(&Ports::default().with("point_cloud", scan)).unwrap().first() {
        Some(Value::BoundingBox3DList(list)) => list.clone(),
        other => panic!("{other:?}"),
    }
}

/// Streets that it never saw: seed 2, as the example `train_pillars` measures.
#[test]
fn cars_of_simulated_streets_are_found() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = detector(&models, 0.05) else { return };
    let (streets, mut metric) = (StreetScans::new(2, 30), Kitti::default());
    for index in 0..streets.len() {
        let sample = streets.get(index).unwrap();
        let Some(Value::BoundingBox3DList(ground_truth)) = &sample.target else { panic!() };
        metric.update(index, &boxes(&mut *learner, &sample.data[0]), ground_truth).unwrap();
    }
    let numbers = metric.finish().statistics.scalars;
    println!("car_3d_moderate_r40 {:.3}", numbers["car_3d_moderate_r40"]);
    assert!(numbers["car_3d_moderate_r40"] > LEAST, "{numbers:?}");
}

/// KITTI's own scans give boxes in the image, and always the same.
#[test]
fn kittis_scans_are_taken() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = detector(&models, 0.3) else { return };
    let scans = ExternalDataset::new(models.data("kitti/object_vis"), "kitti");
    let scans = open(&scans, &OpenOptions::default(), &Problems::skipping()).unwrap();
    assert!(!scans.is_empty());
    for index in 0..scans.len() {
        let scan = scans.get(index).unwrap().data.remove(0);
        let found = boxes(&mut *learner, &scan);
        assert_eq!(found, boxes(&mut *learner, &scan));
        assert!(
            found.boxes.iter().all(|found| found.bbox2d[2] > found.bbox2d[0] && found.location[2] < 60.0)
        );
    }
}

/// Nothing, one point, and points that are nowhere.
#[test]
fn strange_clouds_have_no_cars() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = detector(&models, 0.3) else { return };
    for numbers in
        [vec![], vec![12.0, 0.0, -1.0, 0.2], vec![f32::NAN; 4], vec![f32::INFINITY; 400], vec![-1e38; 40]]
    {
        let shape = [numbers.len() / 4, 4];
        let cloud = Value::from(PointCloud::new(numbers, shape).unwrap());
        assert!(boxes(&mut *learner, &cloud).boxes.is_empty(), "{shape:?}");
    }
}
