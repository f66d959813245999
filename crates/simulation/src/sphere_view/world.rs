//! The camera on its sphere around a subject.

use opendr_engine::data::Image;
use opendr_engine::rig::{Achieved, ViewAxis, ViewPose, ViewRig, ViewSphere};
use opendr_engine::target::{Action, ActionBase as _};
use opendr_engine::{Random, Result};

use super::picture::Eye;
use super::{Asset, Conditions};
use crate::raycast::{Body, Pose, Scene, Shape, along, cross, unit};
use crate::sine_cosine::sine_cosine;

/// Pixels of a picture in each direction, as environments take them.
pub const SIDE: usize = 48;
/// The pole: how far it is from the subject's axis, its radius and half of its height.
const POLE: (f64, f32, f32) = (1.8, 0.25, 1.6);

/// A rig over a rendered subject: a camera that an action moves on a sphere (35 degrees of azimuth, 17 of elevation, 0.7
/// radii closer). Its azimuth counts from where an episode began, so a pose does not tell where the subject's front is.
#[derive(Debug, Clone)]
pub struct SphereWorld {
    sphere: ViewSphere,
    eye: Eye,
    side: usize,
    scene: Scene,
    asset: Asset,
    conditions: Conditions,
    noise: Random,
    motion: [f32; 2],
}

impl SphereWorld {
    /// A world without a subject, which takes pictures of `side` x `side` pixels.
    ///
    /// # Errors
    /// `InvalidParam` for no pixel or more than 2^24.
    pub fn new(side: usize) -> Result<Self> {
        let noise = Random::new(0);
        Ok(Self {
            sphere: ViewSphere::camera(ViewPose { distance: 3.0, ..ViewPose::default() })?,
            eye: Eye::new(side)?,
            side,
            scene: Scene::default(),
            asset: Asset::empty(),
            conditions: Conditions::draw(&mut noise.clone()),
            noise,
            motion: [0.0; 2],
        })
    }

    /// Begins an episode around a subject; `seed` fixes the noise of its pictures.
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
        if let Some(azimuth) = conditions.occluder {
            let (away, radius, half_height) = POLE;
            let (sine, cosine) = sine_cosine(azimuth);
            let position = [(away * cosine) as f32, (away * sine) as f32, 0.0];
            self.scene.add(Body::upright(Shape::Cylinder { radius, half_height }, position, 0)?);
        }
        Ok(())
    }

    /// Pixels in each direction.
    pub fn side(&self) -> usize {
        self.side
    }

    /// The conditions of this episode.
    pub fn conditions(&self) -> &Conditions {
        &self.conditions
    }

    /// Where the camera is in the subject's frame: its azimuth is that from the subject's front, which only the simulator
    /// knows.
    pub fn true_pose(&self) -> ViewPose {
        let pose = self.sphere.pose();
        ViewPose { azimuth: pose.azimuth + self.conditions.azimuth, ..pose }
    }

    /// Takes a picture into `[height, width, 3]` RGB bytes.
    ///
    /// # Panics
    /// When there are not `3 * side * side` of them.
    pub fn capture_into(&mut self, pixels: &mut [u8]) {
        assert_eq!(pixels.len(), 3 * self.side * self.side, "a picture of another size");
        let pose = camera_pose(&self.true_pose());
        let Self { eye, scene, asset, conditions, noise, motion, .. } = self;
        eye.look((scene, asset), &pose, conditions, *motion, noise, pixels);
    }
}

/// Position and axes of a camera that looks at the origin.
fn camera_pose(pose: &ViewPose) -> Pose {
    let ((sine, cosine), (high, level)) = (sine_cosine(pose.azimuth), sine_cosine(pose.elevation));
    let outward = [(level * cosine) as f32, (level * sine) as f32, high as f32];
    let ahead = outward.map(|part| -part);
    let left = unit(cross([0.0, 0.0, 1.0], ahead));
    Pose { position: along([0.0; 3], outward, pose.distance as f32), axes: [ahead, left, cross(ahead, left)] }
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
        // What is nearest to the camera moves by one radius per radian, and a radius is so many pixels.
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
