//! Learners of faces: whose face it is, what it expresses, where its landmarks are.
//!
//! Begin with [`face_recognition::FaceRecognition`]. Each carries a face detector of the crate `opendr-face-detection`.

pub mod face_recognition;
pub mod facial_expression_recognition;
pub mod facial_landmarks;
