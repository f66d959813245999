//! Parameters of the environment, each of which a reset can change.

use opendr_engine::params::Params;

/// Parameters of `PlanarPeg-v1`, and options of its reset.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct PlanarPegParams {
    /// Clearance of the peg in the slot, on each side.
    #[param(default = 0.004, range = 0.001..=0.02, unit = "m")]
    pub clearance: f64,
    /// Farthest place of the slot from the middle, to either side.
    #[param(default = 0.08, range = 0.0..=0.12, unit = "m")]
    pub slot_spread: f64,
    /// Farthest place of the peg from the middle at the start, to either side.
    #[param(default = 0.1, range = 0.0..=0.15, unit = "m")]
    pub peg_spread: f64,
    /// Largest turn of the peg from the direction of the slot at the start, to either side.
    #[param(default = 0.6, range = 0.0..=1.2, unit = "rad")]
    pub turn: f64,
    /// Mass of the peg.
    #[param(default = 0.1, range = 0.01..=1.0, unit = "kg")]
    pub mass: f64,
    /// Coefficient of friction of peg, walls and post; the fingers have 0.9.
    #[param(default = 0.3, range = 0.0..=1.0)]
    pub friction: f64,
}

impl PlanarPegParams {
    /// In the order of the fields.
    pub(super) fn numbers(&self) -> [f64; 6] {
        [self.clearance, self.slot_spread, self.peg_spread, self.turn, self.mass, self.friction]
    }

    /// From what [`Self::numbers`] returns.
    pub(super) fn of_numbers(numbers: [f64; 6]) -> Self {
        let [clearance, slot_spread, peg_spread, turn, mass, friction] = numbers;
        Self { clearance, slot_spread, peg_spread, turn, mass, friction }
    }
}
