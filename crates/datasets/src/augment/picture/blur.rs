//! Blur.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::picture::pixels::{Bytes, for_each_u8_image};
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Blurs an image with a Gaussian of random width; pixels at the border are repeated.
#[derive(Debug, Clone, Params)]
pub struct Blur {
    /// Smallest standard deviation of the Gaussian.
    #[param(default = 0.1, range = 0.0..=20.0, unit = "px")]
    pub min_deviation: f32,
    /// Largest standard deviation of the Gaussian.
    #[param(default = 2.0, range = 0.0..=20.0, unit = "px")]
    pub max_deviation: f32,
}

impl Augmentation for Blur {
    const NAME: &'static str = "blur";
    const ABOUT: &'static str = "blurs with a Gaussian";
}

impl Augment for Blur {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let weights = weights(random.uniform(self.min_deviation, self.max_deviation));
        for_each_u8_image(sample, |picture| blur(picture, &weights))
    }
}

/// Fractional bits of the weights.
const BITS: u32 = 16;

/// Returns the weights of a pixel and of its neighbours at distance 1, 2, ..., with a sum of one over the kernel.
fn weights(deviation: f32) -> Vec<u32> {
    let reach = (3.0 * deviation).ceil() as usize;
    let bell = |distance: usize| (-0.5 * (distance as f64 / f64::from(deviation).max(1e-3)).powi(2)).exp();
    let sum = 1.0 + 2.0 * (1..=reach).map(bell).sum::<f64>();
    let mut weights: Vec<u32> =
        (0..=reach).map(|distance| (bell(distance) / sum * f64::from(1 << BITS)).round() as u32).collect();
    weights[0] = (1 << BITS) - 2 * weights[1..].iter().sum::<u32>();
    weights
}

/// Blurs along the rows, then along the columns.
fn blur(picture: Bytes<'_>, weights: &[u32]) {
    let Bytes { samples, width, channels } = picture;
    let row = width * channels;
    let reach = weights.len() - 1;
    let mut sums = vec![0u32; row];
    let mut padded = Vec::new();
    for line in samples.chunks_exact_mut(row) {
        padded.clear();
        (0..reach).for_each(|_| padded.extend_from_slice(&line[..channels]));
        padded.extend_from_slice(line);
        (0..reach).for_each(|_| padded.extend_from_slice(&line[row - channels..]));
        let shifted = |distance: usize| &padded[distance * channels..][..row];
        sums.fill(1 << (BITS - 1));
        add(&mut sums, shifted(reach), weights[0]);
        for (distance, weight) in weights.iter().enumerate().skip(1) {
            add(&mut sums, shifted(reach - distance), *weight);
            add(&mut sums, shifted(reach + distance), *weight);
        }
        store(line, &sums);
    }
    let across = samples.to_vec();
    let rows = across.len() / row;
    let line_at = |y: usize| &across[y * row..][..row];
    for (y, line) in samples.chunks_exact_mut(row).enumerate() {
        sums.fill(1 << (BITS - 1));
        add(&mut sums, line_at(y), weights[0]);
        for (distance, weight) in weights.iter().enumerate().skip(1) {
            add(&mut sums, line_at(y.saturating_sub(distance)), *weight);
            add(&mut sums, line_at((y + distance).min(rows - 1)), *weight);
        }
        store(line, &sums);
    }
}

fn add(sums: &mut [u32], samples: &[u8], weight: u32) {
    sums.iter_mut().zip(samples).for_each(|(sum, sample)| *sum += u32::from(*sample) * weight);
}

fn store(line: &mut [u8], sums: &[u32]) {
    line.iter_mut().zip(sums).for_each(|(sample, sum)| *sample = (sum >> BITS) as u8);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_point_becomes_a_gaussian_and_flat_stays_flat() {
        let mut samples = vec![0u8; 31 * 31];
        samples[15 * 31 + 15] = 255;
        blur(Bytes { samples: &mut samples, width: 31, channels: 1 }, &weights(1.5));
        let peak = 255.0 / (std::f32::consts::TAU * 1.5 * 1.5);
        assert!((f32::from(samples[15 * 31 + 15]) - peak).abs() < 1.0, "{}", samples[15 * 31 + 15]);
        assert_eq!(samples[15 * 31 + 13], samples[13 * 31 + 15]);
        assert_eq!(samples[15 * 31 + 13], samples[15 * 31 + 17]);
        let mut flat = vec![201u8; 3 * 7 * 5];
        blur(Bytes { samples: &mut flat, width: 7, channels: 3 }, &weights(20.0));
        assert!(flat.iter().all(|sample| *sample == 201));
        assert_eq!(weights(0.0), [1 << BITS]);
    }
}
