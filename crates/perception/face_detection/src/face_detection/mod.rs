//! Detection of faces in images.

mod masked_face;
mod ultra_light_face;
mod yunet;

pub use masked_face::mask_crop;
pub use ultra_light_face::{UltraLightFace, UltraLightFaceParams};
pub use yunet::{Yunet, YunetParams};
