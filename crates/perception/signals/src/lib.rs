//! Signals of the body: heart beats, and what is wrong with them.
//!
//! Begin with [`heart_anomaly_detection::GatedRecurrentUnit`]; [`beats::BeatDetector`] finds beats in an electrocardiogram.

pub mod beats;
pub mod heart_anomaly_detection;
