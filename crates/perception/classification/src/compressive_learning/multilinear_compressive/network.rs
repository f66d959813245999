//! The trained network.

use std::f64::consts::PI;

use burn::module::{Module, Param};
use burn::tensor::{Device, Tensor, TensorData};
use opendr_perception_common::small_classifier::SmallClassifier;

/// Network from images `[batch, 3, height, width]` through a measurement to scores `[batch, classes]`.
#[derive(Module, Debug)]
pub struct MultilinearCompressiveNetwork {
    sensing: Multilinear,
    synthesis: Multilinear,
    classifier: SmallClassifier,
}

/// Multiplication of channels, rows and columns by a matrix each.
#[derive(Module, Debug)]
struct Multilinear {
    channels: Param<Tensor<2>>,
    rows: Param<Tensor<2>>,
    columns: Param<Tensor<2>>,
}

impl MultilinearCompressiveNetwork {
    /// Returns a network with initial weights; `pictures` and `measured` are the shapes `[channels, height, width]` of images
    /// and measurements.
    pub fn new(
        pictures: [usize; 3],
        measured: [usize; 3],
        classes: usize,
        (width, dropout): (usize, f64),
        device: &Device,
    ) -> Self {
        Self {
            sensing: Multilinear::new(pictures, measured, device),
            synthesis: Multilinear::new(measured, pictures, device),
            classifier: SmallClassifier::new(3, classes, width, dropout, device),
        }
    }

    /// Returns the measurements `[batch, channels, height, width]` of images.
    pub fn measure(&self, pictures: Tensor<4>) -> Tensor<4> {
        self.sensing.forward(pictures)
    }

    /// Returns scores `[batch, classes]` of measurements.
    pub fn classify(&self, measurements: Tensor<4>) -> Tensor<2> {
        self.classifier.forward(self.synthesis.forward(measurements))
    }
}

impl Multilinear {
    fn new([from_c, from_h, from_w]: [usize; 3], [to_c, to_h, to_w]: [usize; 3], device: &Device) -> Self {
        let matrix = |to, from| {
            Param::from_tensor(Tensor::from_data(TensorData::new(cosines(to, from), [to, from]), device))
        };
        Self { channels: matrix(to_c, from_c), rows: matrix(to_h, from_h), columns: matrix(to_w, from_w) }
    }

    fn forward(&self, input: Tensor<4>) -> Tensor<4> {
        let columns = self.columns.val().swap_dims(0, 1).unsqueeze::<4>();
        let rows = self.rows.val().unsqueeze::<4>();
        let signal = rows.matmul(input.matmul(columns));
        let [batch, channels, height, width] = signal.dims();
        let [mixed, _] = self.channels.val().dims();
        let signal = signal.reshape([batch, channels, height * width]);
        let signal = self.channels.val().unsqueeze::<3>().matmul(signal);
        signal.reshape([batch, mixed, height, width])
    }
}

/// Returns the lowest frequencies of a cosine transform, orthonormal, `[to, from]`; its inverse for `to` above `from`.
fn cosines(to: usize, from: usize) -> Vec<f32> {
    let long = to.max(from) as f64;
    let cosine = |frequency: usize, place: usize| {
        let size = if frequency == 0 { 1.0 } else { 2.0 };
        (size / long).sqrt() * (PI * frequency as f64 * (2 * place + 1) as f64 / (2.0 * long)).cos()
    };
    let entry = |index: usize| {
        let (row, column) = (index / from, index % from);
        (if to <= from { cosine(row, column) } else { cosine(column, row) }) as f32
    };
    (0..to * from).map(entry).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn synthesis_inverts_a_complete_measurement() {
        let product = |a: &[f32], b: &[f32], size: usize, inner: usize| -> Vec<f32> {
            let entry = |index: usize| {
                let (row, column) = (index / size, index % size);
                (0..inner).map(|at| a[row * inner + at] * b[at * size + column]).sum()
            };
            (0..size * size).map(entry).collect()
        };
        let identity = product(&cosines(5, 9), &cosines(9, 5), 5, 9);
        for (index, value) in identity.iter().enumerate() {
            let wanted = if index / 5 == index % 5 { 1.0 } else { 0.0 };
            assert!((value - wanted).abs() < 1e-5, "{identity:?}");
        }
    }
}
