//! Encodings of `sensor_msgs/Image` (`sensor_msgs/image_encodings.hpp`).

use opendr_engine::data::{PixelFormat, Pixels};
use opendr_engine::{Error, Result};
use opendr_vision::{BayerPattern, Yuv422};

/// Encoding of an image's samples.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Encoding {
    /// 8 bits per sample.
    U8(PixelFormat),
    /// 16 bits per sample.
    U16(PixelFormat),
    /// 32-bit floats.
    F32(PixelFormat),
    /// Bayer mosaic; 1 or 2 bytes per sample.
    Bayer(BayerPattern, usize),
    /// YUV with chroma shared by two pixels.
    Yuv422(Yuv422),
}

impl Encoding {
    /// Parses the name of an encoding. Of the names without colours, `8UC3`, `16UC3`, `8UC4` and `16UC4` are read as BGR(A), as in
    /// `cv_bridge`, and `32FC3` as RGB.
    pub(super) fn parse(word: &str) -> Result<Self> {
        use PixelFormat::{Bgr, Bgra, Grey, Rgb, Rgba};
        Ok(match word {
            "mono8" | "8UC1" => Self::U8(Grey),
            "rgb8" => Self::U8(Rgb),
            "bgr8" | "8UC3" => Self::U8(Bgr),
            "rgba8" => Self::U8(Rgba),
            "bgra8" | "8UC4" => Self::U8(Bgra),
            "mono16" | "16UC1" => Self::U16(Grey),
            "rgb16" => Self::U16(Rgb),
            "bgr16" | "16UC3" => Self::U16(Bgr),
            "rgba16" => Self::U16(Rgba),
            "bgra16" | "16UC4" => Self::U16(Bgra),
            "32FC1" => Self::F32(Grey),
            "32FC3" => Self::F32(Rgb),
            "32FC4" => Self::F32(Rgba),
            "yuv422" | "uyvy" => Self::Yuv422(Yuv422::Uyvy),
            "yuv422_yuy2" | "yuyv" => Self::Yuv422(Yuv422::Yuyv),
            _ => {
                let mosaic = word.strip_prefix("bayer_").and_then(|rest| {
                    let pattern =
                        BayerPattern::ALL.into_iter().find(|known| rest.starts_with(known.name()))?;
                    match rest.strip_prefix(pattern.name())? {
                        "8" => Some(Self::Bayer(pattern, 1)),
                        "16" => Some(Self::Bayer(pattern, 2)),
                        _ => None,
                    }
                });
                return mosaic.ok_or_else(|| {
                    Error::unsupported(format!(
                        "unsupported encoding {word:?}; OpenDR reads mono8/16, rgb8/16, bgr8/16, rgba8/16, bgra8/16, \
                         8UC1/3/4, 16UC1/3/4, 32FC1/3/4, bayer_*8/16, yuv422, uyvy, yuyv and yuv422_yuy2"
                    ))
                });
            }
        })
    }

    /// Returns the name of the encoding of interleaved samples.
    pub(super) fn word(pixels: &Pixels, format: PixelFormat) -> Result<&'static str> {
        use PixelFormat::{Bgr, Bgra, Grey, Rgb, Rgba};
        Ok(match (pixels, format) {
            (Pixels::U8(_), Grey) => "mono8",
            (Pixels::U8(_), Rgb) => "rgb8",
            (Pixels::U8(_), Bgr) => "bgr8",
            (Pixels::U8(_), Rgba) => "rgba8",
            (Pixels::U8(_), Bgra) => "bgra8",
            (Pixels::U16(_), Grey) => "16UC1",
            (Pixels::U16(_), Rgb) => "rgb16",
            (Pixels::U16(_), Bgr) => "bgr16",
            (Pixels::U16(_), Rgba) => "rgba16",
            (Pixels::U16(_), Bgra) => "bgra16",
            (Pixels::F32(_), Grey) => "32FC1",
            (Pixels::F32(_), Rgb) => "32FC3",
            (Pixels::F32(_), Rgba) => "32FC4",
            (Pixels::F32(_), Bgr | Bgra) => {
                return Err(Error::invalid_input("ROS has no encoding for floats in BGR order; use RGB"));
            }
        })
    }

    /// Returns the minimum number of bytes of a row of `width` pixels.
    pub(super) fn row_bytes(self, width: usize) -> Option<usize> {
        match self {
            Self::U8(format) => width.checked_mul(format.channels()),
            Self::U16(format) => width.checked_mul(format.channels() * 2),
            Self::F32(format) => width.checked_mul(format.channels() * 4),
            Self::Bayer(_, bytes) => width.checked_mul(bytes),
            Self::Yuv422(_) => width.div_ceil(2).checked_mul(4),
        }
    }
}
