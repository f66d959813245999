//! The field's metrics, one file each, as streaming accumulators.
//!
//! A [`Metric`] counts one answer after the other (`update`), keeps little of each, merges with what other threads
//! counted, and ends in a [`Report`]: numbers, tables, and figures to draw. Numbers equal those of the tools that
//! papers cite; each file names its own.

mod any;
mod metric;
mod registry;
mod report;

pub use any::{AnyMetric, MetricEntry};
pub use metric::Metric;
pub use registry::{find, metrics};
pub use report::{Curves, Figure, Line, Matrix, Report, Table};
