//! The camera on its sphere around a subject.

use opendr_engine::data::Image;
use opendr_engine::rig::{Achieved, ViewAxis, ViewPose, ViewRig, ViewSphere};
use opendr_engine::target::{Action, ActionBase as _};
use opendr_engine::{Random, Result};

use super::camera_image::{HALF_WIDTH, ImageSensor};
use super::enclosure::panels;
use super::{Asset, Conditions};
use crate::raycast::{Body, Pose, Scene, Shape, Vector};
use crate::sine_cosine::sine_cosine;

/// Width and height of an image of the environments, in pixels.
pub const SIDE: usize = 48;
/// The pole: distance from the subject's axis, radius and half of the height.
const POLE: (f64, f32, f32) = (1.8, 0.25, 1.6);

/// A rig around a rendered subject: a camera that an action moves on a sphere ([`ViewSphere::camera`]). Its azimuth counts from
/// the first pose of the episode, so that a pose does not reveal the direction of the subject's front.
#[derive(Debug, Clone)]
pub struct SphereWorld {
    sphere: ViewSphere,
    sensor: ImageSensor,
    side: usize,
    scene: Scene,
    asset: Asset,
    conditions: Conditions,
    noise: Random,
    motion: [f32; 2],
}

impl SphereWorld {
    /// Creates a world without a subject and with images of `side` x `side` pixels.
    ///
    /// # Errors
    /// `InvalidParam` for no pixel or more than 2^24.
    pub fn new(side: usize) -> Result<Self> {
        let noise = Random::new(0);
        Ok(Self {
            sphere: ViewSphere::camera(ViewPose { distance: 3.0, ..ViewPose::default() })?,
            sensor: ImageSensor::new(side)?,
            side,
            scene: Scene::default(),
            asset: Asset::empty(),
            conditions: Conditions::draw(&mut noise.clone()),
            noise,
            motion: [0.0; 2],
        })
    }

    /// Begins an episode around a subject; `seed` fixes the noise of its images.
    ///
    /// # Errors
    /// None that [`Conditions::draw`] makes.
    pub fn begin(&mut self, asset: &Asset, conditions: &Conditions, seed: u64) -> Result<()> {
        self.asset.clone_from(asset);
        self.conditions = *conditions;
        self.noise = Random::from_key([seed, 0xca3e7a]);
        self.motion = [0.0; 2];
        let Conditions { elevation, distance, .. } = *conditions;
        self.sphere.place(ViewPose { azimuth: 0.0, elevation, distance, fourth: 0.0 })?;
        self.scene.clear();
        asset.bodies().for_each(|body| self.scene.add(body.clone()));
        panels(conditions.enclosure)?.into_iter().for_each(|panel| self.scene.add(panel));
        if let Some(azimuth) = conditions.occluder {
            let (away, radius, half_height) = POLE;
            let (sine, cosine) = sine_cosine(azimuth);
            let position = [(away * cosine) as f32, (away * sine) as f32, 0.0];
            let (sine, cosine) = sine_cosine(0.5 * conditions.tilt);
            let upright = [cosine as f32, 0.0, sine as f32, 0.0];
            let pole = Shape::Cylinder { radius, half_height };
            self.scene.add(Body::new(pole, in_subject(position, conditions.tilt), upright, 0)?);
        }
        Ok(())
    }

    /// Returns width and height of an image in pixels.
    pub fn side(&self) -> usize {
        self.side
    }

    /// Returns the angle of view of the camera in rad, horizontally and vertically.
    pub fn field_of_view(&self) -> f64 {
        2.0 * f64::from(HALF_WIDTH).atan()
    }

    /// Returns the subject of this episode.
    pub fn asset(&self) -> &Asset {
        &self.asset
    }

    /// Returns the panels of the enclosure and the pole, if there is one, in the subject's frame; their
    /// colour is [`OCCLUDER`](super::OCCLUDER).
    pub fn occluders(&self) -> &[Body] {
        &self.scene.bodies()[self.asset.bodies().count()..]
    }

    /// Returns the conditions of this episode.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// Returns the camera pose with the azimuth from the subject's front, which only the simulator knows.
    pub fn true_pose(&self) -> ViewPose {
        let pose = self.sphere.pose();
        ViewPose { azimuth: pose.azimuth + self.conditions.azimuth, ..pose }
    }

    /// Captures an image into `[height, width, 3]` RGB bytes.
    ///
    /// # Panics
    /// When there are not `3 * side * side` of them.
    pub fn capture_into(&mut self, pixels: &mut [u8]) {
        assert_eq!(pixels.len(), 3 * self.side * self.side, "an image of another size");
        let pose = self.camera_pose();
        let Self { sensor, scene, asset, conditions, noise, motion, .. } = self;
        sensor.capture((scene, asset), &pose, conditions, *motion, noise, pixels);
    }

    /// Returns position and axes of the camera in the subject's frame.
    pub fn camera_pose(&self) -> Pose {
        let (pose, tilt) = (self.true_pose(), self.conditions.tilt);
        let ((sine, cosine), (high, level)) = (sine_cosine(pose.azimuth), sine_cosine(pose.elevation));
        let outward = [level * cosine, level * sine, high];
        let position = outward.map(|part| (part * pose.distance) as f32);
        let upright = Pose::looking_at(position, [0.0; 3]);
        Pose { position: in_subject(position, tilt), axes: upright.axes.map(|axis| in_subject(axis, tilt)) }
    }
}

/// Rotates from the upright frame into that of a subject whose front is raised by `tilt`.
fn in_subject([x, y, z]: Vector, tilt: f64) -> Vector {
    let (sine, cosine) = sine_cosine(tilt);
    let (sine, cosine) = (sine as f32, cosine as f32);
    [cosine * x + sine * z, y, cosine * z - sine * x]
}

impl ViewRig for SphereWorld {
    fn axes(&self) -> &[ViewAxis] {
        self.sphere.axes()
    }

    fn pose(&self) -> ViewPose {
        self.sphere.pose()
    }

    fn apply(&mut self, action: &Action) -> Result<Achieved> {
        let achieved = self.sphere.apply(action)?;
        // The nearest point of the subject moves by one radius per radian; `radius` is that length in pixels.
        let radius = 0.5 * self.side as f32 / (0.38 * achieved.pose.distance as f32);
        let shift = |axis: usize| {
            let step = self.sphere.axes()[axis].step as f32;
            self.conditions.exposure * radius * step * achieved.action.axes()[axis]
        };
        self.motion = [shift(0), shift(1)];
        Ok(achieved)
    }

    fn capture(&mut self) -> Result<Image> {
        let mut pixels = vec![0; 3 * self.side * self.side];
        self.capture_into(&mut pixels);
        Image::from_rgb8(pixels, self.side, self.side)
    }
}
