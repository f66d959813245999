//! Sliding windows: kernel, stride, dilation and padding of convolutions and pooling.

use opendr_engine::{Error, Result};

use crate::tensorflow::call::Call;
use crate::tensorflow::layout::Order;
use opendr_onnx::{Dim, Operator};

/// Maximum stride, dilation and kernel size; the bound prevents overflow.
const MAX_EXTENT: i64 = 1 << 16;

/// Height and width.
pub type Pair<T> = [T; 2];

/// Indices of height, width and channels among TensorFlow's axes.
#[derive(Clone, Copy)]
pub struct Axes {
    pub height: usize,
    pub width: usize,
    pub channels: usize,
}

impl Axes {
    /// Reads `data_format`; the default is channels-last.
    pub fn of(call: &Call) -> Self {
        match call.attr().text("data_format") {
            Some("NCHW") => Self { height: 2, width: 3, channels: 1 },
            _ => Self { height: 1, width: 2, channels: 3 },
        }
    }

    /// Returns the order of ONNX: batch, channels, height, width.
    pub fn order(self) -> Order {
        Order::new(vec![0, self.channels, self.height, self.width])
    }

    /// Returns height and width of TensorFlow's dimensions.
    ///
    /// # Errors
    /// `Format` when there are not four dimensions.
    pub fn spatial(self, dims: &[Dim]) -> Result<Pair<Dim>> {
        match dims.len() {
            4 => Ok([dims[self.height], dims[self.width]]),
            rank => Err(Error::format(format!("the image has rank {rank} instead of 4"))),
        }
    }

    /// Returns TensorFlow's dimensions.
    pub fn dims(self, batch: Dim, channels: Dim, spatial: Pair<Dim>) -> Vec<Dim> {
        self.order().logical(&[batch, channels, spatial[0], spatial[1]])
    }

    /// Returns height and width of a list with one number per axis; ones when it is missing.
    fn pair(self, values: &[i64]) -> Result<Pair<usize>> {
        let extent = |axis: usize| {
            let value = if values.is_empty() { 1 } else { *values.get(axis).unwrap_or(&0) };
            usize::try_from(value).ok().filter(|_| (1..=MAX_EXTENT).contains(&value))
        };
        match (extent(self.height), extent(self.width)) {
            (Some(height), Some(width)) => Ok([height, width]),
            _ => Err(Error::format(format!("the window parameter {values:?} is out of range"))),
        }
    }
}

/// Padding mode of TensorFlow.
#[derive(Clone, Debug, PartialEq)]
pub enum Padding {
    /// Padding for an output of the input's size divided by the stride, rounded up.
    Same,
    /// Explicit padding before and after height and width.
    Fixed(Pair<Pair<usize>>),
}

/// A sliding window over height and width.
#[derive(Clone, Debug)]
pub struct Window {
    pub kernel: Pair<usize>,
    pub strides: Pair<usize>,
    pub dilations: Pair<usize>,
    pub padding: Padding,
}

impl Window {
    /// Reads the parameters of a node with a kernel of the given height and width.
    ///
    /// # Errors
    /// `Format` for parameters out of range, `Unsupported` for an unknown padding mode.
    pub fn of(call: &Call, axes: Axes, kernel: Pair<usize>) -> Result<Self> {
        if kernel.iter().any(|&extent| extent == 0 || extent as i64 > MAX_EXTENT) {
            return Err(Error::format(format!("a kernel of {} by {} is out of range", kernel[0], kernel[1])));
        }
        let padding = match call.attr().text("padding") {
            Some("SAME") => Padding::Same,
            Some("VALID") => Padding::Fixed([[0; 2]; 2]),
            Some("EXPLICIT") => {
                let list = call.attr().ints("explicit_paddings");
                let at = |index: usize| {
                    let pad = list.get(index).and_then(|&pad| usize::try_from(pad).ok());
                    let pad = pad.filter(|&pad| pad as i64 <= MAX_EXTENT);
                    pad.ok_or_else(|| {
                        Error::format(format!("the explicit paddings {list:?} are out of range"))
                    })
                };
                let around = |axis: usize| Ok::<_, Error>([at(2 * axis)?, at(2 * axis + 1)?]);
                Padding::Fixed([around(axes.height)?, around(axes.width)?])
            }
            other => return Err(Error::unsupported(format!("unsupported padding {other:?}"))),
        };
        let strides = axes.pair(call.attr().ints("strides"))?;
        let dilations = axes.pair(call.attr().ints("dilations"))?;
        Ok(Self { kernel, strides, dilations, padding })
    }

