//! The plants of the protocol.

use opendr_engine::Random;
use opendr_engine::environment::ResetOptions;

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

/// Draws a random plant: everything that the environment can change, at once.
///
/// Some draws cannot be flown by any controller: where the drag of the mean wind and two deviations of its gusts exceeds the horizontal
/// acceleration at the limit of tilt, the vehicle is carried away. These are drawn again.
pub fn random_plant(seed: u64) -> ResetOptions {
    let mut random = Random::from_key([seed, 77]);
    loop {
        let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
        let [mass, drag, wind] = [between(0.75, 1.4), between(0.0, 5.0), between(0.0, 7.0)];
        let rest = [
            ("motor_loss", between(0.0, 0.25)),
            ("rotor_lag", between(0.02, 0.07)),
            ("actuation_delay", between(0.0, 0.03)),
            ("estimate_delay", between(0.0, 0.04)),
            ("position_noise", between(0.0, 0.03)),
            ("velocity_noise", between(0.0, 0.1)),
            ("dropouts", between(0.0, 0.3)),
            ("speed", between(0.5, 1.1)),
        ];
        if can_hover(mass, drag, wind) {
            return options(
                &[&[("mass_factor", mass), ("drag_factor", drag), ("wind", wind)], &rest[..]].concat(),
            );
        }
    }
}

/// Whether the drag of a gust (mean and two deviations of 0.193 each) stays below the acceleration at the limit of tilt, 0.78 g.
fn can_hover(mass_factor: f64, drag_factor: f64, wind: f64) -> bool {
    let gust = wind * (1.0 + 2.0 * 0.193);
    drag_factor * (0.3 + 0.03 * gust) * gust / (1.5 * mass_factor) <= 0.78 * 9.81
}
