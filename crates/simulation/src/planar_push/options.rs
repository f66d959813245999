//! Parameters of the environment, each of which a reset can change.

use opendr_engine::params::Params;

/// Parameters of `PlanarPush-v1`, and options of its reset.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct PlanarPushParams {
    /// Largest distance of the T from the goal at the start; the smallest is half of it.
    #[param(default = 0.1, range = 0.0..=0.15, unit = "m")]
    pub distance: f64,
    /// Largest turn of the T from the goal at the start, to either side.
    #[param(default = 1.0, range = 0.0..=3.2, unit = "rad")]
    pub turn: f64,
    /// Mass of the T.
    #[param(default = 0.2, range = 0.02..=2.0, unit = "kg")]
    pub mass: f64,
    /// Coefficient of friction between the T and the table.
    #[param(default = 0.35, range = 0.1..=1.0)]
    pub table_friction: f64,
    /// Coefficient of friction between the T and the pusher.
    #[param(default = 0.3, range = 0.0..=1.0)]
    pub contact_friction: f64,
}

impl PlanarPushParams {
    /// In the order of the fields.
    pub(super) fn numbers(&self) -> [f64; 5] {
        [self.distance, self.turn, self.mass, self.table_friction, self.contact_friction]
    }

    /// From what [`Self::numbers`] returns.
    pub(super) fn of_numbers(numbers: [f64; 5]) -> Self {
        let [distance, turn, mass, table_friction, contact_friction] = numbers;
        Self { distance, turn, mass, table_friction, contact_friction }
    }
}
