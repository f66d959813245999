//! NumPy's random numbers, so that seeds give the same episodes as in Gymnasium.
//!
//! `numpy.random.Generator(PCG64(SeedSequence(seed)))`: O'Neill's PCG XSL-RR 128/64 (2014), seeded by NumPy's variant of her
//! `seed_seq` alternative (NEP 19).

use std::hash::{BuildHasher as _, RandomState};

use opendr_engine::Result;
use opendr_engine::environment::{Snapshot, StateReader};

const MULTIPLIER: u128 = 0x2360_ed05_1fc6_5da4_4385_df64_9fcc_f645;

/// A generator with the stream of NumPy's default generator.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct NumpyRandom {
    state: u128,
    increment: u128,
}

impl NumpyRandom {
    /// Creates the stream of `numpy.random.default_rng(seed)`.
    pub fn new(seed: u64) -> Self {
        let [a, b, c, d] = seed_words(seed).map(u128::from);
        let mut random = Self { state: 0, increment: (((c << 64) | d) << 1) | 1 };
        random.advance();
        random.state = random.state.wrapping_add((a << 64) | b);
        random.advance();
        random
    }

    /// Creates a stream with a random seed.
    pub fn from_entropy() -> Self {
        Self::new(RandomState::new().hash_one(0))
    }

    fn advance(&mut self) {
        self.state = self.state.wrapping_mul(MULTIPLIER).wrapping_add(self.increment);
    }

    /// Returns 64 random bits.
    pub fn bits(&mut self) -> u64 {
        self.advance();
        let folded = (self.state >> 64) as u64 ^ self.state as u64;
        folded.rotate_right((self.state >> 122) as u32)
    }

    /// Returns a number in [0, 1), in steps of 2^-53: `Generator.random()`.
    pub fn unit(&mut self) -> f64 {
        (self.bits() >> 11) as f64 * (1.0 / (1u64 << 53) as f64)
    }

    /// Returns a number in [low, high): `Generator.uniform(low, high)`.
    pub fn uniform(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// Writes the state of the stream into a snapshot.
    pub fn save(&self, snapshot: &mut Snapshot) {
        for word in [self.state, self.increment] {
            snapshot.push((word >> 64) as u64);
            snapshot.push(word as u64);
        }
    }

    /// Reads the stream that [`Self::save`] wrote.
    ///
    /// # Errors
    /// `Format` when the snapshot ends too early.
    pub fn load(state: &mut StateReader<'_>) -> Result<Self> {
        let mut word =
            || -> Result<u128> { Ok((u128::from(state.word()?) << 64) | u128::from(state.word()?)) };
        Ok(Self { state: word()?, increment: word()? | 1 })
    }
}

/// Returns `SeedSequence(seed).generate_state(4, numpy.uint64)`.
fn seed_words(seed: u64) -> [u64; 4] {
    const MULTIPLIER_A: u32 = 0x931e_8875;
    const MULTIPLIER_B: u32 = 0x58f3_8ded;

    let mut constant: u32 = 0x43b0_d7e5;
    let mut hashed = |value: u32| {
        let value = value ^ constant;
        constant = constant.wrapping_mul(MULTIPLIER_A);
        let value = value.wrapping_mul(constant);
        value ^ (value >> 16)
    };
    let mut pool = [seed as u32, (seed >> 32) as u32, 0, 0].map(&mut hashed);
    for from in 0..pool.len() {
        for to in (0..pool.len()).filter(|to| *to != from) {
            let left = pool[to].wrapping_mul(0xca01_f9dd);
            let mixed = left.wrapping_sub(hashed(pool[from]).wrapping_mul(0x4973_f715));
            pool[to] = mixed ^ (mixed >> 16);
        }
    }

    let mut constant: u32 = 0x8b51_f9dd;
    let mut drawn = |index: usize| {
        let value = pool[index % pool.len()] ^ constant;
        constant = constant.wrapping_mul(MULTIPLIER_B);
        let value = value.wrapping_mul(constant);
        u64::from(value ^ (value >> 16))
    };
    std::array::from_fn(|index| drawn(2 * index) | (drawn(2 * index + 1) << 32))
}

#[cfg(test)]
mod tests {
    use super::*;

    /// NumPy 2.4.6: `SeedSequence(s).generate_state(4, np.uint64)`.
    #[test]
    fn seed_words_match_numpy() {
        let of_0 = [
            15_793_235_383_387_715_774,
            12_390_638_538_380_655_177,
            2_361_836_109_651_742_017,
            3_188_717_715_514_472_916,
        ];
        assert_eq!(seed_words(0), of_0);
        let of_2_pow_32 = [
            5_836_529_245_451_711_556,
            8_811_601_478_698_894_690,
            4_323_349_454_413_245_209,
            13_668_837_544_996_263_139,
        ];
        assert_eq!(seed_words(1 << 32), of_2_pow_32);
    }

    /// NumPy 2.4.6: `PCG64(s).random_raw(3)`, then `Generator.uniform(-0.05, 0.05, 4)`.
    #[test]
    fn streams_match_numpy() {
        let mut random = NumpyRandom::new(123);
        assert_eq!(random.state, 160_078_363_690_744_033_601_390_112_987_726_904_141);
        assert_eq!(random.increment, 17_686_443_629_577_124_697_969_402_389_330_893_883);
        let wanted = [12_587_170_189_557_361_101, 992_822_559_630_912_803, 4_064_922_177_151_560_342];
        assert_eq!([(); 3].map(|()| random.bits()), wanted);

        let mut random = NumpyRandom::new(u64::MAX);
        let wanted = [12_544_278_110_101_001_871, 15_593_249_672_699_323_225, 136_562_751_618_339_402];
        assert_eq!([(); 3].map(|()| random.bits()), wanted);

        let mut random = NumpyRandom::new(0);
        for _ in 0..3 {
            random.bits();
        }
        let wanted = [-0.04834723644714709, 0.031327023920027244, 0.04127555772777218, 0.010663577576717986];
        assert_eq!([(); 4].map(|()| random.uniform(-0.05, 0.05)), wanted);
    }

    #[test]
    fn a_stream_continues_from_a_snapshot() {
        let mut random = NumpyRandom::new(5);
        random.bits();
        let mut snapshot = Snapshot::new("x");
        random.save(&mut snapshot);
        assert_eq!(NumpyRandom::load(&mut snapshot.read("x").unwrap()).unwrap(), random);
    }
}
