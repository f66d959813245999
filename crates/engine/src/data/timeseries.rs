//! Measurements in the order of time.

use crate::data::array::array_datum;

array_datum! {
    /// Measurements `[time, features]`.
    Timeseries, 2, "Timeseries is empty"
}

impl Timeseries {
    /// The features at instant `time`.
    pub fn at(&self, time: usize) -> Option<&[f32]> {
        self.array.part(time)
    }
}
