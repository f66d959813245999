//! Access to the time series of a sample.

use opendr_engine::data::Timeseries;
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result, Value};

/// Calls `change` with the values of every [`Timeseries`] `[time, features]` and the number of features.
pub(super) fn for_each_series(sample: &mut Sample, mut change: impl FnMut(&mut [f32], usize)) -> Result<()> {
    let mut changed = false;
    for datum in &mut sample.data {
        let Value::Timeseries(series) = datum else { continue };
        let shape = series.shape();
        let mut numbers = series.as_slice().to_vec();
        change(&mut numbers, shape[1]);
        *series = Timeseries::new(numbers, shape)?.with_header(series.header.clone());
        changed = true;
    }
    match changed {
        true => Ok(()),
        false => Err(Error::invalid_input("the sample has no time series; use an augmentation for its type")),
    }
}
