//! From light to bytes and depths: vignette, exposure, blur of the lens and noise.

use opendr_engine::Random;

use crate::raycast::Vector;

/// Conditions of one image.
pub(super) struct Sensor {
    /// Gain of the exposure.
    pub gain: f32,
    /// Standard deviation of the noise, in grey levels.
    pub noise: f32,
}

/// Loss of light in the corners.
const VIGNETTE: f32 = 0.12;

impl Sensor {
    /// Returns RGB bytes of colours from 0 to 1, row by row.
    pub fn develop(&self, light: &[Vector], width: usize, random: &mut Random) -> Vec<u8> {
        let height = light.len() / width;
        let mut bytes = Vec::with_capacity(3 * light.len());
        let [middle_x, middle_y] = [width, height].map(|pixels| 0.5 * pixels as f32);
        for row in 0..height {
            let [above, below] = [row.saturating_sub(1), (row + 1).min(height - 1)];
            for column in 0..width {
                let [before, after] = [column.saturating_sub(1), (column + 1).min(width - 1)];
                let at = |row: usize, column: usize| &light[row * width + column];
                let (own, around) = (
                    at(row, column),
                    [at(row, before), at(row, after), at(above, column), at(below, column)],
                );
                let [x, y] = [column as f32 / middle_x - 1.0, row as f32 / middle_y - 1.0];
                let gain = 255.0 * self.gain * (1.0 - VIGNETTE * (x * x + y * y));
                let bits = random.bits();
                for channel in 0..3 {
                    let blurred = 0.6 * own[channel]
                        + 0.1 * around.iter().map(|neighbour| neighbour[channel]).sum::<f32>();
                    let noise = self.noise * nearly_normal(bits >> (20 * channel));
                    bytes.push((gain * blurred + noise).round().clamp(0.0, 255.0) as u8);
                }
            }
        }
        bytes
    }
}

/// Returns a number of mean 0 and variance 1 from the 20 lowest bits: the sum of four uniform numbers.
pub(super) fn nearly_normal(bits: u64) -> f32 {
    let sum: u64 = (0..4).map(|part| (bits >> (5 * part)) & 31).sum();
    // Variance of a uniform number of 0..32: (32^2 - 1) / 12.
    (sum as f32 - 62.0) / 18.466
}
