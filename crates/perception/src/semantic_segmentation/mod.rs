//! The class of every pixel of a picture.

mod deeplab;

pub use deeplab::{Deeplab, DeeplabParams};
