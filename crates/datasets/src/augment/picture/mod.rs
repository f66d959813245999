//! Augmentations of images, with their boxes, masks, keypoints and label maps.

mod affine;
mod blur;
mod border;
mod boxes;
mod centre_crop;
mod colour;
mod cut_out;
mod flip;
mod grey;
mod iou_crop;
mod letterbox;
mod map;
mod mix_up;
mod mosaic;
mod pixel_noise;
mod pixels;
mod placing;
mod polygons;
mod random_crop;
mod random_resized_crop;
mod random_scale;
mod resize;
mod rotate;
mod targets;
mod transform;
mod warp;

#[cfg(test)]
mod tests;

pub use affine::Affine;
pub use blur::Blur;
pub use border::Border;
pub use centre_crop::CentreCrop;
pub use colour::Colour;
pub use cut_out::CutOut;
pub use flip::{Flip, FlipDirection};
pub use grey::Grey;
pub use iou_crop::IouCrop;
pub use letterbox::Letterbox;
pub use map::AffineMap;
pub use mix_up::MixUp;
pub use mosaic::Mosaic;
pub use pixel_noise::PixelNoise;
pub use random_crop::RandomCrop;
pub use random_resized_crop::RandomResizedCrop;
pub use random_scale::RandomScale;
pub use resize::Resize;
pub use rotate::Rotate;
pub use transform::{image_size, transform};
