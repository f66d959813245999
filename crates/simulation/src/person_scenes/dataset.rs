//! Rendered persons as a data set.

use std::f32::consts::TAU;

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes, Pose as BodyPose, PoseList};
use opendr_engine::{Error, Header, Random, Result, Value};

use super::body_shape::BodyShape;
use super::exposure::Exposure;
use super::labels::label;
use super::motion::JointAngles;
use super::place::Place;
use super::rendered::{RenderedScene, Stage};
use super::skeleton::Bones;
use super::wardrobe::Wardrobe;
use crate::raycast::{Camera, Pose, Vector, length, minus};

/// Target of the samples of [`PersonScenes`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PersonTarget {
    /// Boxes with masks.
    Boxes,
    /// COCO's 17 key points, each person with box and mask.
    Poses,
}

/// Images of zero to six persons in random rooms and streets.
///
/// A sample depends on the seed and its index only. Light, colours, patterns, clothes, bodies, poses, camera and noise differ from
/// sample to sample.
#[derive(Debug, Clone)]
pub struct PersonScenes {
    seed: u64,
    count: usize,
    size: [usize; 2],
    target: PersonTarget,
}

/// Maximum number of persons in an image.
const PERSONS: usize = 6;
/// Share of images without persons, so that a detector learns what is none.
const EMPTY: f32 = 0.12;
/// Range of the distance of persons from the camera, metres.
const NEAREST: f32 = 1.2;
const FARTHEST: f32 = 14.0;
/// Draws of a position before a person is left out.
const ATTEMPTS: usize = 8;
/// Distance between persons, metres.
const APART: f32 = 0.55;

impl PersonScenes {
    /// Creates `count` images of `[width, height]` pixels.
    ///
    /// # Errors
    /// `InvalidParam` for sides outside 32 to 4096 pixels.
    pub fn new(seed: u64, count: usize, size: [usize; 2], target: PersonTarget) -> Result<Self> {
        if size.iter().any(|side| !(32..=4096).contains(side)) {
            let [width, height] = size;
            return Err(Error::invalid_param(format!(
                "images of {width}x{height} pixels cannot be rendered; give sides from 32 to 4096"
            )));
        }
        Ok(Self { seed, count, size, target })
    }

    /// Renders an image with the poses of its persons, the largest first.
    ///
    /// # Errors
    /// `NotFound` for an index beyond the end.
    pub fn render(&self, index: usize) -> Result<(RenderedScene, Vec<BodyPose>)> {
        if index >= self.count {
            return Err(Error::not_found(format!("no image {index}; the data set has {}", self.count)));
        }
        let mut random = Random::from_key([self.seed, index as u64, 0x9e50]);
        let mut stage = self.stage(&mut random)?;
        let mut joints: Vec<[Vector; 17]> = Vec::new();
        let mut taken: Vec<Vector> = Vec::new();
        let count = if random.chance(EMPTY) { 0 } else { 1 + random.below(PERSONS) };
        for _ in 0..count {
            let Some(position) = free_position(&stage, &taken, &mut random) else { continue };
            taken.push(position);
            let number = joints.len() as u16 + 1;
            let (shape, angles) = (BodyShape::draw(&mut random), JointAngles::draw(&mut random));
            let bones = Bones::pose(&shape, &angles, position, random.uniform(0.0, TAU));
            let bones = bones.raised(-bones.sole(&shape));
            stage.persons.extend(Wardrobe::draw(&mut random).dress(&shape, &bones, number)?);
            joints.push(bones.keypoints(&shape));
        }
        let scene = stage.render(&Exposure::draw(&mut random), &mut random)?;
        let mut poses = Vec::new();
        for (joints, number) in joints.iter().zip(1..) {
            poses.extend(label(&scene, &stage.camera, number, joints)?);
        }
        let area = |pose: &BodyPose| pose.region.as_ref().map_or(0.0, |region| region.width * region.height);
        poses.sort_by(|a, b| area(b).total_cmp(&area(a)));
        Ok((scene, poses))
    }

    /// Draws the surroundings and a camera that looks across their middle.
    fn stage(&self, random: &mut Random) -> Result<Stage> {
        let place = Place::draw(random)?;
        let half_width = random.uniform(0.35, 0.85);
        let camera = Camera::new(self.size[0], self.size[1], half_width)?;
        let (angle, far) = (random.uniform(0.0, TAU), random.uniform(0.7, 1.2) * place.half);
        let position = [far * angle.cos(), far * angle.sin(), random.uniform(0.7, 2.3)];
        let aim = [random.uniform(-1.0, 1.0), random.uniform(-1.0, 1.0), random.uniform(0.4, 1.5)];
        Ok(Stage { place, persons: Vec::new(), camera, half_width, pose: Pose::looking_at(position, aim) })
    }

    /// Returns a rendered image with its labels as a sample.
    pub fn sample(&self, index: usize, scene: RenderedScene, poses: Vec<BodyPose>) -> Sample {
        Sample { data: vec![scene.image.into()], target: Some(self.value(index, poses)) }
    }

    fn value(&self, index: usize, poses: Vec<BodyPose>) -> Value {
        let header = Header::new(index as i64 + 1, "camera");
        match self.target {
            PersonTarget::Poses => PoseList { header, poses, action: None }.into(),
            PersonTarget::Boxes => {
                let boxes: Vec<BoundingBox> =
                    poses.into_iter().filter_map(|pose| pose.region.map(|region| *region)).collect();
                BoundingBoxList { header, classes: self.classes(), ..boxes.into() }.into()
            }
        }
    }
}

/// Draws a position on the floor in view of the camera that no other person takes; `None` if none is found.
fn free_position(stage: &Stage, taken: &[Vector], random: &mut Random) -> Option<Vector> {
    let [ahead, left, _] = stage.pose.axes;
    let [x, y, _] = stage.pose.position;
    (0..ATTEMPTS).find_map(|_| {
        // Near persons are as frequent as far ones in terms of their size in the image.
        let far = NEAREST * (FARTHEST / NEAREST).powf(random.uniform(0.0, 1.0));
        let aside = far * stage.half_width * random.uniform(-1.0, 1.0);
        let position = [x + far * ahead[0] + aside * left[0], y + far * ahead[1] + aside * left[1], 0.0];
        let is_inside = position.iter().all(|part| part.abs() <= stage.place.half + 0.8);
        let is_free = taken.iter().all(|other| length(minus(*other, position)) >= APART);
        (is_inside && is_free).then_some(position)
    })
}

impl Dataset for PersonScenes {}

impl DatasetIterator for PersonScenes {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (scene, poses) = self.render(index)?;
        Ok(self.sample(index, scene, poses))
    }

    fn name(&self, index: usize) -> String {
        format!("{index:06}")
    }

    fn image_size(&self, _index: usize) -> Option<[u32; 2]> {
        Some(self.size.map(|side| side as u32))
    }

    fn classes(&self) -> Classes {
        ["person"].into_iter().collect()
    }
}
