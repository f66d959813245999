//! The path to track: sums of sines, so that every derivative is exact.

use opendr_engine::Random;

use super::ReferencePath;
use crate::multirotor::Vector;
use crate::sine_cosine::sine_cosine;

/// A reference of one episode.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reference {
    /// Of each axis before the rotation: amplitude (m), angular frequency (rad/s), phase (rad).
    waves: [[f64; 3]; 3],
    /// Cosine and sine of the rotation about z.
    heading: [f64; 2],
}

/// Position and its derivatives: metres and seconds.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub(super) struct Motion {
    pub position: Vector,
    pub velocity: Vector,
    pub acceleration: Vector,
    pub jerk: Vector,
}

/// Height of the middle of the path, metres.
const HEIGHT: f64 = 6.0;

impl Reference {
    /// Draws size, phase, direction and speed.
    pub fn draw(path: ReferencePath, speed: f64, random: &mut Random) -> Self {
        let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
        let speed = speed * between(0.85, 1.15);
        let [phase, size] = [between(0.0, std::f64::consts::TAU), between(0.8, 1.2)];
        let (sine, cosine) = sine_cosine(between(0.0, std::f64::consts::TAU));
        let quarter = std::f64::consts::FRAC_PI_2;
        let waves = match path {
            ReferencePath::FigureEight => [
                [2.0 * size, speed, phase],
                [1.0 * size, 2.0 * speed, 2.0 * phase],
                [0.5 * size, 0.5 * speed, 0.5 * phase],
            ],
            ReferencePath::Circle => {
                [[1.5 * size, speed, phase], [1.5 * size, speed, phase + quarter], [0.0; 3]]
            }
            ReferencePath::Hover => [[0.0; 3]; 3],
        };
        Self { waves, heading: [cosine, sine] }
    }

    /// Returns the reference at a time, seconds.
    pub fn at(&self, time: f64) -> Motion {
        let mut motion = Motion::default();
        for (axis, [amplitude, frequency, phase]) in self.waves.into_iter().enumerate() {
            let (sine, cosine) = sine_cosine(frequency * time + phase);
            let square = frequency * frequency;
            motion.position[axis] = amplitude * sine;
            motion.velocity[axis] = amplitude * frequency * cosine;
            motion.acceleration[axis] = -amplitude * square * sine;
            motion.jerk[axis] = -amplitude * square * frequency * cosine;
        }
        let [cosine, sine] = self.heading;
        let rotated = |[x, y, z]: Vector| [cosine * x - sine * y, sine * x + cosine * y, z];
        let [x, y, z] = rotated(motion.position);
        Motion {
            position: [x, y, z + HEIGHT],
            velocity: rotated(motion.velocity),
            acceleration: rotated(motion.acceleration),
            jerk: rotated(motion.jerk),
        }
    }
}
