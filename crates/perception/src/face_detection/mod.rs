//! Boxes of faces in a picture.

mod ultra_light_face;
mod yunet;

pub use ultra_light_face::{UltraLightFace, UltraLightFaceParams};
pub use yunet::{Yunet, YunetParams};
