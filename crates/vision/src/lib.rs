//! Image decoding and encoding, pre-processing, drawing, and frames from files, videos and cameras.
//!
//! Contents:
//! * [`Source`]: frames from image files, folders, patterns, videos and cameras. Begin here to read input.
//! * [`Preprocess`]: the input tensor of a network from any [`Image`](opendr_engine::data::Image), in one pass.
//! * [`codec`]: image files; [`draw`]: predictions drawn onto images; [`VideoWriter`]: video files.
//! * [`stereo`]: disparities by semi-global matching; [`components`]: connected-component labelling; [`Similarity`]:
//!   rotated crops, [`Warp`]: affine ones; [`rgb_from_bayer`] and [`rgb_from_yuv422`]: raw pixel formats.
//!
//! The types of images and targets are in `opendr-engine`, augmentation is in `opendr-datasets`, and networks run in
//! `opendr-inference`.
//!
//! ```
//! use opendr_engine::data::Image;
//! use opendr_vision::{Preprocess, decode, encode_png};
//!
//! let image = Image::from_rgb8(vec![128; 64 * 48 * 3], 64, 48)?;
//! let image = decode(&encode_png(&image)?)?;
//! let preprocess = Preprocess::new(32, 32).normalise([0.0; 3], [255.0; 3]);
//! let mut input = vec![0f32; preprocess.len()];
//! preprocess.run_into(image.view(), &mut input)?;
//! assert!((input[0] - 128.0 / 255.0).abs() < 1e-6);
//! # Ok::<(), opendr_engine::Error>(())
//! ```

mod bayer;
mod camera;
pub mod codec;
pub mod components;
pub mod draw;
pub mod preprocess;
mod resize;
mod similarity;
pub mod source;
pub mod stereo;
mod video;
mod warp;
mod workers;
mod yuv422;

pub use bayer::{BayerPattern, rgb_from_bayer};
pub use codec::{Decoder, Encoder, decode, encode_depth_png, encode_png, open, save, save_depth};
pub use preprocess::{Border, ChannelOrder, InputGeometry, InputSample, LetterboxAlign, Preprocess};
pub use resize::resize;
pub use similarity::Similarity;
pub use source::{Frame, Source, SourceOptions, VideoInfo};
pub use video::VideoWriter;
pub use warp::Warp;
pub use yuv422::{Yuv422, rgb_from_yuv422};
