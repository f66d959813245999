//! Options of a drive.

use opendr_engine::{Error, Result};

/// Shape of a drive.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Course {
    /// Straight ahead.
    Straight,
    /// Bends to both sides, with straights between.
    Curves,
    /// Around a block of the town, counter-clockwise, and past the start.
    Loop,
}

/// Options of [`Drive`](super::Drive).
#[derive(Debug, Clone, PartialEq)]
pub struct DriveOptions {
    /// Seed of the town, the course and the noise.
    pub seed: u64,
    /// Shape of the drive.
    pub course: Course,
    /// Length of the drive along the road, in metres, 1 to 10,000; a loop is once around plus a tenth, whatever stands here.
    pub length: f64,
    /// Mean side of the block that a loop surrounds, in metres, 40 to 1,000.
    pub block: f64,
    /// Width and height of the images, in pixels.
    pub size: [usize; 2],
    /// Tangent of half the horizontal field of view.
    pub half_width: f32,
    /// Distance between the cameras of the stereo pair, in metres.
    pub baseline: f32,
    /// Height of the cameras above the road, in metres.
    pub camera_height: f64,
    /// Speed, in metres per second.
    pub speed: f64,
    /// Frames per second.
    pub rate: f64,
    /// Standard deviation of the pixel noise, in grey levels.
    pub noise: f32,
    /// Relative amplitude of slow changes of exposure, 0 to 0.5.
    pub exposure_swing: f32,
    /// Contrast of the textures: 1 for a town, 0 for surfaces of one colour.
    pub texture: f32,
    /// Standard deviation of the depth camera's disparity noise, in pixels of the stereo pair.
    pub depth_noise: f32,
    /// Largest depth of the depth camera, in metres; beyond it the depth is 0.
    pub depth_range: f32,
    /// Amplitude of the vehicle's pitch and roll, in radians; it also rises and falls by as many metres.
    pub shake: f64,
}

impl Default for DriveOptions {
    fn default() -> Self {
        Self {
            seed: 0,
            course: Course::Loop,
            length: 200.0,
            block: 80.0,
            size: [640, 480],
            half_width: 0.8,
            baseline: 0.4,
            camera_height: 1.6,
            speed: 6.0,
            rate: 10.0,
            noise: 2.0,
            exposure_swing: 0.1,
            texture: 1.0,
            depth_noise: 0.15,
            depth_range: 25.0,
            shake: 0.008,
        }
    }
}

impl DriveOptions {
    /// Returns an error that names the first option out of its range.
    pub(super) fn check(&self) -> Result<()> {
        let ranges = [
            ("length", self.length, 1.0, 1e4),
            ("block", self.block, 40.0, 1e3),
            ("baseline", f64::from(self.baseline), 1e-3, 10.0),
            ("camera_height", self.camera_height, 0.1, 10.0),
            ("speed", self.speed, 0.1, 100.0),
            ("rate", self.rate, 0.1, 1e3),
            ("noise", f64::from(self.noise), 0.0, 100.0),
            ("exposure_swing", f64::from(self.exposure_swing), 0.0, 0.5),
            ("texture", f64::from(self.texture), 0.0, 2.0),
            ("depth_noise", f64::from(self.depth_noise), 0.0, 100.0),
            ("depth_range", f64::from(self.depth_range), 0.1, 300.0),
            ("shake", self.shake, 0.0, 0.2),
        ];
        match ranges.into_iter().find(|(_, value, low, high)| !(*low..=*high).contains(value)) {
            Some((name, value, low, high)) => {
                Err(Error::invalid_param(format!("the drive's {name} is {value}; give {low} to {high}")))
            }
            None => Ok(()),
        }
    }
}
