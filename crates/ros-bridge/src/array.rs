//! Arrays of floats: `opendr_msgs/Float32MultiArrayStamped`, and `std_msgs/Float32MultiArray` without stamp and frame.

use opendr_engine::data::{SkeletonSequence, Timeseries, Vector, Video};
use opendr_engine::{Error, Header, Result};
use opendr_messages::opendr_msgs::Float32MultiArrayStamped;
use opendr_messages::std_msgs::{Float32MultiArray, MultiArrayDimension, MultiArrayLayout};

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Writes an array whose axes are named `labels`.
///
/// # Errors
/// `InvalidInput` for more than 2^32 - 1 numbers.
pub(crate) fn message_from_array(
    shape: &[usize],
    labels: &[&str],
    data: &[f32],
) -> Result<Float32MultiArray> {
    let mut stride = data.len();
    let mut dim = Vec::with_capacity(shape.len());
    for (axis, &size) in shape.iter().enumerate() {
        let label = labels.get(axis).copied().unwrap_or_default().to_owned();
        dim.push(MultiArrayDimension { label, size: number(size)?, stride: number(stride)? });
        stride = stride.checked_div(size).unwrap_or(0);
    }
    Ok(Float32MultiArray { layout: MultiArrayLayout { dim, data_offset: 0 }, data: data.to_vec() })
}

fn number(value: usize) -> Result<u32> {
    u32::try_from(value).map_err(|_| {
        Error::invalid_input(format!("the array has {value} numbers; a message holds at most 4,294,967,295"))
    })
}

/// Returns shape and numbers of a contiguous array; one without a layout has the shape `[data.len()]`.
///
/// # Errors
/// `Format` when the layout does not match the numbers, or is not contiguous.
pub(crate) fn array_from_message(message: Float32MultiArray) -> Result<(Vec<usize>, Vec<f32>)> {
    let Float32MultiArray { layout, data } = message;
    if layout.dim.is_empty() {
        return Ok((vec![data.len()], data));
    }
    let shape: Vec<usize> = layout.dim.iter().map(|dim| dim.size as usize).collect();
    let wanted = shape.iter().try_fold(1_usize, |count, size| count.checked_mul(*size));
    let offset = layout.data_offset as usize;
    if offset != 0 || wanted != Some(data.len()) {
        return Err(Error::format(format!(
            "the layout {shape:?} with offset {offset} does not match {} numbers; send a contiguous array",
            data.len()
        )));
    }
    Ok((shape, data))
}

fn exact<const D: usize>(shape: &[usize], name: &str) -> Result<[usize; D]> {
    shape.try_into().map_err(|_| {
        Error::format(format!(
            "an array of {} axes cannot be a {name}, which has {D}: {shape:?}",
            shape.len()
        ))
    })
}

macro_rules! arrays {
    ($($name:ident $axes:literal $labels:expr;)*) => {$(
        /// Axes by name, numbers unchanged.
        impl FromToMessage<Float32MultiArrayStamped> for $name {
            fn from_message(message: Float32MultiArrayStamped, _: &RosBridge) -> Result<Self> {
                let (shape, data) = array_from_message(message.array)?;
                let shape = exact::<$axes>(&shape, stringify!($name))?;
                Ok(Self::new(data, shape)?.with_header(header_from_message(&message.header)))
            }

            fn to_message(&self, _: &RosBridge) -> Result<Float32MultiArrayStamped> {
                let array = message_from_array(&self.shape(), &$labels, self.as_slice())?;
                Ok(Float32MultiArrayStamped { header: message_from_header(&self.header)?, array })
            }
        }
    )*};
}

arrays! {
    Timeseries 2 ["time", "features"];
    Vector 1 ["numbers"];
    Video 4 ["channels", "time", "height", "width"];
    SkeletonSequence 5 ["samples", "channels", "frames", "joints", "persons"];
}

/// Array of other nodes: the stamp is the time of arrival, and a plain row is one feature over time.
impl FromToMessage<Float32MultiArray> for Timeseries {
    fn from_message(message: Float32MultiArray, _: &RosBridge) -> Result<Self> {
        let (shape, data) = array_from_message(message)?;
        let shape = if let [length] = shape[..] { [length, 1] } else { exact::<2>(&shape, "Timeseries")? };
        Ok(Self::new(data, shape)?.with_header(Header::default()))
    }

    fn to_message(&self, _: &RosBridge) -> Result<Float32MultiArray> {
        message_from_array(&self.shape(), &["time", "features"], self.as_slice())
    }
}

/// Without stamp and frame.
impl FromToMessage<Float32MultiArray> for Vector {
    fn from_message(message: Float32MultiArray, _: &RosBridge) -> Result<Self> {
        let (_, data) = array_from_message(message)?;
        Self::from_data(data)
    }

    fn to_message(&self, _: &RosBridge) -> Result<Float32MultiArray> {
        message_from_array(&self.shape(), &["numbers"], self.as_slice())
    }
}
