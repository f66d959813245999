//! Pictures for OpenDR: files, folders, videos and cameras; the way to a network's input; drawing what was found.

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
mod workers;
mod yuv422;

pub use bayer::{BayerPattern, rgb_from_bayer};
pub use codec::{Decoder, Encoder, decode, encode_depth_png, encode_png, open, save, save_depth};
pub use preprocess::{Anchor, Border, ChannelOrder, InputGeometry, InputSample, Preprocess};
pub use resize::resize;
pub use similarity::Similarity;
pub use source::{Frame, Source, SourceOptions, VideoInfo};
pub use video::VideoWriter;
pub use yuv422::{Yuv422, rgb_from_yuv422};
