//! Wind with gusts: the Dryden model in the low-altitude form of MIL-F-8785C.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Random, Result};

use super::CONTROL_PERIOD;
use crate::multirotor::{Vector, numbers};

/// Length scales at 6 m (20 feet) above ground, along the wind and across it, metres.
const LENGTHS: [f64; 2] = [43.7, 6.1];
/// Deviations as shares of the mean wind: along the wind, to the side, vertical.
const DEVIATIONS: [f64; 3] = [0.193, 0.193, 0.1];
/// Slowest mean wind whose gusts are carried past; slower air is still.
const STILL: f64 = 0.05;

/// The state of the gusts, all of unit deviation: along the wind one number, across it two each.
#[derive(Debug, Clone, Default, PartialEq)]
pub(super) struct Turbulence {
    along: f64,
    aside: [f64; 2],
    up: [f64; 2],
}

impl Turbulence {
    /// Gusts as they are after a long time.
    pub fn settled(random: &mut Random) -> Self {
        // The second number of a pair follows the first through a filter of the same time: half its variance, half
        // of it shared.
        let mut pair = || {
            let first = random.normal();
            [first, 0.5 * first + 0.5 * random.normal()]
        };
        let (aside, up) = (pair(), pair());
        Self { along: random.normal(), aside, up }
    }

    /// Advances the gusts by one step of the environment in a mean wind (m/s).
    pub fn advance(&mut self, speed: f64, random: &mut Random) {
        if speed < STILL {
            return;
        }
        let shares = [LENGTHS[0], LENGTHS[0], LENGTHS[1]].map(|length| CONTROL_PERIOD * speed / length);
        self.along += first_order(self.along, shares[0], random);
        for ([first, second], share) in [&mut self.aside, &mut self.up].into_iter().zip(&shares[1..]) {
            *second += (*first - *second) * share;
            *first += first_order(*first, *share, random);
        }
    }

    /// Returns the wind in the world, from its mean (m/s), its direction as cosine and sine, and the intensity of gusts.
    pub fn wind(&self, speed: f64, [cosine, sine]: [f64; 2], intensity: f64) -> Vector {
        let third = 3.0_f64.sqrt();
        // (1 + sqrt(3) T s) / (1 + T s) of the first number, whose variance is 2.
        let across = |[first, second]: [f64; 2]| (third * first + (1.0 - third) * second) / 2.0_f64.sqrt();
        let deviations = DEVIATIONS.map(|share| share * intensity * speed);
        let along = speed + deviations[0] * self.along;
        let aside = deviations[1] * across(self.aside);
        [cosine * along - sine * aside, sine * along + cosine * aside, deviations[2] * across(self.up)]
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.extend_numbers([self.along].into_iter().chain(self.aside).chain(self.up));
    }

    pub fn load(state: &mut StateReader<'_>) -> Result<Self> {
        let [along] = numbers(state)?;
        Ok(Self { along, aside: numbers(state)?, up: numbers(state)? })
    }
}

/// The change of a first-order Gauss-Markov process of unit deviation in a step that is this share of its time.
fn first_order(value: f64, share: f64, random: &mut Random) -> f64 {
    (2.0 * share).sqrt() * random.normal() - value * share
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Deviations are the standard's, along, across and vertical.
    #[test]
    fn gusts_have_drydens_deviations() {
        let mut random = Random::new(1);
        let mut gusts = Turbulence::settled(&mut random);
        let (mut sums, steps) = ([0.0; 3], 3_000_000);
        for _ in 0..steps {
            gusts.advance(10.0, &mut random);
            let [x, y, z] = gusts.wind(10.0, [1.0, 0.0], 1.0);
            for (sum, gust) in sums.iter_mut().zip([x - 10.0, y, z]) {
                *sum += gust * gust;
            }
        }
        for (sum, share) in sums.into_iter().zip(DEVIATIONS) {
            let deviation = (sum / f64::from(steps)).sqrt();
            assert!((deviation / (10.0 * share) - 1.0).abs() < 0.06, "{deviation} {share}");
        }
    }
}
