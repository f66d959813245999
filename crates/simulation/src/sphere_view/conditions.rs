//! Conditions of an episode besides its subject.

use opendr_engine::Random;
use opendr_engine::environment::Info;

use crate::raycast::Vector;
use crate::sine_cosine::sine_cosine;

/// Largest tilt, rad.
const TILT: f32 = 1.0;
/// Range of the length of the enclosure, radii.
const ENCLOSURE: [f32; 2] = [0.8, 1.2];

/// First camera pose, orientation of the subject, light, occluders, background and noise of an episode.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Conditions {
    /// Azimuth of the first camera pose in the subject's frame, rad; no rig reports it.
    pub azimuth: f64,
    /// Elevation at the beginning, rad.
    pub elevation: f64,
    /// Distance at the beginning, radii of the subject.
    pub distance: f64,
    /// Elevation of the direction that the subject's front faces, rad; no rig reports it.
    pub tilt: f64,
    /// Length of the enclosure in front of the subject's middle, radii. The enclosure is open towards the subject's front and
    /// moves with it; the longer it is, the smaller the solid angle from which the front is visible.
    pub enclosure: f32,
    /// Direction to the light.
    pub light: Vector,
    /// Share of light from everywhere.
    pub ambient: f32,
    /// Azimuth of an upright pole between camera and subject, in the subject's frame; `None` for no pole.
    pub occluder: Option<f64>,
    /// Colours of the background: of everywhere, and of two patches around their directions.
    pub background: [([f32; 3], Vector); 3],
    /// Largest deviation of a pixel, levels of 255.
    pub noise: f32,
    /// Share of a movement during which the shutter is still open.
    pub exposure: f32,
}

impl Conditions {
    /// Draws conditions.
    pub fn draw(random: &mut Random) -> Self {
        let half = std::f64::consts::PI;
        let azimuth = half * (2.0 * random.unit() - 1.0);
        let mut uniform = |low: f32, high: f32| random.uniform(low, high);
        let elevation = f64::from(uniform(-0.9, 0.9));
        let distance = f64::from(uniform(2.7, 4.5));
        let tilt = f64::from(uniform(-TILT, TILT));
        let enclosure = uniform(ENCLOSURE[0], ENCLOSURE[1]);
        let light = direction(f64::from(uniform(-2.2, 2.2)), f64::from(uniform(0.1, 1.1)));
        let ambient = uniform(0.35, 0.6);
        let aside = f64::from(uniform(-0.5, 0.5));
        let background = [(); 3].map(|()| {
            let colour = [uniform(0.05, 0.8), uniform(0.05, 0.8), uniform(0.05, 0.8)];
            (colour, direction(f64::from(uniform(-3.1, 3.1)), f64::from(uniform(-0.6, 0.6))))
        });
        let (noise, exposure) = (uniform(6.0, 18.0), uniform(0.0, 0.2));
        let occluder = random.chance(0.5).then_some(azimuth + aside);
        Self {
            azimuth,
            elevation,
            distance,
            tilt,
            enclosure,
            light,
            ambient,
            occluder,
            background,
            noise,
            exposure,
        }
    }

    /// Returns what only a simulator knows of an episode: the class, and azimuth and elevation of the best view, relative to
    /// the first camera pose and to the horizontal plane.
    pub fn info(&self, class: u32) -> Info {
        let best = Info::default().with("class", f64::from(class)).with("best_azimuth", -self.azimuth);
        best.with("best_elevation", self.tilt)
    }
}

fn direction(azimuth: f64, elevation: f64) -> Vector {
    let ((sine, cosine), (high, level)) = (sine_cosine(azimuth), sine_cosine(elevation));
    [(level * cosine) as f32, (level * sine) as f32, high as f32]
}
