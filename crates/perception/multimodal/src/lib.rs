//! Learners of several modalities at once.
//!
//! Begin with [`multimodal_human_centric::AudiovisualEmotion`], which sees and hears a person.

pub mod multimodal_human_centric;
