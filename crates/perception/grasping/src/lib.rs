//! Grasp detection in colour and depth, and ambiguity of maps.
//!
//! [`grasp_detection`] has the learner [`GrConvNet`](grasp_detection::GrConvNet), which detects grasps of a parallel-jaw
//! gripper. [`ambiguity_measure`] has [`AmbiguityMeasure`](ambiguity_measure::AmbiguityMeasure), which measures whether the
//! highest peak of a map of values is certain; it needs no weights. Object detection is in the crate `opendr-detection`, depth
//! from stereo images in `opendr-stereo`.
//!
//! Begin with `GrConvNet`.
//!
//! ```
//! use opendr_engine::learner::Learner;
//! use opendr_engine::target::Heatmap;
//! use opendr_grasping::ambiguity_measure::{AmbiguityMeasure, AmbiguityMeasureParams, AmbiguityMeasureTargets};
//!
//! let measure = AmbiguityMeasure::with_params(AmbiguityMeasureParams::default());
//! let two_peaks = Heatmap::from_scores(vec![3.0, 0.0, 3.0], &[1, 3])?;
//! let mut targets = AmbiguityMeasureTargets::default();
//! measure.infer_into(&mut (), &two_peaks, &mut targets)?;
//! assert_eq!(targets.category.class, 1);
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod ambiguity_measure;
pub mod grasp_detection;
