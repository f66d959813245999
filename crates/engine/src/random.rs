//! A random number generator with the same numbers on every machine.

use crate::{Error, Result};

/// A random number generator: xoshiro256++ (Blackman and Vigna, Scrambled linear pseudorandom number generators, 2021).
///
/// It uses only operations that IEEE 754 rounds exactly, so its numbers are the same, bit for bit, on every machine and
/// in every build. It is not cryptographically secure.
///
/// ```
/// use opendr_engine::Random;
///
/// let mut random = Random::at([7, 0, 42]); // seed 7, epoch 0, sample 42
/// let side = random.uniform(0.5, 2.0);
/// assert!((0.5..2.0).contains(&side));
/// assert_eq!(side, Random::at([7, 0, 42]).uniform(0.5, 2.0));
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Random {
    state: [u64; 4],
}

impl Random {
    /// Creates the generator of `seed`.
    pub fn new(seed: u64) -> Self {
        Self::from_key([seed])
    }

    /// Creates the generator of a key such as `[seed, epoch, sample]`. Generators of different keys are independent, so
    /// the numbers for a sample do not depend on which thread processes it, and when.
    pub fn from_key<const N: usize>(place: [u64; N]) -> Self {
        let mut hash = N as u64;
        for part in place {
            hash = mixed(hash.wrapping_add(STEP) ^ mixed(part.wrapping_add(STEP)));
        }
        Self {
            state: std::array::from_fn(|_| {
                hash = hash.wrapping_add(STEP);
                mixed(hash)
            }),
        }
    }

    /// Creates a generator that resumes from `state`.
    ///
    /// # Errors
    /// Returns `Format` if the state is all zeros, which no generator reaches.
    pub fn from_state(state: [u64; 4]) -> Result<Self> {
        match state {
            [0, 0, 0, 0] => {
                Err(Error::format("the state of a random number generator must not be all zeros"))
            }
            state => Ok(Self { state }),
        }
    }

    /// Returns the state, e.g. for a checkpoint.
    pub fn state(&self) -> [u64; 4] {
        self.state
    }

    /// Returns 64 random bits.
    #[inline]
    pub fn bits(&mut self) -> u64 {
        let [a, b, c, d] = self.state;
        let result = a.wrapping_add(d).rotate_left(23).wrapping_add(a);
        let (c, d) = (c ^ a, d ^ b);
        self.state = [a ^ d, b ^ c, c ^ (b << 17), d.rotate_left(45)];
        result
    }

    /// Returns a number in [0, 1), in steps of 2^-53.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Returns a number in [`low`, `high`); `low` if the interval is empty.
    pub fn uniform(&mut self, low: f32, high: f32) -> f32 {
        let (start, end) = (f64::from(low), f64::from(high));
        let value = (start + (end - start) * self.unit()) as f32;
        if value < high { value.max(low) } else { low }
    }

    /// Returns an integer in [0, `end`), uniformly distributed (Lemire, 2019); 0 if `end` is 0.
    pub fn below(&mut self, end: usize) -> usize {
        let end = end as u64;
        // The lowest 2^64 mod `end` products are rejected; otherwise some numbers would be more frequent.
        let rejected = end.wrapping_neg().checked_rem(end).unwrap_or(0);
        loop {
            let product = u128::from(self.bits()) * u128::from(end);
            if product as u64 >= rejected {
                return (product >> 64) as usize;
            }
        }
    }

    /// Returns `true` with this probability.
    pub fn chance(&mut self, probability: f32) -> bool {
        self.unit() < f64::from(probability)
    }

    /// Returns a number of the normal distribution with mean 0 and standard deviation 1 (Marsaglia's polar method).
    pub fn normal(&mut self) -> f64 {
        loop {
            let (x, y) = (2.0 * self.unit() - 1.0, 2.0 * self.unit() - 1.0);
            let square = x * x + y * y;
            if square > 0.0 && square < 1.0 {
                return x * (-2.0 * natural_logarithm(square) / square).sqrt();
            }
        }
    }

    /// Shuffles `items`; every order is equally likely (Fisher and Yates).
    pub fn shuffle<T>(&mut self, items: &mut [T]) {
        for end in (2..=items.len()).rev() {
            items.swap(end - 1, self.below(end));
        }
    }
}

/// 64 bits of the fractional part of the golden ratio.
const STEP: u64 = 0x9e37_79b9_7f4a_7c15;

