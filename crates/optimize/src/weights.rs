//! Weights as bytes, with a scale per output channel, symmetric around zero.

use opendr_onnx::Array;
use opendr_onnx::proto::{DataType, TensorProto};

use crate::range::decibels;

/// Quantised weights; `weight = byte * scale` of its channel.
pub struct ByteWeights {
    bytes: Vec<i8>,
    dims: Vec<i64>,
    axis: usize,
    pub scales: Vec<f32>,
    /// Signal-to-noise ratio, in decibels.
    pub signal_to_noise: f64,
}

impl ByteWeights {
    /// Quantises `weights` to `bits` bits, with channels along `axis`. `least_scale` returns the minimum scale of a
    /// channel.
    pub fn new(weights: &Array, axis: usize, bits: u32, least_scale: impl Fn(usize) -> f32) -> Option<Self> {
        let (floats, dims) = (weights.as_floats()?, weights.dims());
        let channels = *dims.get(axis)?;
        let inner: usize = dims.get(axis + 1..)?.iter().product();
        let channel = |at: usize| at / inner.max(1) % channels.max(1);
        let most = f32::from((1_i16 << (bits - 1)) - 1);
        let mut scales = vec![0.0_f32; channels];
        for (at, weight) in floats.iter().enumerate() {
            let scale = scales.get_mut(channel(at))?;
            *scale = scale.max(weight.abs() / most);
        }
        for (at, scale) in scales.iter_mut().enumerate() {
            *scale = scale.max(least_scale(at));
            if !(scale.is_finite() && *scale >= f32::MIN_POSITIVE) {
                *scale = 1.0;
            }
        }
        let (mut signal, mut noise) = (0.0, 0.0);
        let rounded = floats.iter().enumerate().map(|(at, weight)| {
            let scale = scales.get(channel(at)).copied().unwrap_or(1.0);
            let byte = (weight / scale).round_ties_even().clamp(-most, most);
            signal += f64::from(*weight).powi(2);
            noise += f64::from(weight - byte * scale).powi(2);
            byte as i8
        });
        let bytes = rounded.collect();
        let dims = dims.iter().map(|dim| *dim as i64).collect();
        Some(Self { bytes, dims, axis, scales, signal_to_noise: decibels(signal, noise) })
    }

    /// Returns the axis of the channels.
    pub fn axis(&self) -> usize {
        self.axis
    }

    /// Converts the bytes to an initializer.
    pub fn to_tensor(&self, name: &str) -> TensorProto {
        TensorProto {
            name: name.to_owned(),
            dims: self.dims.clone(),
            data_type: DataType::Int8 as i32,
            raw_data: self.bytes.iter().map(|byte| byte.cast_unsigned()).collect(),
            ..TensorProto::default()
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_onnx::Data;

    #[test]
    fn each_channel_has_its_scale() {
        let values = vec![1.0, -0.5, 100.0, 25.0, 0.0, 0.0];
        let by_row = Array::new(vec![3, 2], Data::Float(values.clone())).unwrap();
        let rows = ByteWeights::new(&by_row, 0, 8, |_| 0.0).unwrap();
        assert_eq!(rows.bytes, [127, -64, 127, 32, 0, 0]);
        assert_eq!(rows.scales[2], 1.0);
        assert!((rows.scales[1] - 100.0 / 127.0).abs() < 1e-6);
        let columns = ByteWeights::new(&by_row, 1, 8, |_| 0.0).unwrap();
        assert_eq!(columns.scales.len(), 2);
        assert_eq!(columns.bytes, [1, -3, 127, 127, 0, 0]);
        let seven = ByteWeights::new(&by_row, 0, 7, |_| 0.0).unwrap();
        assert_eq!(seven.bytes[..2], [63, -31]);
        assert!(seven.signal_to_noise < rows.signal_to_noise);
        assert_eq!(ByteWeights::new(&by_row, 0, 8, |_| 10.0).unwrap().bytes[2], 10);
    }
}
