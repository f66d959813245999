use opendr_engine::dataset::DatasetIterator;
use opendr_engine::{Random, Value};

use super::body_shape::BodyShape;
use super::motion::JointAngles;
use super::skeleton::Bones;
use super::*;
use crate::raycast::{length, minus};

const SIZE: [usize; 2] = [160, 120];

fn scenes(target: PersonTarget) -> PersonScenes {
    PersonScenes::new(7, 12, SIZE, target).unwrap()
}

#[test]
fn bones_keep_their_lengths_and_feet_stand_on_the_floor() {
    let mut random = Random::new(1);
    for _ in 0..200 {
        let (shape, angles) = (BodyShape::draw(&mut random), JointAngles::draw(&mut random));
        let bones = Bones::pose(&shape, &angles, [1.0, 2.0, 0.0], random.uniform(-4.0, 4.0));
        let bones = bones.raised(-bones.sole(&shape));
        assert!(bones.sole(&shape).abs() < 1e-5);
        let points = bones.keypoints(&shape);
        let between = |a: usize, b: usize| length(minus(points[a], points[b]));
        for side in 0..2 {
            assert!((between(5 + side, 7 + side) - shape.upper_arm()).abs() < 1e-4);
            assert!((between(7 + side, 9 + side) - shape.forearm()).abs() < 1e-4);
            assert!((between(11 + side, 13 + side) - shape.thigh()).abs() < 1e-4);
            assert!((between(13 + side, 15 + side) - shape.shank()).abs() < 1e-4);
        }
    }
}

/// Who stands upright and faces ahead has the left side at the left, the nose in front and the head on top.
#[test]
fn sides_of_an_upright_body() {
    let shape = BodyShape { height: 1.8, girth: 1.0, shoulders: 1.0, hips: 1.0 };
    let bones = Bones::pose(&shape, &JointAngles::default(), [0.0; 3], 0.0);
    let points = bones.raised(-bones.sole(&shape)).keypoints(&shape);
    assert!((5..17).step_by(2).all(|left| points[left][1] > 0.0 && points[left + 1][1] < 0.0));
    assert!(points[0][0] > points[3][0] && (1.5..1.8).contains(&points[0][2]), "{:?}", points[0]);
    let bent =
        JointAngles { bend: 0.5, hip: [0.8, 0.0], knee: [0.6, 0.0], elbow: [1.0; 2], ..Default::default() };
    let points = Bones::pose(&shape, &bent, [0.0; 3], 0.0).keypoints(&shape);
    assert!(points[0][0] > 0.2 && points[13][0] > points[14][0] && points[9][0] > points[7][0]);
}

#[test]
fn a_sample_depends_on_its_index_only() {
    let (some, more) =
        (scenes(PersonTarget::Poses), PersonScenes::new(7, 50, SIZE, PersonTarget::Poses).unwrap());
    assert_eq!(some.get(3).unwrap(), more.get(3).unwrap());
    assert_ne!(some.get(3).unwrap().data, some.get(4).unwrap().data);
    assert!(some.get(12).unwrap_err().to_string().contains("12"));
    assert!(
        PersonScenes::new(0, 1, [16, 64], PersonTarget::Boxes).unwrap_err().to_string().contains("16x64")
    );
}

/// Boxes enclose the masks, masks do not overlap, visible key points lie in the mask of their person.
#[test]
fn labels_agree_with_the_pixels() {
    let (poses, boxes) = (scenes(PersonTarget::Poses), scenes(PersonTarget::Boxes));
    let mut persons = 0;
    for index in 0..poses.len() {
        let (scene, found) = poses.render(index).unwrap();
        persons += found.len();
        let mut covered = vec![false; SIZE[0] * SIZE[1]];
        for pose in &found {
            let region = pose.region.as_ref().unwrap();
            let segment = region.segment.as_ref().unwrap();
            let opendr_engine::target::Segmentation::Rle(rle) = &segment.segmentation else {
                panic!("a mask")
            };
            let mask = rle.mask().unwrap();
            assert_eq!(mask.iter().filter(|pixel| **pixel).count(), segment.area as usize);
            for (at, _) in mask.iter().enumerate().filter(|(_, pixel)| **pixel) {
                let [x, y] = [(at % SIZE[0]) as f32, (at / SIZE[0]) as f32];
                assert!(x >= region.left && x < region.left + region.width);
                assert!(y >= region.top && y < region.top + region.height);
                assert!(!std::mem::replace(&mut covered[at], true));
                assert!(scene.depth[at] < RenderedScene::RANGE);
            }
            for point in pose.keypoints.iter().filter(|point| point.confidence > 0.5) {
                assert!(mask[point.y as usize * SIZE[0] + point.x as usize]);
            }
        }
        let Some(Value::BoundingBoxList(list)) = boxes.target(index).unwrap() else { panic!("boxes") };
        assert_eq!(list.boxes.len(), found.len());
    }
    assert!(persons >= 10, "{persons}");
}

#[test]
fn normals_are_unit_vectors_towards_the_camera() {
    let (scene, _) = scenes(PersonTarget::Boxes).render(2).unwrap();
    for (at, normal) in scene.normals.iter().enumerate() {
        let size = length(*normal);
        if scene.depth[at] >= RenderedScene::RANGE {
            assert_eq!(size, 0.0);
        } else {
            assert!((size - 1.0).abs() < 1e-3);
            let ray = [
                ((at % SIZE[0]) as f32 + 0.5 - 0.5 * SIZE[0] as f32) / scene.focal_length,
                ((at / SIZE[0]) as f32 + 0.5 - 0.5 * SIZE[1] as f32) / scene.focal_length,
                1.0,
            ];
            assert!(crate::raycast::dot(ray, *normal) <= 1e-3, "pixel {at}");
        }
    }
}
