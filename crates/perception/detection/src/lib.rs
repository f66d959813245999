//! Object detection in images: boxes with class labels.
//!
//! Learners: [`object_detection_2d::Yolox`], [`object_detection_2d::FastestDet`], [`object_detection_2d::CenterNet`], [`object_detection_2d::Nanodet`],
//! [`object_detection_2d::ImportedDetector`] (ONNX files of other tools), [`object_detection_2d::SingleShotDetector`] (SSD, trainable
//! on own classes), [`object_detection_2d::Gem`] (colour and infrared), [`object_detection_2d::Seq2SeqNms`] (learned non-maximum
//! suppression) and [`object_detection_2d::TiledDetection`] (any detector over tiles of large images).
//! `fit` needs the feature `training`.
//!
//! Face detectors are in `opendr-face-detection`, 3D detectors in `opendr-clouds`, greedy suppression in
//! `opendr-perception-common`, boxes as types in `opendr-engine`. Begin with [`object_detection_2d::Nanodet`].
//!
//! ```
//! use std::path::Path;
//!
//! use opendr_detection::object_detection_2d::{Nanodet, NanodetParams};
//! use opendr_engine::data::Image;
//! use opendr_engine::learner::Handle;
//! use opendr_engine::Device;
//!
//! let params = NanodetParams { threshold: 0.5, ..NanodetParams::default() };
//! let mut detector = Handle::<Nanodet>::new(params, Device::Cpu)?;
//! let image = Image::from_rgb8(vec![0; 640 * 480 * 3], 640, 480)?;
//! let container = Path::new("nanodet"); // a container from `opendr download nanodet`
//! if container.exists() {
//!     detector.load(container)?;
//!     for detection in &detector.infer(&image)?.boxes {
//!         println!("{detection}");
//!     }
//! }
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod object_detection_2d;
