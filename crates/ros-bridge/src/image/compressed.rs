//! `sensor_msgs/CompressedImage`, as in `image_transport`'s plugins `compressed` and `compressedDepth`.

use opendr_engine::data::{Image, Pixels};
use opendr_engine::{Error, Result};
use opendr_messages::sensor_msgs;
use opendr_vision::{Encoder, decode, encode_depth_png};

use super::depth_compressed;
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// The format (JPEG, PNG, WebP, BMP) is detected from the content, since drivers write `format` in many ways. 8-bit images are
/// written as JPEG, 16-bit images losslessly as PNG; floating-point images are refused.
impl FromToMessage<sensor_msgs::CompressedImage> for Image {
    fn from_message(message: sensor_msgs::CompressedImage, _: &RosBridge) -> Result<Self> {
        let image = if message.format.contains("compressedDepth") {
            depth_compressed::read(&message.format, &message.data)?
        } else {
            read_whole(&message.data)?
        };
        Ok(image.with_header(header_from_message(&message.header)))
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<sensor_msgs::CompressedImage> {
        let (format, data) = match self.pixels() {
            Pixels::U8(_) => {
                let encoder = Encoder { jpeg_quality: bridge.jpeg_quality };
                ("rgb8; jpeg compressed bgr8", encoder.encode_jpeg(self)?)
            }
            Pixels::U16(_) if self.channels() == 1 => ("16UC1; png compressed ", encode_depth_png(self)?),
            Pixels::F32(_) if self.channels() == 1 => {
                return Err(Error::invalid_input(
                    "floating-point images cannot be compressed; send sensor_msgs/msg/Image, or millimetres as u16",
                ));
            }
            Pixels::U16(_) | Pixels::F32(_) => {
                return Err(Error::invalid_input(
                    "only 8-bit images can have several channels when compressed",
                ));
            }
        };
        let header = message_from_header(&self.header)?;
        Ok(sensor_msgs::CompressedImage { header, format: format.to_owned(), data })
    }
}

/// Decodes an image; a 16-bit PNG keeps its depth, others become 8-bit.
fn read_whole(data: &[u8]) -> Result<Image> {
    const BIT_DEPTH_OF_PNG: usize = 24;
    if data.starts_with(b"\x89PNG") && data.get(BIT_DEPTH_OF_PNG..BIT_DEPTH_OF_PNG + 2) == Some(&[16, 0]) {
        return opendr_vision::Decoder::default().decode_depth(data);
    }
    decode(data)
}
