//! Random elements of a space.

use super::Space;
use crate::Random;

impl Space {
    /// Writes a random element into `element`, which has the length of the space. As in Gymnasium, numbers are uniform
    /// between two bounds, exponential with one bound, and normal without bounds; choices are uniform.
    pub fn sample_into(&self, random: &mut Random, element: &mut [f32]) {
        match self {
            Self::Box { low, high, dtype, .. } if dtype.is_whole() => {
                for (value, (low, high)) in element.iter_mut().zip(low.iter().zip(high)) {
                    // The upper bound is included; infinite bounds stay infinite.
                    *value = number_between(random, *low, *high + 1.0).floor().clamp(*low, *high);
                }
            }
            Self::Box { low, high, .. } => {
                for (value, (low, high)) in element.iter_mut().zip(low.iter().zip(high)) {
                    *value = number_between(random, *low, *high);
                }
            }
            Self::Discrete { n, start } => {
                for value in element {
                    *value = (random.below(*n as usize) as f64 + f64::from(*start)) as f32;
                }
            }
            Self::MultiDiscrete(counts) => {
                for (value, count) in element.iter_mut().zip(counts) {
                    *value = random.below(*count as usize) as f32;
                }
            }
            Self::MultiBinary(_) => {
                for value in element {
                    *value = random.below(2) as f32;
                }
            }
            Self::Dict(parts) => sample_parts(parts.values(), random, element),
            Self::Tuple(parts) => sample_parts(parts.iter(), random, element),
        }
    }

    /// Returns a random element.
    pub fn sample(&self, random: &mut Random) -> Vec<f32> {
        let mut element = vec![0.0; self.len()];
        self.sample_into(random, &mut element);
        element
    }
}

fn sample_parts<'a>(parts: impl Iterator<Item = &'a Space>, random: &mut Random, mut element: &mut [f32]) {
    for part in parts {
        let Some((own, rest)) = element.split_at_mut_checked(part.len()) else { return };
        part.sample_into(random, own);
        element = rest;
    }
}

fn number_between(random: &mut Random, low: f32, high: f32) -> f32 {
    let mut exponential = || -(1.0 - random.unit()).ln();
    match (low.is_finite(), high.is_finite()) {
        (true, true) => random.uniform(low, high),
        (true, false) => (f64::from(low) + exponential()) as f32,
        (false, true) => (f64::from(high) - exponential()) as f32,
        (false, false) => random.normal() as f32,
    }
}
