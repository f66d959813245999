//! Parameters of the environment.

use opendr_engine::params::Params;

use super::GraspObject;

/// Parameters of `PlanarGrasp-v1`; all but the size of the images are also options of its reset.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct PlanarGraspParams {
    /// Width and height of the camera images.
    #[param(default = 96, range = 32..=512, unit = "px")]
    pub size: usize,
    /// The object on the table; none draws one for each episode.
    pub object: Option<GraspObject>,
    /// Farthest place of the object from the middle along each axis.
    #[param(default = 0.06, range = 0.0..=0.09, unit = "m")]
    pub spread: f64,
    /// Coefficient of friction of object and fingers.
    #[param(default = 0.5, range = 0.05..=1.0)]
    pub friction: f64,
    /// Force with which each finger closes.
    #[param(default = 10.0, range = 0.5..=40.0, unit = "N")]
    pub force: f64,
    /// Deviation of the noise of a colour level, of 255.
    #[param(default = 4.0, range = 0.0..=60.0)]
    pub colour_noise: f32,
    /// Deviation of the noise of the depth.
    #[param(default = 0.001, range = 0.0..=0.02, unit = "m")]
    pub depth_noise: f32,
    /// How much light, tint and texture of the table vary between episodes, from not at all to strongly.
    #[param(default = 0.5, range = 0.0..=1.0)]
    pub variation: f32,
}

impl PlanarGraspParams {
    /// In the order of the fields; the object is its place in [`GraspObject::ALL`], or -1.
    pub(super) fn numbers(&self) -> [f64; 8] {
        let place = self.object.and_then(|object| GraspObject::ALL.iter().position(|own| *own == object));
        [
            self.size as f64,
            place.map_or(-1.0, |place| place as f64),
            self.spread,
            self.friction,
            self.force,
            f64::from(self.colour_noise),
            f64::from(self.depth_noise),
            f64::from(self.variation),
        ]
    }

    /// From what [`Self::numbers`] returns.
    pub(super) fn of_numbers(numbers: [f64; 8]) -> Self {
        let [size, object, spread, friction, force, colour_noise, depth_noise, variation] = numbers;
        let object = GraspObject::ALL.into_iter().zip(0..).find(|(_, place)| f64::from(*place) == object);
        Self {
            size: size as usize,
            object: object.map(|(object, _)| object),
            spread,
            friction,
            force,
            colour_noise: colour_noise as f32,
            depth_noise: depth_noise as f32,
            variation: variation as f32,
        }
    }
}
