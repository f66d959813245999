//! What the families of perception learners share.
//!
//! A family adds what only it needs. [`picture_network`] runs a network on a picture, [`category_scores`] makes a category of
//! its outputs, [`suppression`] thins out boxes; with the feature `training`, [`labelled`] and [`trainable_weights`] serve the
//! learners that train.

pub mod boxes_from_candidates;
pub mod category_scores;
pub mod clip_frames;
pub mod described_input;
pub mod frame_features;
#[cfg(feature = "training")]
pub mod frozen_layers;
pub mod joints;
#[cfg(feature = "training")]
pub mod labelled;
#[cfg(feature = "training")]
pub mod open_sides;
pub mod part_tree;
pub mod picture_network;
pub mod regions;
#[cfg(feature = "training")]
pub mod small_backbone;
#[cfg(feature = "training")]
pub mod small_classifier;
pub mod suppression;
#[cfg(feature = "training")]
pub mod trainable_weights;
pub mod turned_square;
