//! The field's metrics, one file each, as streaming accumulators.
//!
//! A [`Metric`] counts one answer after the other (`update`), keeps little of each, merges with what other threads
//! counted, and ends in a [`Report`]: numbers, tables, and figures to draw. Numbers equal those of the tools that
//! papers cite; each file names its own.

mod any;
mod calibration;
mod classification;
mod metric;
mod precision_recall;
mod registry;
mod report;
mod roc;
mod verification;

pub use any::{AnyMetric, MetricEntry};
pub use calibration::{Calibration, CalibrationBin};
pub use classification::{Classification, ClassificationParams};
pub use metric::Metric;
pub use precision_recall::{ClassCounts, ClassScore, ClassScores, PrecisionRecall, ZeroDivision};
pub use registry::{find, metrics};
pub use report::{Curves, Figure, Line, Matrix, Report, Table};
pub use roc::{Roc, RocCurve, RocParams, RocPoint};
pub use verification::{FoldAccuracy, Verification, VerificationParams};
