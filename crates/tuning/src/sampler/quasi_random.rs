//! Quasi-random search.

use opendr_engine::{Random, Result};

use crate::records::StudyRecord;
use crate::sampler::axis::Axis;
use crate::sampler::{DrawnParameters, Sampler};
use crate::space::Parameter;

/// Low-discrepancy points: Halton's sequence with randomly permuted digits (Owen 2017, "A
/// randomized Halton algorithm in R"). The number of the trial is the index in the sequence, so workers share one.
#[derive(Debug, Clone, Copy)]
pub struct QuasiRandom {
    seed: u64,
}

impl QuasiRandom {
    /// Creates the sampler.
    pub fn new(seed: u64) -> Self {
        Self { seed }
    }
}

impl Sampler for QuasiRandom {
    fn draw(&self, _: &StudyRecord, number: usize, parameters: &[&Parameter]) -> Result<DrawnParameters> {
        let unit = |it: &&Parameter| scrambled_halton(self.seed, number, it.position);
        let numbers =
            parameters.iter().map(|it| Axis::new(&it.distribution).number_from_unit(unit(it))).collect();
        Ok(DrawnParameters { numbers, system_attributes: Vec::new() })
    }
}

/// Returns element `index` of dimension `dimension`, in [0, 1).
fn scrambled_halton(seed: u64, index: usize, dimension: usize) -> f64 {
    let base = prime(dimension);
    let (mut rest, mut unit, mut weight) = (index, 0.0, 1.0);
    let mut digits: Vec<usize> = Vec::with_capacity(base);
    for digit in 0.. {
        weight /= base as f64;
        // Digits below the resolution of a double have no effect.
        if weight < f64::EPSILON / 4.0 {
            break;
        }
        digits.clear();
        digits.extend(0..base);
        Random::from_key([seed, dimension as u64, digit]).shuffle(&mut digits);
        unit += weight * digits[rest % base] as f64;
        rest /= base;
    }
    unit.min(1.0 - f64::EPSILON)
}

/// Returns prime number `index`, from 2.
fn prime(index: usize) -> usize {
    let is_prime = |number: &usize| {
        (2..).take_while(|part| part * part <= *number).all(|part| !number.is_multiple_of(part))
    };
    (2..).filter(is_prime).nth(index).unwrap_or(2)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn primes() {
        assert_eq!((0..8).map(prime).collect::<Vec<_>>(), [2, 3, 5, 7, 11, 13, 17, 19]);
    }

    #[test]
    fn every_interval_of_a_base_has_its_share() {
        for dimension in 0..6 {
            let base = prime(dimension);
            let mut counts = vec![0; base * base];
            for index in 0..base * base {
                let unit = scrambled_halton(7, index, dimension);
                assert!((0.0..1.0).contains(&unit));
                counts[(unit * (base * base) as f64) as usize] += 1;
            }
            assert!(counts.iter().all(|count| *count == 1), "{counts:?}");
        }
        assert_ne!(scrambled_halton(7, 0, 0), scrambled_halton(8, 0, 0));
    }

    #[test]
    fn an_integral_is_closer_than_by_random_numbers() {
        let product =
            |place: &dyn Fn(usize) -> f64| (0..4).map(|dimension| 2.0 * place(dimension)).product::<f64>();
        let error = |values: Vec<f64>| (values.iter().sum::<f64>() / values.len() as f64 - 1.0).abs();
        let (mut quasi, mut random) = (0.0, 0.0);
        for seed in 0..10 {
            quasi += error((0..256).map(|at| product(&|axis| scrambled_halton(seed, at, axis))).collect());
            let mut numbers = Random::new(seed);
            let mut places = || std::array::from_fn::<f64, 4, _>(|_| numbers.unit());
            random += error(
                (0..256)
                    .map(|_| {
                        let place = places();
                        product(&|axis| place[axis])
                    })
                    .collect(),
            );
        }
        assert!(quasi < 0.5 * random, "{quasi} {random}");
    }
}
