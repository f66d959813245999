//! Pictures for OpenDR: files, folders, videos and cameras; the way to a network's input; drawing what was found.

mod camera;
pub mod codec;
pub mod draw;
pub mod preprocess;
mod resize;
pub mod source;
mod video;
mod workers;

pub use codec::{Decoder, Encoder, decode, encode_png, open, save, save_depth};
pub use preprocess::{Anchor, ChannelOrder, InputGeometry, InputSample, Preprocess};
pub use resize::resize;
pub use source::{Frame, Source, SourceOptions, VideoInfo};
pub use video::VideoWriter;
