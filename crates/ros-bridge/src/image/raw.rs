//! `sensor_msgs/Image`.

use opendr_engine::data::{Image, Layout, Pixels};
use opendr_engine::{Error, Result};
use opendr_messages::sensor_msgs;
use opendr_vision::{rgb_from_bayer, rgb_from_yuv422};

use super::encoding::Encoding;
use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Samples keep type and order; padding of rows is removed. Bayer mosaics and YUV become 8-bit RGB.
impl FromToMessage<sensor_msgs::Image> for Image {
    fn from_message(message: sensor_msgs::Image, _: &RosBridge) -> Result<Self> {
        let header = header_from_message(&message.header);
        let encoding = Encoding::parse(&message.encoding)?;
        let rows = Rows::new(&message, encoding)?;
        let (width, height) = (rows.width, rows.height);
        let image = match encoding {
            Encoding::U8(format) => Self::new(rows.bytes(message.data), width, height, format, Layout::Hwc)?,
            Encoding::U16(format) => {
                let read = if message.is_bigendian == 0 { u16::from_le_bytes } else { u16::from_be_bytes };
                Self::new(rows.numbers(&message.data, read), width, height, format, Layout::Hwc)?
            }
            Encoding::F32(format) => {
                let read = if message.is_bigendian == 0 { f32::from_le_bytes } else { f32::from_be_bytes };
                Self::new(rows.numbers(&message.data, read), width, height, format, Layout::Hwc)?
            }
            Encoding::Bayer(pattern, 1) => {
                let samples = rows.bytes(message.data);
                Self::from_rgb8(rgb_from_bayer(&samples, width, height, pattern)?, width, height)?
            }
            Encoding::Bayer(pattern, _) => {
                // The high bytes are the 8-bit image.
                let high = |bytes: [u8; 2]| if message.is_bigendian == 0 { bytes[1] } else { bytes[0] };
                let samples: Vec<u8> = rows.numbers(&message.data, high);
                Self::from_rgb8(rgb_from_bayer(&samples, width, height, pattern)?, width, height)?
            }
            Encoding::Yuv422(order) => {
                let rgb = rgb_from_yuv422(&message.data, rows.step, width, height, order)?;
                Self::from_rgb8(rgb, width, height)?
            }
        };
        Ok(image.with_header(header))
    }

    fn to_message(&self, _: &RosBridge) -> Result<sensor_msgs::Image> {
        let encoding = Encoding::word(self.pixels(), self.format())?;
        let (data, sample_bytes) = match self.pixels() {
            Pixels::U8(samples) if self.layout() == Layout::Hwc => (samples.to_vec(), 1),
            Pixels::U8(samples) => (bytes(self, samples, |sample| [sample]), 1),
            Pixels::U16(samples) => (bytes(self, samples, u16::to_le_bytes), 2),
            Pixels::F32(samples) => (bytes(self, samples, f32::to_le_bytes), 4),
        };
        let step = self.width() * self.channels() * sample_bytes;
        Ok(sensor_msgs::Image {
            header: message_from_header(&self.header)?,
            height: side(self.height())?,
            width: side(self.width())?,
            encoding: encoding.to_owned(),
            is_bigendian: 0,
            step: side(step)?,
            data,
        })
    }
}

/// Returns the interleaved samples as bytes.
fn bytes<T: Copy, const N: usize>(image: &Image, samples: &[T], write: impl Fn(T) -> [u8; N]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(samples.len() * N);
    match image.layout() {
        Layout::Hwc => bytes.extend(samples.iter().flat_map(|sample| write(*sample))),
        Layout::Chw => {
            let plane = image.width() * image.height();
            for at in 0..plane {
                bytes.extend(samples.iter().skip(at).step_by(plane).flat_map(|sample| write(*sample)));
            }
        }
    }
    bytes
}

fn side(length: usize) -> Result<u32> {
    u32::try_from(length).map_err(|_| {
        Error::invalid_input(format!(
            "the image has a side of {length} pixels; ROS allows at most 4,294,967,295"
        ))
    })
}

/// Layout of the rows, checked against the size of the data.
struct Rows {
    width: usize,
    height: usize,
    step: usize,
    row_bytes: usize,
}

impl Rows {
    fn new(message: &sensor_msgs::Image, encoding: Encoding) -> Result<Self> {
        let (width, height, step) = (message.width as usize, message.height as usize, message.step as usize);
        let row_bytes = encoding.row_bytes(width).unwrap_or(usize::MAX);
        let needed = height.saturating_sub(1).checked_mul(step).and_then(|rows| rows.checked_add(row_bytes));
        if width == 0
            || height == 0
            || step < row_bytes
            || needed.is_none_or(|needed| needed > message.data.len())
        {
            return Err(Error::format(format!(
                "a {} image of {width}x{height} pixels needs rows of {row_bytes} bytes; the message has {} bytes in \
                 rows of {step}",
                message.encoding,
                message.data.len()
            )));
        }
        Ok(Self { width, height, step, row_bytes })
    }

    /// Returns the rows without padding; reuses the memory if there is none.
    fn bytes(&self, mut data: Vec<u8>) -> Vec<u8> {
        let wanted = self.row_bytes * self.height;
        if self.step > self.row_bytes {
            for row in 1..self.height {
                data.copy_within(row * self.step..row * self.step + self.row_bytes, row * self.row_bytes);
            }
        }
        data.truncate(wanted);
        data
    }

    fn numbers<const N: usize, T>(&self, data: &[u8], read: impl Fn([u8; N]) -> T) -> Vec<T> {
        let mut numbers = Vec::with_capacity(self.row_bytes / N * self.height);
        for row in data.chunks(self.step).take(self.height) {
            let (samples, _) = row.get(..self.row_bytes).unwrap_or_default().as_chunks::<N>();
            numbers.extend(samples.iter().map(|bytes| read(*bytes)));
        }
        numbers
    }
}
