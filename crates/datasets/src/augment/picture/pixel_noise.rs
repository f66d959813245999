//! Sensor noise.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::pixels::for_each_u8_image;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Adds noise of random strength to every sample of an image.
#[derive(Debug, Clone, Params)]
pub struct PixelNoise {
    /// Smallest standard deviation of the noise, in levels of 0 to 255.
    #[param(default = 0.0, range = 0.0..=100.0)]
    pub min_deviation: f32,
    /// Largest standard deviation of the noise, in levels of 0 to 255.
    #[param(default = 10.0, range = 0.0..=100.0)]
    pub max_deviation: f32,
}

impl Augmentation for PixelNoise {
    const NAME: &'static str = "pixel_noise";
    const ABOUT: &'static str = "adds sensor noise";
}

impl Augment for PixelNoise {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let deviation = random.uniform(self.min_deviation, self.max_deviation);
        // The noise is a sum of bytes with this deviation, as fixed point with 16 fractional bits.
        let factor = (deviation / BYTE_SUM_DEVIATION * 65536.0).round() as i64;
        for_each_u8_image(sample, |picture| {
            for level in picture.samples {
                let noise = (sum_of_bytes(random.bits()) - BYTE_SUM_MEAN) * factor;
                *level = (i64::from(*level) + ((noise + (1 << 15)) >> 16)).clamp(0, 255) as u8;
            }
        })
    }
}

/// Mean of the sum of eight random bytes.
const BYTE_SUM_MEAN: i64 = 8 * 255 / 2;
/// Standard deviation of the sum: the root of 8 (256^2 - 1) / 12.
const BYTE_SUM_DEVIATION: f32 = 209.022;

/// Returns the sum of eight bytes, an approximation of a normal distribution (its fourth moment is 5 % lower).
fn sum_of_bytes(bits: u64) -> i64 {
    const EVEN: u64 = 0x00ff_00ff_00ff_00ff;
    let pairs = (bits & EVEN) + ((bits >> 8) & EVEN);
    (pairs.wrapping_mul(0x0001_0001_0001_0001) >> 48) as i64
}

#[cfg(test)]
mod tests {
    use opendr_engine::data::Image;

    use super::*;

    #[test]
    fn noise_has_the_requested_deviation() {
        assert_eq!(sum_of_bytes(u64::MAX), 8 * 255);
        assert_eq!(sum_of_bytes(0x0102_0304_0506_0708), 36);
        let image = Image::from_rgb8(vec![128; 200 * 100 * 3], 200, 100).unwrap();
        let mut sample = Sample { data: vec![image.into()], target: None };
        let noise = PixelNoise { min_deviation: 12.0, max_deviation: 12.0 };
        noise.apply(&mut sample, &mut Random::new(1), &OtherSamples::none()).unwrap();
        let opendr_engine::Value::Image(image) = &sample.data[0] else { panic!() };
        let away: Vec<f64> = image.chw_u8().iter().map(|level| f64::from(*level) - 128.0).collect();
        let mean = away.iter().sum::<f64>() / away.len() as f64;
        let deviation = (away.iter().map(|x| x * x).sum::<f64>() / away.len() as f64).sqrt();
        assert!(mean.abs() < 0.2 && (deviation - 12.0).abs() < 0.2, "{mean} {deviation}");
    }
}
