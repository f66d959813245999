//! Reading and writing of video files through the installed program `ffmpeg`.

mod ffmpeg;
mod frame_line;
mod probe;
mod reader;
mod writer;

#[cfg(test)]
mod tests;

pub(crate) use ffmpeg::Ffmpeg;
pub(crate) use probe::probe;
pub(crate) use reader::VideoReader;
pub use writer::VideoWriter;
