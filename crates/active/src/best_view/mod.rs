//! The direction to the best view, estimated from single views and fused over an episode.

mod belief;
mod estimator;
mod fit;
mod frame;

pub use belief::{BestView, BestViewBelief};
pub use estimator::{BestViewEstimate, BestViewEstimator};
pub use fit::fit_best_view;
pub(crate) use frame::in_camera_frame;
