use opendr_engine::data::{Calibration, Image, PointCloud, PointCloudWithCalibration};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{BoundingBox3D, BoundingBox3DList};
use opendr_engine::{ErrorKind, Random, Result, Value};

use super::boxes::{contains, touch};
use super::frame::Frame;
use super::points::cloud;
use super::*;
use crate::augment::{Augment, OtherSamples};

/// Returns a scene with a car, whose calibration has a tilt and an offset.
fn scene(place: [f32; 3], rotation_y: f32, calibrated: bool) -> Sample {
    let calibration = Calibration::from_kitti_text(
        "P2: 700 0 600 40 0 700 170 0 0 0 1 0\nR0_rect: 0.9999 0.0098 -0.0074 -0.0099 0.9999 -0.0043 0.0074 0.0044 1\n\
         Tr_velo_to_cam: 0.0075 -0.9999 -0.0006 -0.004 0.0148 0.0007 -0.9999 -0.0763 0.9998 0.0075 0.0148 -0.2718\n",
    )
    .unwrap();
    let object = BoundingBox3D {
        name: "Car".into(),
        dimensions: [4.0, 1.5, 1.8],
        location: place,
        rotation_y,
        ..BoundingBox3D::default()
    };
    let mut random = Random::new(place[0].to_bits().into());
    let empty = PointCloud::new(vec![], [0, 4]).unwrap();
    let datum = |cloud: PointCloud| match calibrated {
        true => Value::from(PointCloudWithCalibration::new(cloud, calibration.clone(), Some([375, 1242]))),
        false => cloud.into(),
    };
    let frame = Frame::of(&datum(empty.clone())).unwrap();
    let (sine, cosine) = f64::from(rotation_y).sin_cos();
    let mut points = Vec::new();
    for index in 0..400 {
        // Half of the points lie inside the car, near its sides, the others anywhere.
        let inside = index % 2 == 0;
        let mut side = |extent: f32| f64::from(random.uniform(-0.49, 0.49) * extent);
        let (along, up, across) = (side(4.0), side(1.5) + 0.75, side(1.8));
        let mut at = [cosine * along + sine * across, -up, cosine * across - sine * along];
        (0..3).for_each(|axis| at[axis] += f64::from(place[axis]));
        let far = [0, 1, 2].map(|_| f64::from(random.uniform(-30.0, 30.0)));
        points.extend(frame.lidar_from_camera(if inside { at } else { far }).map(|part| part as f32));
        points.push(0.25);
    }
    let cloud = PointCloud::new(points, [400, 4]).unwrap();
    Sample { data: vec![datum(cloud)], target: Some(BoundingBox3DList::from(vec![object]).into()) }
}

fn boxes(sample: &Sample) -> &[BoundingBox3D] {
    let Some(Value::BoundingBox3DList(list)) = &sample.target else { panic!() };
    &list.boxes
}

/// Returns for each point whether it lies in the first box.
fn inside(sample: &Sample) -> Vec<bool> {
    let frame = Frame::of(&sample.data[0]).unwrap();
    let points = cloud(&sample.data[0]).unwrap().points();
    let place = |point: &[f32]| frame.camera_from_lidar([point[0], point[1], point[2]].map(f64::from));
    points.map(|point| contains(&boxes(sample)[0], place(point))).collect()
}

fn apply(augment: &dyn Augment, sample: &mut Sample, seed: u64) {
    augment.apply(sample, &mut Random::new(seed), &OtherSamples::none()).unwrap();
}

#[test]
fn points_stay_in_their_boxes() {
    let changes: [&dyn Augment; 3] =
        [&CloudRotate { max_angle: 3.1 }, &CloudScale { min_scale: 0.5, max_scale: 2.0 }, &CloudFlip {}];
    for (seed, calibrated) in (0..20).flat_map(|seed| [(seed, true), (seed, false)]) {
        for change in changes {
            let mut sample = scene([3.0, 1.2, 15.0], 0.7, calibrated);
            let before = inside(&sample);
            assert!(before.iter().filter(|inside| **inside).count() >= 200);
            apply(change, &mut sample, seed);
            assert_eq!(inside(&sample), before);
            assert!(cloud(&sample.data[0]).unwrap().points().all(|point| point[3] == 0.25));
        }
    }
}

