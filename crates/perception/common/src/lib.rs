//! Building blocks that the families of perception learners share.
//!
//! The crate holds no learner. Its modules, by purpose:
//!
//! * Inputs: [`image_network`] (a session with fused pre-processing of one image), [`manifest_preprocess`] (pre-processing from
//!   a model's manifest), [`exported_network`] (networks of other tools), [`clip_frames`], [`frame_features`] (features of skeletons).
//! * Texts: [`byte_pairs`] (tokens of byte pair encodings).
//! * Outputs: [`category_scores`] (categories from logits), [`suppression`] (non-maximum suppression),
//!   [`boxes_from_candidates`], [`mask_runs`] (masks as run lengths), [`part_tree`] (PersonLab's decoder of poses), [`joints`], [`rotated_square`].
//! * Second passes over parts of a large image: [`regions`].
//! * Training, with the feature `training`: [`labelled`], [`trainable_weights`], [`frozen_layers`], [`dynamic_sides`],
//!   [`small_backbone`] and [`small_classifier`]; [`progressive`] (networks that grow).
//!
//! Data and target types are in `opendr-engine`, sessions in `opendr-inference`, image pre-processing in `opendr-vision`, the
//! training loop in `opendr-training`, tiles of large images in `opendr-tiling`. Code that only one family needs is in the crate
//! of that family. A learner of one image begins with [`image_network::ImageNetwork`].
//!
//! ```
//! use opendr_perception_common::suppression::{Candidate, Suppression, SuppressionKind};
//!
//! let candidate = |left: f32, score: f32, index: u32| Candidate {
//!     corners: [left, 0.0, left + 10.0, 10.0],
//!     score,
//!     class: 0,
//!     index,
//! };
//! let mut candidates = vec![candidate(1.0, 0.8, 0), candidate(0.0, 0.9, 1), candidate(50.0, 0.7, 2)];
//! let suppression = Suppression { kind: SuppressionKind::Hard, iou_threshold: 0.5, threshold: 0.1, max_boxes: 100 };
//! suppression.run(&mut candidates, &mut Vec::new());
//! let kept: Vec<u32> = candidates.iter().map(|candidate| candidate.index).collect();
//! assert_eq!(kept, [1, 2]);
//! ```

pub mod boxes_from_candidates;
pub mod byte_pairs;
pub mod category_scores;
pub mod clip_frames;
#[cfg(feature = "training")]
pub mod dynamic_sides;
pub mod exported_network;
pub mod frame_features;
#[cfg(feature = "training")]
pub mod frozen_layers;
pub mod image_network;
pub mod joints;
#[cfg(feature = "training")]
pub mod labelled;
pub mod manifest_preprocess;
pub mod mask_runs;
pub mod part_tree;
pub mod progressive;
pub mod regions;
pub mod rotated_square;
#[cfg(feature = "training")]
pub mod small_backbone;
#[cfg(feature = "training")]
pub mod small_classifier;
pub mod suppression;
#[cfg(feature = "training")]
pub mod trainable_weights;
