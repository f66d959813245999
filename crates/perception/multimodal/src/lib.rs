//! Learners of several modalities: audio with video, colour with depth.
//!
//! [`AudiovisualEmotion`](multimodal_human_centric::AudiovisualEmotion) recognises emotions from voice and face,
//! [`RgbdHandGesture`](multimodal_human_centric::RgbdHandGesture) hand gestures from colour and depth; both train with the
//! feature `training`. Learners of faces and hands alone are in the crates `opendr-faces` and `opendr-hands`, audio features in
//! `opendr-audio`.
//!
//! Begin with `AudiovisualEmotion`.
//!
//! ```
//! use opendr_engine::Device;
//! use opendr_engine::learner::Handle;
//! use opendr_multimodal::multimodal_human_centric::{AudiovisualEmotion, AudiovisualEmotionParams};
//!
//! let learner = Handle::<AudiovisualEmotion>::new(AudiovisualEmotionParams::default(), Device::Cpu)?;
//! // After `load`, `infer` returns the `Category` of an `Audio` with an optional `Video`.
//! assert!(!learner.is_ready());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod multimodal_human_centric;
