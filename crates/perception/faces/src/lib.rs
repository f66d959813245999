//! Face recognition, facial expression recognition and facial landmarks.
//!
//! [`face_recognition::FaceRecognition`] recognises persons, [`facial_expression_recognition::FacialEmotion`] classifies the
//! emotion of a face, [`facial_expression_recognition::ProgressiveSpatioTemporalBln`] expressions from sequences of landmarks,
//! and [`facial_landmarks::FaceMesh`] detects 478 landmarks. `fit` needs the feature `training`.
//!
//! The face detectors, which these learners contain as a part, are in `opendr-face-detection`. Begin with
//! [`face_recognition::FaceRecognition`].
//!
//! ```
//! use std::path::Path;
//!
//! use opendr_engine::Device;
//! use opendr_engine::data::Image;
//! use opendr_engine::learner::Handle;
//! use opendr_faces::face_recognition::{FaceRecognition, FaceRecognitionParams};
//!
//! let mut recogniser = Handle::<FaceRecognition>::new(FaceRecognitionParams::default(), Device::Cpu)?;
//! let image = Image::from_rgb8(vec![0; 640 * 480 * 3], 640, 480)?;
//! let container = Path::new("face_recognition"); // a container from `opendr download face_recognition`
//! if container.exists() {
//!     recogniser.load(container)?;
//!     println!("{}", recogniser.infer(&image)?);
//! }
//! # Ok::<(), opendr_engine::Error>(())
//! ```

pub mod face_recognition;
pub mod facial_expression_recognition;
pub mod facial_landmarks;
