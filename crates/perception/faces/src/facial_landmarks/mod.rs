//! Landmarks of faces.

mod face_mesh;

pub use face_mesh::{FaceMesh, FaceMeshParams, FaceTracks};
