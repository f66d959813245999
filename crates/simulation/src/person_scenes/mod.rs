//! Images of persons with labels: parametric skinned bodies in random rooms and streets, as a data set.
//!
//! Bodies are our own construction of tubes around a skeleton, skinned by linear blending; they are no scans and no model of
//! any person. An image depends on the seed and its index only.

mod body_shape;
mod dataset;
mod exposure;
mod frame;
mod labels;
mod motion;
mod place;
mod rendered;
mod skeleton;
mod skin;
mod surface;
#[cfg(test)]
mod tests;
mod wardrobe;

pub use dataset::{PersonScenes, PersonTarget};
pub use rendered::RenderedScene;
