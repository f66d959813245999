//! Rigs without a simulator: a window in a large image, and a set of recorded views. Rigs by name.

mod open_rig;
mod pan_tilt_zoom;
mod recorded_views;

pub use open_rig::RigOptions;
pub use pan_tilt_zoom::PanTiltZoom;
pub use recorded_views::{RecordedView, RecordedViews};
