//! Heart signals and other time series: beat detection, anomaly detection, classification of streams.
//!
//! [`beats`] detects the beats of an electrocardiogram in a stream, without a learner. [`heart_anomaly_detection`] classifies
//! single beats or recordings with [`GatedRecurrentUnit`](heart_anomaly_detection::GatedRecurrentUnit) or
//! [`AttentionNeuralBagOfFeature`](heart_anomaly_detection::AttentionNeuralBagOfFeature). [`sequence_classification`]
//! classifies a stream of feature vectors after every step with [`CoTransEnc`](sequence_classification::CoTransEnc). The
//! feature `training` adds `fit`. Readers of recordings (WFDB, UCR) are in the crate `opendr-datasets`.
//!
//! Begin with `GatedRecurrentUnit` for recordings of a heart or `CoTransEnc` for streams, or with [`beats::BeatDetector`] for
//! beats alone; the documentation of [`beats`] has an example.
//!
//! ```
//! use opendr_engine::Device;
//! use opendr_engine::learner::Handle;
//! use opendr_signals::heart_anomaly_detection::{GatedRecurrentUnit, GatedRecurrentUnitParams};
//!
//! let learner = Handle::<GatedRecurrentUnit>::new(GatedRecurrentUnitParams::default(), Device::Cpu)?;
//! // After `load`, `infer` returns the `Category` of a `Timeseries`.
//! assert!(!learner.is_ready());
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod beats;
pub mod heart_anomaly_detection;
mod model_checks;
pub mod sequence_classification;
