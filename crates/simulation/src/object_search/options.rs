//! Parameters of the environments.

use opendr_engine::params::Params;

/// Parameters of the search, and options of its reset.
#[derive(Debug, Clone, PartialEq, Params)]
pub struct ObjectSearchParams {
    /// Field of view of the depth camera.
    #[param(default = 90.0, range = 20.0..=360.0, unit = "deg")]
    pub field_of_view: f64,
    /// Range of the depth camera.
    #[param(default = 5.0, range = 1.0..=14.0, unit = "m")]
    pub range: f64,
    /// Attempts to place a piece of furniture.
    #[param(default = 24, range = 0..=200)]
    pub furniture: u32,
}

impl ObjectSearchParams {
    /// Returns the fields as numbers, in their order.
    pub(super) fn numbers(&self) -> [f64; 3] {
        [self.field_of_view, self.range, f64::from(self.furniture)]
    }

    /// Creates the parameters from what [`Self::numbers`] returns.
    ///
    /// # Errors
    /// `InvalidParam` for a number out of range.
    pub(super) fn from_numbers([field_of_view, range, furniture]: [f64; 3]) -> opendr_engine::Result<Self> {
        let params = Self { field_of_view, range, furniture: furniture as u32 };
        params.check()?;
        Ok(params)
    }
}
