//! Opening of data sets for a metric.

use opendr_datasets::{OpenOptions, Problems, format_of};
use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::{Error, Result};
use opendr_metrics::MetricEntry;

/// Opens a data set with the annotations that `metric` needs.
///
/// # Errors
/// `InvalidInput` when the format has no such annotations; else as [`open`](fn@opendr_datasets::open).
pub fn open_for_metric(
    metric: &MetricEntry,
    dataset: &ExternalDataset,
    split: Option<String>,
    problems: &Problems,
) -> Result<Box<dyn DatasetIterator>> {
    let format = format_of(dataset)?;
    if !format.targets.contains(&metric.ground_truth) {
        let has: Vec<_> = format.targets.iter().map(|target| target.name()).collect();
        return Err(Error::invalid_input(format!(
            "{} needs the annotations {}, but a data set of format {} has {}; choose another metric, or another format",
            metric.name,
            metric.ground_truth.name(),
            format.name,
            has.join(" or ")
        )));
    }
    (format.open)(dataset.path(), &OpenOptions { split, target: Some(metric.ground_truth) }, problems)
}
