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

/// A random plant: everything that the environment can change, at once.
pub fn random_plant(seed: u64) -> ResetOptions {
    let mut random = Random::from_key([seed, 77]);
    let mut between = |low: f64, high: f64| low + (high - low) * random.unit();
    options(&[
        ("mass_factor", between(0.75, 1.4)),
        ("drag_factor", between(0.0, 5.0)),
        ("wind", between(0.0, 7.0)),
        ("motor_loss", between(0.0, 0.25)),
        ("rotor_lag", between(0.02, 0.07)),
        ("actuation_delay", between(0.0, 0.03)),
        ("estimate_delay", between(0.0, 0.04)),
        ("position_noise", between(0.0, 0.03)),
        ("velocity_noise", between(0.0, 0.1)),
        ("dropouts", between(0.0, 0.3)),
        ("speed", between(0.5, 1.1)),
    ])
}
