//! Random brightness, contrast, saturation and hue.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::pixels::{Bytes, for_each_u8_image};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Changes brightness, contrast, saturation and hue at random, in this order, in one pass over the pixels.
///
/// Levels are clipped to 0 and 255 once, at the end. Contrast is relative to the image's mean luminance. Hue is
/// rotated about the grey axis at constant luminance (BT.601).
#[derive(Debug, Clone, Params)]
pub struct Colour {
    /// Largest relative change of brightness: the factor is within 1 +- this.
    #[param(default = 0.2, range = 0.0..=1.0)]
    pub brightness: f32,
    /// Largest relative change of contrast: the factor is within 1 +- this.
    #[param(default = 0.2, range = 0.0..=1.0)]
    pub contrast: f32,
    /// Largest relative change of saturation: the factor is within 1 +- this.
    #[param(default = 0.2, range = 0.0..=1.0)]
    pub saturation: f32,
    /// Largest rotation of the hue in either direction.
    #[param(default = 0.1, range = 0.0..=3.15, unit = "rad")]
    pub hue: f32,
}

impl Augmentation for Colour {
    const NAME: &'static str = "colour";
    const ABOUT: &'static str = "changes brightness, contrast, saturation and hue";
}

impl Augment for Colour {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let mut factor = |most: f32| 1.0 + random.uniform(-most, most);
        let [brightness, contrast, saturation] =
            [self.brightness, self.contrast, self.saturation].map(&mut factor);
        let hue = random.uniform(-self.hue, self.hue);
        for_each_u8_image(sample, |picture| {
            let pivot = if contrast == 1.0 { 0.0 } else { brightness * mean_luminance(&picture) };
            let (gain, bias) = (brightness * contrast, (1.0 - contrast) * pivot);
            if picture.channels == 1 || (saturation == 1.0 && hue == 0.0) {
                return scale_levels(picture.samples, gain, bias);
            }
            let matrix = colour_matrix(saturation, hue);
            recolour(picture.samples, matrix.map(|row| row.map(|part| part * gain)), bias);
        })
    }
}

/// Weights of red, green and blue in the luminance (ITU-R BT.601).
const LUMINANCE: [f32; 3] = [0.299, 0.587, 0.114];

fn mean_luminance(picture: &Bytes<'_>) -> f32 {
    let mean = |sum: u64| sum as f32 / (picture.samples.len() / picture.channels) as f32;
    if picture.channels == 1 {
        return mean(picture.samples.iter().map(|sample| u64::from(*sample)).sum());
    }
    let mut sums = [0u64; 3];
    // The sums of this many pixels fit into 32 bits.
    for part in picture.samples.as_chunks::<3>().0.chunks(1 << 20) {
        let mut few = [0u32; 3];
        for pixel in part {
            few.iter_mut().zip(pixel).for_each(|(sum, sample)| *sum += u32::from(*sample));
        }
        sums.iter_mut().zip(few).for_each(|(sum, few)| *sum += u64::from(few));
    }
    sums.into_iter().zip(LUMINANCE).map(|(sum, weight)| weight * mean(sum)).sum()
}

/// Maps each level to its product with `gain`, plus `bias`.
fn scale_levels(samples: &mut [u8], gain: f32, bias: f32) {
    let table: [u8; 256] = std::array::from_fn(|level| (level as f32 * gain + bias + 0.5) as u8);
    samples.iter_mut().for_each(|sample| *sample = table[usize::from(*sample)]);
}

/// Returns the matrix that changes saturation and hue; it keeps grey.
fn colour_matrix(saturation: f32, hue: f32) -> [[f32; 3]; 3] {
    // Scales of U and V, so that a rotation keeps the saturation.
    const BLUE: f32 = 0.492;
    const RED: f32 = 0.877;
    let (sine, cosine) = hue.sin_cos();
    let columns = [0, 1, 2].map(|channel| {
        let y = LUMINANCE[channel];
        let unit = |other: usize| if other == channel { 1.0 } else { 0.0 };
        let (u, v) = ((unit(2) - y) * BLUE * saturation, (unit(0) - y) * RED * saturation);
        let (u, v) = (u * cosine - v * sine, u * sine + v * cosine);
        let (red, blue) = (y + v / RED, y + u / BLUE);
        [red, (y - LUMINANCE[0] * red - LUMINANCE[2] * blue) / LUMINANCE[1], blue]
    });
    [0, 1, 2].map(|row| columns.map(|column| column[row]))
}

/// Multiplies each pixel by `matrix` and adds `bias`.
fn recolour(samples: &mut [u8], matrix: [[f32; 3]; 3], bias: f32) {
    const BITS: u32 = 12;
    let fixed = |part: f32| (part * (1 << BITS) as f32).round() as i32;
    let (matrix, bias) = (matrix.map(|row| row.map(fixed)), fixed(bias) + (1 << (BITS - 1)));
    for pixel in samples.as_chunks_mut::<3>().0 {
        let [red, green, blue] = pixel.map(i32::from);
        *pixel =
            matrix.map(|[r, g, b]| ((r * red + g * green + b * blue + bias) >> BITS).clamp(0, 255) as u8);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn zero_parameters_change_nothing() {
        let samples: Vec<u8> = (0..=255u8).flat_map(|level| [level, 255 - level, level / 2]).collect();
        let mut changed = samples.clone();
        recolour(&mut changed, colour_matrix(1.0, 0.0), 0.0);
        assert_eq!(changed, samples);
        scale_levels(&mut changed, 1.0, 0.0);
        assert_eq!(changed, samples);
    }

    #[test]
    fn luminance_is_kept_when_the_hue_rotates() {
        for hue in [0.3, -1.0, 3.0] {
            for (row, [r, g, b]) in colour_matrix(1.3, hue).into_iter().enumerate() {
                assert!((r + g + b - 1.0).abs() < 1e-5, "row {row}");
            }
            let columns = colour_matrix(0.7, hue);
            for channel in 0..3 {
                let luminance: f32 = (0..3).map(|row| LUMINANCE[row] * columns[row][channel]).sum();
                assert!((luminance - LUMINANCE[channel]).abs() < 1e-5);
            }
        }
        let mut pixel = [200, 100, 50];
        recolour(&mut pixel, colour_matrix(0.0, 1.0), 0.0);
        assert_eq!(pixel, [124; 3]);
    }

    #[test]
    fn contrast_is_about_the_mean() {
        let mut samples = [100u8, 100, 100, 200, 200, 200];
        let mean = mean_luminance(&Bytes { samples: &mut samples, width: 2, channels: 3 });
        assert!((mean - 150.0).abs() < 1e-3);
        scale_levels(&mut samples, 0.5, 0.5 * mean);
        assert_eq!(samples, [125, 125, 125, 175, 175, 175]);
        scale_levels(&mut samples, 9.0, -1200.0);
        assert_eq!(samples, [0, 0, 0, 255, 255, 255]);
    }
}