    /// Reads the parameters of a node with the kernel in the parameter `ksize`, like [`Window::of`].
    ///
    /// # Errors
    /// Those of [`Window::of`].
    pub fn of_pool(call: &Call, axes: Axes) -> Result<Self> {
        let kernel = axes.pair(call.attr().ints("ksize"))?;
        let window = Self::of(call, axes, kernel)?;
        Ok(Self { dilations: [1, 1], ..window })
    }

    /// Returns the extent of the dilated kernel.
    fn reach(&self, axis: usize) -> usize {
        (self.kernel[axis] - 1) * self.dilations[axis] + 1
    }

    /// Returns the output height and width for an image.
    ///
    /// # Errors
    /// `Format` when the image is smaller than the window.
    pub fn output(&self, input: Pair<Dim>) -> Result<Pair<Dim>> {
        let output = |axis: usize| {
            let Some(dim) = input[axis] else { return Ok(None) };
            let stride = self.strides[axis];
            let padded = match &self.padding {
                Padding::Same => return Ok(Some(dim.div_ceil(stride))),
                Padding::Fixed(pads) => dim.saturating_add(pads[axis][0] + pads[axis][1]),
            };
            match padded.checked_sub(self.reach(axis)) {
                Some(room) => Ok(Some(room / stride + 1)),
                None => Err(Error::format(format!(
                    "a window of {} does not fit into {padded} pixels",
                    self.reach(axis)
                ))),
            }
        };
        Ok([output(0)?, output(1)?])
    }

    /// Returns the padding before and after one axis; `None` when it depends on an open dimension.
    fn pads(&self, axis: usize, input: Dim) -> Option<Pair<usize>> {
        if let Padding::Fixed(pads) = &self.padding {
            return Some(pads[axis]);
        }
        let (reach, stride) = (self.reach(axis), self.strides[axis]);
        let total = match input {
            // With stride 1 the padding does not depend on the size.
            _ if stride == 1 => reach - 1,
            Some(dim) => ((dim.div_ceil(stride).max(1) - 1) * stride + reach).saturating_sub(dim),
            None => return None,
        };
        Some([total / 2, total - total / 2])
    }

    /// Adds kernel, strides, dilations and padding to a convolution or pooling over an image of size `input`.
    ///
    /// # Errors
    /// `Unsupported` for dilation with strides on open dimensions, for which ONNX Runtime has no padding mode.
    pub fn onto(&self, operator: Operator, input: Pair<Dim>) -> Result<Operator> {
        let list = |pair: Pair<usize>| pair.map(|value| value as i64);
        let mut operator =
            operator.ints("kernel_shape", list(self.kernel)).ints("strides", list(self.strides));
        if self.dilations != [1, 1] {
            operator = operator.ints("dilations", list(self.dilations));
        }
        match (self.pads(0, input[0]), self.pads(1, input[1])) {
            (Some([0, 0]), Some([0, 0])) => Ok(operator),
            (Some([top, bottom]), Some([left, right])) => {
                Ok(operator.ints("pads", [top, left, bottom, right].map(|pad| pad as i64)))
            }
            _ if self.dilations != [1, 1] => Err(Error::unsupported(
                "dilation with stride on an image of open size is not supported; set image_size in the options",
            )),
            _ => Ok(operator.text("auto_pad", "SAME_UPPER")),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn window(kernel: usize, stride: usize, dilation: usize) -> Window {
        Window { kernel: [kernel; 2], strides: [stride; 2], dilations: [dilation; 2], padding: Padding::Same }
    }

    #[test]
    fn same_padding_puts_the_odd_pixel_behind() {
        assert_eq!(window(3, 2, 1).pads(0, Some(224)), Some([0, 1]));
        assert_eq!(window(3, 2, 1).pads(0, Some(225)), Some([1, 1]));
        assert_eq!(window(5, 1, 2).pads(0, None), Some([4, 4]));
        assert_eq!(window(1, 2, 1).pads(0, Some(7)), Some([0, 0]));
        assert_eq!(window(3, 2, 1).pads(0, None), None);
        assert_eq!(window(3, 2, 1).output([Some(225), None]).unwrap(), [Some(113), None]);
    }

    #[test]
    fn valid_padding_needs_room() {
        let window = Window { padding: Padding::Fixed([[0; 2]; 2]), ..window(3, 2, 1) };
        assert_eq!(window.output([Some(7), Some(8)]).unwrap(), [Some(3), Some(3)]);
        assert!(window.output([Some(2), Some(8)]).is_err());
    }
}
