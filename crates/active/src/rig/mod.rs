//! Rigs without a simulator: a window in a large image, and a set of recorded views.

mod pan_tilt_zoom;
mod recorded_views;

pub use pan_tilt_zoom::PanTiltZoom;
pub use recorded_views::{RecordedView, RecordedViews};