/// Mixes bits as SplitMix64 does (Steele, Lea and Flood, 2014).
fn mixed(mut bits: u64) -> u64 {
    bits = (bits ^ (bits >> 30)).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    bits = (bits ^ (bits >> 27)).wrapping_mul(0x94d0_49bb_1331_11eb);
    bits ^ (bits >> 31)
}

/// Returns the logarithm of a positive, normal number to about 1e-15. The standard library's differs in the last bit
/// from system to system.
fn natural_logarithm(number: f64) -> f64 {
    const MANTISSA: u32 = 52;
    let bits = number.to_bits();
    let exponent = (bits >> MANTISSA) as i64 - 1023;
    let fraction = f64::from_bits((bits & ((1 << MANTISSA) - 1)) | (1023 << MANTISSA));
    let (fraction, exponent) = if fraction > std::f64::consts::SQRT_2 {
        (fraction / 2.0, exponent + 1)
    } else {
        (fraction, exponent)
    };
    // ln f = 2 artanh((f - 1) / (f + 1)), with |part| at most 0.172.
    let part = (fraction - 1.0) / (fraction + 1.0);
    let square = part * part;
    let series = (0..10).rev().fold(0.0, |sum, term| sum * square + 1.0 / f64::from(2 * term + 1));
    exponent as f64 * std::f64::consts::LN_2 + 2.0 * part * series
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The reference implementation at <https://prng.di.unimi.it/xoshiro256plusplus.c> with state 1, 2, 3, 4.
    #[test]
    fn bits_are_xoshiros() {
        let mut random = Random { state: [1, 2, 3, 4] };
        let expected = [41_943_041, 58_720_359, 3_588_806_011_781_223, 3_591_011_842_654_386];
        assert_eq!([(); 4].map(|()| random.bits()), expected);
    }

    #[test]
    fn resumes_from_a_state() {
        let mut random = Random::new(5);
        random.bits();
        let mut same = Random::from_state(random.state()).unwrap();
        assert_eq!(random.bits(), same.bits());
        assert!(Random::from_state([0; 4]).is_err());
    }

    #[test]
    fn keys_have_independent_generators() {
        let mut first: Vec<u64> = (0..1000)
            .flat_map(|i| [Random::from_key([0, i]), Random::from_key([i, 1])])
            .map(|mut r| r.bits())
            .collect();
        first.push(Random::from_key([0]).bits());
        first.push(Random::from_key([0, 0, 0]).bits());
        first.sort_unstable();
        // [0, 1] is in both sequences.
        assert_eq!(first.windows(2).filter(|pair| pair[0] == pair[1]).count(), 1);
    }

    #[test]
    fn logarithm_is_exact_enough() {
        for number in [1e-300, 1e-9, 0.1, 0.5, 0.999_999, 1.0, 1.414, 1.415, 2.0, 123.456] {
            let (got, expected) = (natural_logarithm(number), number.ln());
            assert!((got - expected).abs() <= 2e-15 * expected.abs().max(0.1), "{number}: {got} {expected}");
        }
    }

    #[test]
    fn distributions() {
        let mut random = Random::new(3);
        let normal: Vec<f64> = (0..100_000).map(|_| random.normal()).collect();
        let moment = |power: i32| normal.iter().map(|x| x.powi(power)).sum::<f64>() / normal.len() as f64;
        assert!(moment(1).abs() < 0.01 && (moment(2) - 1.0).abs() < 0.02 && (moment(4) - 3.0).abs() < 0.1);
        let mut counts = [0; 7];
        (0..70_000).for_each(|_| counts[random.below(7)] += 1);
        assert!(counts.iter().all(|count| (9_600..10_400).contains(count)), "{counts:?}");
        assert_eq!((random.below(0), random.below(1)), (0, 0));
        let heads = (0..10_000).filter(|_| random.chance(0.25)).count();
        assert!((2_300..2_700).contains(&heads), "{heads}");
        assert!(!random.chance(0.0) && random.chance(1.0));
        assert_eq!(random.uniform(2.0, 2.0), 2.0);
        assert!((0..1000).all(|_| (-1.0..1.0).contains(&random.uniform(-1.0, 1.0))));
    }

    #[test]
    fn shuffle_is_a_permutation() {
        let mut items: Vec<usize> = (0..100).collect();
        Random::new(1).shuffle(&mut items);
        assert_ne!(items, (0..100).collect::<Vec<_>>());
        items.sort_unstable();
        assert_eq!(items, (0..100).collect::<Vec<_>>());
    }
}
