//! Face detection in images: boxes and landmarks of faces.
//!
//! [`face_detection::Yunet`] detects faces with five landmarks, optionally with and without a mask,
//! [`face_detection::UltraLightFace`] boxes only. [`face_detector`] is the detector that other learners of faces contain as a part.
//!
//! Recognition, expressions and dense landmarks of faces are in `opendr-faces`, detectors of other objects in
//! `opendr-detection`. Begin with [`face_detection::Yunet`].
//!
//! ```
//! use std::path::Path;
//!
//! use opendr_engine::Device;
//! use opendr_engine::data::Image;
//! use opendr_engine::learner::Handle;
//! use opendr_face_detection::face_detection::{Yunet, YunetParams};
//!
//! let params = YunetParams { threshold: 0.8, ..YunetParams::default() };
//! let mut detector = Handle::<Yunet>::new(params, Device::Cpu)?;
//! let image = Image::from_rgb8(vec![0; 640 * 480 * 3], 640, 480)?;
//! let container = Path::new("yunet"); // a container from `opendr download yunet`
//! if container.exists() {
//!     detector.load(container)?;
//!     println!("{} faces", detector.infer(&image)?.boxes.len());
//! }
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod face_detection;
pub mod face_detector;
