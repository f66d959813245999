//! Stereo matching: disparity, depth and obstacles from two cameras.
//!
//! [`SemiGlobalMatching`](stereo_matching::SemiGlobalMatching) is the learner; it needs no weights. The matching itself,
//! rectified cameras and point clouds of depths are in `opendr_vision::stereo`.
//!
//! Begin with `SemiGlobalMatching`.
//!
//! ```
//! use opendr_stereo::stereo_matching::{SemiGlobalMatching, SemiGlobalMatchingParams};
//!
//! let params = SemiGlobalMatchingParams { focal_length: 500.0, baseline: 0.1, ..Default::default() };
//! let matching = SemiGlobalMatching::with_params(params);
//! let camera = matching.camera([640, 480]).expect("focal length and baseline are set");
//! assert!((camera.depth(50.0) - 1.0).abs() < 1e-5);
//! ```

pub mod stereo_matching;
