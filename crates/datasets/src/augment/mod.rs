//! Augmentation: random changes of samples, data and target together. One file for each augmentation.
//!
//! An [`Augment`] takes all randomness from the [`Random`](opendr_engine::Random) it receives, so a sample does not
//! depend on the thread that processes it. A target that cannot be changed like the data (a 3D box when its image
//! is rotated) is an error.

mod audio;
mod augmentation;
pub(crate) mod cloud;
mod other_samples;
mod picture;
mod pipeline;
mod registry;
mod series;

pub use audio::{AudioGain, AudioNoise, AudioShift};
pub use augmentation::{Augment, AugmentEntry, Augmentation};
pub use cloud::{CloudFlip, CloudRotate, CloudScale, DropPoints, JitterPoints, PasteObjects};
pub use other_samples::OtherSamples;
pub use picture::{
    Affine, AffineMap, Blur, Border, CentreCrop, Colour, CutOut, Flip, FlipDirection, Grey, IouCrop,
    Letterbox, MixUp, Mosaic, PixelNoise, RandomCrop, RandomResizedCrop, RandomScale, Resize, Rotate,
    image_size, transform,
};
pub use pipeline::Pipeline;
pub use registry::{augmentations, find_augmentation};
pub use series::{SeriesJitter, SeriesScale, SpecAugment};
