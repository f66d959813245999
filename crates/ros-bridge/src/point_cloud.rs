//! Point clouds: `sensor_msgs/PointCloud2` with any layout of its fields.

use opendr_engine::data::PointCloud;
use opendr_engine::{Error, Result};
use opendr_messages::sensor_msgs::{PointCloud2, PointField};

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Written names of the channels; further ones are `channel_7` and so on.
const NAMES: [&str; 7] = ["x", "y", "z", "intensity", "r", "g", "b"];

/// Names of the intensity field in messages of drivers.
const INTENSITIES: [&str; 4] = ["intensity", "intensities", "reflectivity", "i"];

/// Names of colours packed into 32 bits (PCL).
const PACKED_COLOURS: [&str; 2] = ["rgb", "rgba"];

/// Reads x, y, z, then the intensity, then colours (single fields, or packed `rgb`/`rgba` as in PCL, 0 to 255 each), then
/// `channel_N`, of any number type, offset and byte order; other fields (ring, time) are skipped. NaN points are kept. Writes
/// floats in the same order.
impl FromToMessage<PointCloud2> for PointCloud {
    fn from_message(message: PointCloud2, _: &RosBridge) -> Result<Self> {
        let columns = Columns::of(&message)?;
        let (points, step) = (columns.points, message.point_step as usize);
        let (width, row_step) = (message.width as usize, message.row_step as usize);
        let channels = columns.channels();
        let mut data = Vec::with_capacity(points * channels);
        for row in 0..message.height as usize {
            let row = message.data.get(row * row_step..).unwrap_or_default();
            for point in row.chunks_exact(step.max(1)).take(width) {
                for column in &columns.columns {
                    column.push(point, &mut data);
                }
            }
        }
        Ok(Self::new(data, [points, channels])?.with_header(header_from_message(&message.header)))
    }

    fn to_message(&self, _: &RosBridge) -> Result<PointCloud2> {
        const FLOAT_BYTES: usize = size_of::<f32>();
        let number = |value: usize| {
            u32::try_from(value).map_err(|_| {
                Error::invalid_input(format!(
                    "{value} exceeds the limit of 4,294,967,295 in a point cloud message"
                ))
            })
        };
        let mut fields = Vec::with_capacity(self.channels());
        for channel in 0..self.channels() {
            let name = match (self.channels(), channel) {
                // Without intensity.
                (6, 3..) => NAMES.get(channel + 1),
                _ => NAMES.get(channel),
            };
            fields.push(PointField {
                name: name.map_or_else(|| format!("channel_{channel}"), ToString::to_string),
                offset: number(channel * FLOAT_BYTES)?,
                datatype: PointField::FLOAT32,
                count: 1,
            });
        }
        let numbers = self.as_slice();
        Ok(PointCloud2 {
            header: message_from_header(&self.header)?,
            height: 1,
            width: number(self.len())?,
            fields,
            is_bigendian: false,
            point_step: number(self.channels() * FLOAT_BYTES)?,
            row_step: number(numbers.len() * FLOAT_BYTES)?,
            data: numbers.iter().flat_map(|number| number.to_le_bytes()).collect(),
            is_dense: numbers.iter().all(|number| number.is_finite()),
        })
    }
}

/// Columns to read, checked against the size of the data.
struct Columns {
    columns: Vec<Column>,
    points: usize,
}

struct Column {
    offset: usize,
    kind: Kind,
}

enum Kind {
    Number {
        datatype: u8,
        big_endian: bool,
    },
    /// Red, green and blue in 32 bits.
    Packed {
        big_endian: bool,
    },
}

