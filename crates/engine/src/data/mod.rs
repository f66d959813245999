//! What learners are given: pictures, clouds, sound, series. One file per type.

mod image;
mod image_view;

pub use image::{Image, Layout, PixelFormat, Pixels};
pub use image_view::{ImageView, Samples};
