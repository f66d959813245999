//! Time series.

use crate::data::array::array_datum;

array_datum! {
    /// A time series `[time, features]`.
    Timeseries, 2, "Timeseries is empty"
}

impl Timeseries {
    /// Returns the features at instant `time`.
    pub fn at(&self, time: usize) -> Option<&[f32]> {
        self.array.part(time)
    }
}