impl Columns {
    fn of(message: &PointCloud2) -> Result<Self> {
        let (width, height) = (message.width as usize, message.height as usize);
        let (step, row_step) = (message.point_step as usize, message.row_step as usize);
        let sizes = width.checked_mul(height).zip(width.checked_mul(step)).and_then(|(points, row)| {
            let before_last = height.saturating_sub(1).checked_mul(row_step)?;
            Some((points, row, before_last.checked_add(row)?))
        });
        let (points, row, needed) = match sizes {
            Some((0, ..)) => (0, 0, 0),
            Some(sizes) => sizes,
            None => (0, usize::MAX, usize::MAX),
        };
        if points > 0 && (step == 0 || needed > message.data.len() || (height > 1 && row_step < row)) {
            return Err(Error::format(format!(
                "a cloud of {width}x{height} points of {step} bytes in rows of {row_step} does not match {} bytes of data",
                message.data.len()
            )));
        }
        let find = |names: &[&str]| {
            names.iter().find_map(|name| message.fields.iter().find(|field| field.name == *name))
        };
        let mut columns = Vec::new();
        for name in ["x", "y", "z"] {
            let field = find(&[name]).ok_or_else(|| {
                let names: Vec<_> = message.fields.iter().map(|field| field.name.as_str()).collect();
                Error::format(format!("the cloud has no field {name:?}; it has {}", names.join(", ")))
            })?;
            columns.push(Column::of(field, message)?);
        }
        if let Some(field) = find(&INTENSITIES) {
            columns.push(Column::of(field, message)?);
        }
        if let [Some(red), Some(green), Some(blue)] = ["r", "g", "b"].map(|name| find(&[name])) {
            for field in [red, green, blue] {
                columns.push(Column::of(field, message)?);
            }
        } else if let Some(field) = find(&PACKED_COLOURS) {
            let mut column = Column::of(field, message)?;
            if !matches!(field.datatype, PointField::FLOAT32 | PointField::UINT32 | PointField::INT32) {
                return Err(Error::unsupported(format!(
                    "packed colours have the unsupported type {}",
                    field.datatype
                )));
            }
            column.kind = Kind::Packed { big_endian: message.is_bigendian };
            columns.push(column);
        }
        for field in message.fields.iter().filter(|field| field.name.starts_with("channel_")) {
            columns.push(Column::of(field, message)?);
        }
        Ok(Self { columns, points })
    }

    fn channels(&self) -> usize {
        let width = |column: &Column| if matches!(column.kind, Kind::Packed { .. }) { 3 } else { 1 };
        self.columns.iter().map(width).sum()
    }
}

impl Column {
    fn of(field: &PointField, message: &PointCloud2) -> Result<Self> {
        let size = match field.datatype {
            PointField::INT8 | PointField::UINT8 => 1,
            PointField::INT16 | PointField::UINT16 => 2,
            PointField::INT32 | PointField::UINT32 | PointField::FLOAT32 => 4,
            PointField::FLOAT64 => 8,
            other => {
                return Err(Error::format(format!(
                    "field {:?} of the cloud has the unknown type {other}",
                    field.name
                )));
            }
        };
        let offset = field.offset as usize;
        if offset + size > message.point_step as usize {
            return Err(Error::format(format!(
                "field {:?} of the cloud has offset {offset}, beyond its points of {} bytes",
                field.name, message.point_step
            )));
        }
        let kind = Kind::Number { datatype: field.datatype, big_endian: message.is_bigendian };
        Ok(Self { offset, kind })
    }

    fn push(&self, point: &[u8], data: &mut Vec<f32>) {
        let bytes = point.get(self.offset..).unwrap_or_default();
        match self.kind {
            Kind::Packed { big_endian } => {
                let [_, red, green, blue] = first(bytes, big_endian, u32::from_be_bytes).to_be_bytes();
                data.extend([red, green, blue].map(f32::from));
            }
            Kind::Number { datatype, big_endian } => data.push(match datatype {
                PointField::INT8 => f32::from(first(bytes, big_endian, i8::from_be_bytes)),
                PointField::UINT8 => f32::from(first(bytes, big_endian, u8::from_be_bytes)),
                PointField::INT16 => f32::from(first(bytes, big_endian, i16::from_be_bytes)),
                PointField::UINT16 => f32::from(first(bytes, big_endian, u16::from_be_bytes)),
                PointField::INT32 => first(bytes, big_endian, i32::from_be_bytes) as f32,
                PointField::UINT32 => first(bytes, big_endian, u32::from_be_bytes) as f32,
                PointField::FLOAT64 => first(bytes, big_endian, f64::from_be_bytes) as f32,
                _ => first(bytes, big_endian, f32::from_be_bytes),
            }),
        }
    }
}

/// Returns the number at the start of `bytes`, whose length was checked.
fn first<const N: usize, T>(bytes: &[u8], big_endian: bool, read: fn([u8; N]) -> T) -> T {
    let mut own = bytes.first_chunk().copied().unwrap_or([0; N]);
    if !big_endian {
        own.reverse();
    }
    read(own)
}