#[test]
fn mirrored_twice_is_as_before() {
    let before = scene([3.0, 1.2, 15.0], 0.7, true);
    let mut sample = before.clone();
    apply(&CloudFlip {}, &mut sample, 0);
    assert!((boxes(&sample)[0].rotation_y - (std::f32::consts::PI - 0.7)).abs() < 1e-5);
    apply(&CloudFlip {}, &mut sample, 0);
    let (now, then) = (&boxes(&sample)[0], &boxes(&before)[0]);
    assert!((0..3).all(|axis| (now.location[axis] - then.location[axis]).abs() < 1e-4));
    assert!((now.rotation_y - then.rotation_y).abs() < 1e-5);
    let [now, then] = [&sample, &before].map(|sample| cloud(&sample.data[0]).unwrap().as_slice());
    assert!(now.iter().zip(then).all(|(now, then)| (now - then).abs() < 1e-4));
}

#[test]
fn boxes_in_the_image_are_projected_again() {
    let mut sample = scene([3.0, 1.2, 15.0], 0.0, true);
    apply(&CloudScale { min_scale: 1.0, max_scale: 1.0 }, &mut sample, 0);
    let object = &boxes(&sample)[0];
    // The near lower edge: 700 * 1.2 / 14.1 + 170.
    assert!((object.bbox2d[3] - (700.0 * 1.2 / 14.1 + 170.0)).abs() < 0.5, "{:?}", object.bbox2d);
    assert!((object.alpha + (3.0f32).atan2(15.0)).abs() < 1e-3);
}

#[test]
fn dropped_points_are_gone_and_jitter_is_small() {
    let before = scene([3.0, 1.2, 15.0], 0.7, false);
    let mut sample = before.clone();
    apply(&DropPoints { max_share: 1.0 }, &mut sample, 5);
    let [kept, all] = [&sample, &before].map(|sample| cloud(&sample.data[0]).unwrap());
    assert!(kept.len() < all.len() && kept.points().all(|point| all.points().any(|other| other == point)));
    let mut sample = before.clone();
    apply(&JitterPoints { deviation: 0.1, max_offset: 0.15 }, &mut sample, 5);
    let moved: Vec<f32> = cloud(&sample.data[0])
        .unwrap()
        .as_slice()
        .iter()
        .zip(all.as_slice())
        .map(|(now, then)| (now - then).abs())
        .collect();
    assert!(moved.iter().all(|far| *far <= 0.1501) && moved.iter().any(|far| *far > 0.1));
    assert!(moved.iter().skip(3).step_by(4).all(|far| *far == 0.0));
}

struct Street;

impl Dataset for Street {}

impl DatasetIterator for Street {
    fn len(&self) -> usize {
        6
    }

    fn get(&self, index: usize) -> Result<Sample> {
        Ok(scene([3.0 * index as f32 - 6.0, 1.2, 12.0 + 2.5 * index as f32], 0.4 * index as f32, true))
    }
}

#[test]
fn pasted_objects_bring_their_points_and_do_not_touch() {
    let mut pasted = 0;
    for seed in 0..20 {
        let mut sample = Street.get(0).unwrap();
        let paste = PasteObjects { scenes: 4, ..PasteObjects::default() };
        paste.apply(&mut sample, &mut Random::new(seed), &OtherSamples::of(&Street)).unwrap();
        let object = boxes(&sample);
        for (index, one) in object.iter().enumerate() {
            assert!(object[..index].iter().all(|other| !touch(one, other)));
            let mut only = sample.clone();
            only.target = Some(BoundingBox3DList::from(vec![one.clone()]).into());
            let points = inside(&only).iter().filter(|inside| **inside).count();
            assert!(points >= 195, "{points}");
        }
        pasted += object.len() - 1;
    }
    assert!(pasted >= 20, "{pasted}");
}

#[test]
fn overlap_of_rotated_boxes() {
    let object = |x: f32, rotation_y: f32| BoundingBox3D {
        dimensions: [4.0, 1.5, 2.0],
        location: [x, 0.0, 10.0],
        rotation_y,
        ..BoundingBox3D::default()
    };
    assert!(touch(&object(0.0, 0.0), &object(3.9, 0.0)) && !touch(&object(0.0, 0.0), &object(4.1, 0.0)));
    let quarter = std::f32::consts::FRAC_PI_2;
    assert!(
        touch(&object(0.0, 0.0), &object(2.9, quarter)) && !touch(&object(0.0, 0.0), &object(3.1, quarter))
    );
    // A corner of a square rotated by 45 degrees reaches farther than its side.
    assert!(touch(&object(0.0, 0.0), &object(4.0, quarter / 2.0)));
}

#[test]
fn images_beside_clouds_are_errors() {
    let mut sample = scene([3.0, 1.2, 15.0], 0.7, true);
    sample.data.push(Image::from_rgb8(vec![0; 3], 1, 1).unwrap().into());
    let refused = CloudFlip {}.apply(&mut sample, &mut Random::new(0), &OtherSamples::none());
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::Unsupported);
}
