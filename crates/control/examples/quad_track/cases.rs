//! The plants of the protocol.

use opendr_engine::environment::ResetOptions;
use opendr_engine::{Random, Result};

use crate::base_policy::tuned_pid;
use crate::flight::{Workspace, on_all_processors};

/// Cases of the acceptance protocol: name, and options of the reset.
pub const CASES: [(&str, &[(&str, f64)]); 5] = [
    ("nominal", &[]),
    ("mass +30 %", &[("mass_factor", 1.3)]),
    ("wind 5 m/s, gusts", &[("wind", 5.0)]),
    ("drag x4", &[("drag_factor", 4.0)]),
    ("motor 20 % weaker", &[("motor_loss", 0.2)]),
];

pub fn options(pairs: &[(&str, f64)]) -> ResetOptions {
    pairs.iter().map(|(name, value)| ((*name).to_owned(), (*value).into())).collect()
}

/// A plant of which everything that the environment can change is drawn at once.
pub struct RandomPlant {
    pub options: ResetOptions,
    /// Number of draws before it that no controller could fly.
    pub refused: usize,
}

/// The estimate of the state without noise, delay and dropouts.
const IDEAL: [(&str, f64); 4] =
    [("estimate_delay", 0.0), ("position_noise", 0.0), ("velocity_noise", 0.0), ("dropouts", 0.0)];

/// Draws `count` random plants, with the seeds from `first` on.
///
/// Some draws cannot be flown by any controller: the vehicle is carried away, or actuators that are slow and weak leave it. A draw is
/// refused where the drag of the mean wind and two deviations of its gusts exceeds the horizontal acceleration at the limit of tilt, and
/// where the tuned PID loses the vehicle in the same wind although it is given the true state.
pub fn random_plants(count: u64, first: u64) -> Result<Vec<RandomPlant>> {
    on_all_processors(count, |workspace, at| {
        let seed = first + at;
        let mut random = Random::from_key([seed, 77]);
        let mut refused = 0;
        loop {
            let plant = draw(&mut random);
            if plant.is_flyable(workspace, seed)? {
                return Ok(RandomPlant { options: options(&plant.pairs), refused });
            }
            refused += 1;
        }
    })
}

struct Draw {
    pairs: Vec<(&'static str, f64)>,
    can_hover: bool,
}

impl Draw {
    fn is_flyable(&self, workspace: &mut Workspace, seed: u64) -> Result<bool> {
        let ideal =
            self.pairs.iter().copied().filter(|(name, _)| !IDEAL.iter().any(|(ideal, _)| ideal == name));
        let ideal = options(&ideal.chain(IDEAL).collect::<Vec<_>>());
        Ok(self.can_hover && !workspace.fly(&mut tuned_pid()?, &ideal, seed)?.lost)
    }
}

fn draw(random: &mut Random) -> Draw {
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    let [mass, drag, wind] = [between(0.75, 1.4), between(0.0, 5.0), between(0.0, 7.0)];
    let pairs = vec![
        ("motor_loss", between(0.0, 0.25)),
        ("rotor_lag", between(0.02, 0.07)),
        ("actuation_delay", between(0.0, 0.03)),
        ("estimate_delay", between(0.0, 0.04)),
        ("position_noise", between(0.0, 0.03)),
        ("velocity_noise", between(0.0, 0.1)),
        ("dropouts", between(0.0, 0.3)),
        ("speed", between(0.5, 1.1)),
        ("mass_factor", mass),
        ("drag_factor", drag),
        ("wind", wind),
    ];
    Draw { pairs, can_hover: can_hover(mass, drag, wind) }
}

/// Whether the drag of a gust (mean and two deviations of 0.193 each) stays below the acceleration at the limit of tilt, 0.78 g.
fn can_hover(mass_factor: f64, drag_factor: f64, wind: f64) -> bool {
    let gust = wind * (1.0 + 2.0 * 0.193);
    drag_factor * (0.3 + 0.03 * gust) * gust / (1.5 * mass_factor) <= 0.78 * 9.81
}
