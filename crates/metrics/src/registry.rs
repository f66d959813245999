//! The list of metrics.

use opendr_engine::{Error, Result};

use crate::MetricEntry;

/// Returns all metrics.
#[rustfmt::skip] // One line per metric.
pub const fn metrics() -> &'static [MetricEntry] {
    const {
        &[
            MetricEntry::of::<crate::Classification>(),
            MetricEntry::of::<crate::ClearMot>(),
            MetricEntry::of::<crate::CocoDetection>(),
            MetricEntry::of::<crate::CocoKeypoints>(),
            MetricEntry::of::<crate::CocoSegmentation>(),
            MetricEntry::of::<crate::Depth>(),
            MetricEntry::of::<crate::Hota>(),
            MetricEntry::of::<crate::Identity>(),
            MetricEntry::of::<crate::Keypoints>(),
            MetricEntry::of::<crate::Kitti>(),
            MetricEntry::of::<crate::Panoptic>(),
            MetricEntry::of::<crate::Regression>(),
            MetricEntry::of::<crate::Reidentification>(),
            MetricEntry::of::<crate::Roc>(),
            MetricEntry::of::<crate::Segmentation>(),
            MetricEntry::of::<crate::Text>(),
            MetricEntry::of::<crate::Tracking3d>(),
            MetricEntry::of::<crate::Transcription>(),
            MetricEntry::of::<crate::Verification>(),
            MetricEntry::of::<crate::Voc>(),
        ]
    }
}

/// Returns the metric `name`.
///
/// # Errors
/// Returns `NotFound` with the list of names if there is none.
pub fn find(name: &str) -> Result<&'static MetricEntry> {
    metrics().iter().find(|entry| entry.name == name).ok_or_else(|| {
        let names: Vec<_> = metrics().iter().map(|entry| entry.name).collect();
        Error::not_found(format!("no metric {name:?}; there are {}", names.join(", ")))
    })
}
