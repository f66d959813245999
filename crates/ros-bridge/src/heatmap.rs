//! Maps of class indices or scores: `sensor_msgs/Image`.

use opendr_engine::data::{Image, Layout, PixelFormat, Pixels};
use opendr_engine::target::{Heatmap, HeatmapValues};
use opendr_engine::{Error, Result};
use opendr_messages::sensor_msgs;

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Class indices are `mono8`, `16UC1` or `32SC1`, the smallest that holds them. Scores are `32FC1`; those of shape
/// `[classes, height, width]` are `32FCn` with n classes. `vision_msgs/LabelInfo` contains the names of the classes.
impl FromToMessage<sensor_msgs::Image> for Heatmap {
    fn from_message(mut message: sensor_msgs::Image, bridge: &RosBridge) -> Result<Self> {
        let header = header_from_message(&message.header);
        let (height, width) = (message.height as usize, message.width as usize);
        let channels = match message.encoding.strip_prefix("32FC").map(str::parse::<usize>) {
            Some(Ok(channels)) if channels > 0 => channels,
            Some(_) => {
                return Err(Error::format(format!("the encoding {:?} is not one of maps", message.encoding)));
            }
            None => 0,
        };
        if channels > 0 || message.encoding == "32SC1" {
            // Read the same bytes as a wider image of one float per pixel.
            message.encoding = "32FC1".to_owned();
            let wide = u32::try_from(width.saturating_mul(channels.max(1)));
            message.width = wide
                .map_err(|_| Error::format(format!("{channels} channels of {width} pixels are too many")))?;
        }
        let image: Image = bridge.from_message(message)?;
        let mut map = match image.pixels() {
            Pixels::U8(labels) => {
                Self::from_labels(labels.iter().copied().map(u32::from).collect(), &[height, width])
            }
            Pixels::U16(labels) => {
                Self::from_labels(labels.iter().copied().map(u32::from).collect(), &[height, width])
            }
            Pixels::F32(bits) if channels == 0 => {
                Self::from_labels(bits.iter().map(|bits| bits.to_bits()).collect(), &[height, width])
            }
            Pixels::F32(scores) if channels == 1 => Self::from_scores(scores.to_vec(), &[height, width]),
            Pixels::F32(scores) => {
                let mut planes = Vec::with_capacity(scores.len());
                for channel in 0..channels {
                    planes.extend(scores.iter().skip(channel).step_by(channels));
                }
                Self::from_scores(planes, &[channels, height, width])
            }
        }?;
        map.header = header;
        Ok(map)
    }

    fn to_message(&self, bridge: &RosBridge) -> Result<sensor_msgs::Image> {
        let (channels, height, width) = match (self.shape(), self.values()) {
            (&[height, width], _) => (1, height, width),
            (&[channels, height, width], HeatmapValues::Scores(_)) => (channels, height, width),
            (shape, _) => {
                return Err(Error::invalid_input(format!("a map of shape {shape:?} is not an image")));
            }
        };
        let mut encoding = None;
        let pixels = match self.values() {
            HeatmapValues::Labels(labels) => match labels.iter().max().copied().unwrap_or(0) {
                0..=0xff => Pixels::from(labels.iter().map(|label| *label as u8).collect::<Vec<_>>()),
                0x100..=0xffff => Pixels::from(labels.iter().map(|label| *label as u16).collect::<Vec<_>>()),
                _ => {
                    encoding = Some("32SC1".to_owned());
                    Pixels::from(labels.iter().map(|label| f32::from_bits(*label)).collect::<Vec<_>>())
                }
            },
            HeatmapValues::Scores(scores) if channels == 1 => Pixels::from(scores.to_vec()),
            HeatmapValues::Scores(scores) => {
                encoding = Some(format!("32FC{channels}"));
                let plane = height * width;
                let at = |pixel: usize| scores.iter().skip(pixel).step_by(plane.max(1));
                Pixels::from((0..plane).flat_map(at).copied().collect::<Vec<_>>())
            }
        };
        let image = Image::new(pixels, width * channels, height, PixelFormat::Grey, Layout::Hwc)?;
        let mut message: sensor_msgs::Image = bridge.to_message(&image)?;
        message.header = message_from_header(&self.header)?;
        message.width /= u32::try_from(channels).unwrap_or(u32::MAX).max(1);
        if let Some(encoding) = encoding {
            message.encoding = encoding;
        }
        Ok(message)
    }
}
