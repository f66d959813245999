//! Opening of data sets for a metric.

use opendr_datasets::{Problems, open_for};
use opendr_engine::Result;
use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_metrics::MetricEntry;

/// Opens a data set with the annotations that `metric` needs.
///
/// # Errors
/// As [`open_for`].
pub fn open_for_metric(
    metric: &MetricEntry,
    dataset: &ExternalDataset,
    split: Option<String>,
    problems: &Problems,
) -> Result<Box<dyn DatasetIterator>> {
    open_for(
        &format!("{} needs the annotations", metric.name),
        &[metric.ground_truth],
        dataset,
        split,
        problems,
    )
}
