//! Pictures for OpenDR: decoding and encoding, and the way from a camera frame to a network's input.

mod camera;
pub mod codec;
pub mod draw;
pub mod preprocess;
mod resize;
pub mod source;
mod video;
mod workers;

pub use codec::{Decoder, Encoder, decode, open, save};
pub use preprocess::{Anchor, ChannelOrder, InputGeometry, InputSample, Preprocess};
pub use resize::resize;
pub use source::{Frame, Source, SourceOptions, VideoInfo};
pub use video::VideoWriter;
