//! Proportions of a body.

use opendr_engine::Random;

/// Measures of a body, metres.
///
/// Lengths of the segments are the shares of the stature of R. Drillis and R. Contini, "Body Segment Parameters", 1966.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct BodyShape {
    /// Stature.
    pub height: f32,
    /// Factor of all widths, 1 for a slim adult.
    pub girth: f32,
    /// Factor of the width of the shoulders.
    pub shoulders: f32,
    /// Factor of the width of the hips.
    pub hips: f32,
}

impl BodyShape {
    /// Draws a body: four of five are adults.
    pub fn draw(random: &mut Random) -> Self {
        let is_child = random.chance(0.2);
        let height = if is_child { random.uniform(1.05, 1.5) } else { random.uniform(1.52, 1.95) };
        let width = random.uniform(0.0, 1.0);
        Self {
            height,
            girth: random.uniform(0.9, 1.4),
            shoulders: 0.92 + 0.16 * width,
            hips: 1.06 - 0.16 * width,
        }
    }

    pub fn thigh(&self) -> f32 {
        0.245 * self.height
    }

    pub fn shank(&self) -> f32 {
        0.246 * self.height
    }

    pub fn upper_arm(&self) -> f32 {
        0.186 * self.height
    }

    pub fn forearm(&self) -> f32 {
        0.146 * self.height
    }

    /// Returns the length from the hips to the base of the neck.
    pub fn trunk(&self) -> f32 {
        0.288 * self.height
    }

    /// Returns the length from the base of the neck to the middle of the head.
    pub fn neck(&self) -> f32 {
        0.115 * self.height
    }

    /// Returns the height of the ankle above the sole.
    pub fn ankle(&self) -> f32 {
        0.039 * self.height
    }

    /// Returns the distance of a shoulder joint from the middle.
    pub fn half_shoulders(&self) -> f32 {
        0.112 * self.height * self.shoulders
    }

    /// Returns the distance of a hip joint from the middle.
    pub fn half_hips(&self) -> f32 {
        0.052 * self.height * self.hips
    }

    /// Returns a width that grows with the stature and the girth; `share` is that of an adult of slim build.
    pub fn width(&self, share: f32) -> f32 {
        share * self.height * self.girth
    }
}
