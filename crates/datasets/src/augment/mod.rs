//! Augmentation: samples changed at random, data and target together. One file each.
//!
//! An [`Augment`] takes all its chance from the [`Random`](opendr_engine::Random) it is given, so that a sample comes out
//! the same whichever thread works on it. What cannot follow a change (a 3D box when its picture is turned) is refused, never left behind.

mod audio;
mod augmentation;
pub(crate) mod cloud;
mod others;
mod picture;
mod pipeline;
mod registry;
mod series;

pub use audio::{AudioGain, AudioNoise, AudioShift};
pub use augmentation::{Augment, AugmentEntry, Augmentation};
pub use cloud::{CloudFlip, CloudRotate, CloudScale, DropPoints, JitterPoints, PasteObjects};
pub use others::Others;
pub use picture::{
    Affine, Blur, Border, CentreCrop, Colour, CutOut, Flip, FlipDirection, Grey, IouCrop, Letterbox, MixUp,
    Mosaic, PictureMap, PixelNoise, RandomCrop, RandomResizedCrop, RandomScale, Resize, Rotate, picture_size,
    transform,
};
pub use pipeline::Pipeline;
pub use registry::{augmentations, find_augmentation};
pub use series::{SeriesJitter, SeriesScale, SpecAugment};
