//! Recycling positional encoding.

use std::f32::consts::TAU;

use burn::module::Module;
use burn::nn::{Embedding, EmbeddingConfig};
use burn::tensor::module::embedding;
use burn::tensor::{Device, Int, Tensor, TensorData};

/// Encodings of positions that recur: learnt ones, or sines and cosines.
#[derive(Module, Debug)]
pub(super) struct Positions {
    learnt: Option<Embedding>,
    #[module(skip)]
    waves: Vec<f32>,
    #[module(skip)]
    shape: [usize; 2],
}

impl Positions {
    /// Returns encodings of `[positions, features]`.
    pub fn new(shape: [usize; 2], learnt: bool, device: &Device) -> Self {
        let [positions, features] = shape;
        Self {
            learnt: learnt.then(|| EmbeddingConfig::new(positions, features).init(device)),
            waves: if learnt { Vec::new() } else { waves(shape) },
            shape,
        }
    }

    /// Returns the encodings `[batch, tokens, features]` of positions `[batch, tokens]`.
    pub fn forward(&self, positions: Tensor<2, Int>) -> Tensor<3> {
        match &self.learnt {
            Some(learnt) => learnt.forward(positions),
            None => {
                let waves = TensorData::new(self.waves.clone(), self.shape);
                let waves = Tensor::<2>::from_data(waves, &positions.device());
                embedding(waves, positions)
            }
        }
    }

    /// Returns the positions `[batch, tokens]` of sequences whose first tokens have the positions `first`, `[batch, 1]`.
    pub fn of_sequences(&self, first: Tensor<2, Int>, tokens: usize) -> Tensor<2, Int> {
        let [batch, _] = first.dims();
        let steps: Tensor<2, Int> = Tensor::arange(0..tokens as i64, &first.device()).unsqueeze();
        let positions = first.expand([batch, tokens]) + steps.expand([batch, tokens]);
        positions.remainder_scalar(self.shape[0] as i64)
    }
}

/// Returns sines and cosines of wavelengths in a geometric series, as those of Vaswani et al. (Attention is all you need,
/// 2017), but each with a whole number of periods in all positions, so that the last position is followed by the first.
fn waves([positions, features]: [usize; 2]) -> Vec<f32> {
    let (most, pairs) = ((positions / 2) as f32, features.div_ceil(2));
    let periods = |pair: usize| most.powf(pair as f32 / (pairs.max(2) - 1) as f32).round();
    let wave = |position: usize, feature: usize| {
        let angle = TAU * (periods(feature / 2) * position as f32 / positions as f32);
        if feature.is_multiple_of(2) { angle.sin() } else { angle.cos() }
    };
    (0..positions).flat_map(|position| (0..features).map(move |feature| wave(position, feature))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn positions_recur_and_are_distinct() {
        let device = Device::flex();
        for learnt in [false, true] {
            let positions = Positions::new([9, 6], learnt, &device);
            let first = Tensor::<2, Int>::from_data([[7], [16]], &device);
            let order = positions.of_sequences(first, 5);
            let wanted = TensorData::from([[7, 8, 0, 1, 2], [7, 8, 0, 1, 2]]);
            assert_eq!(order.clone().into_data().convert::<i64>(), wanted.convert::<i64>());
            let all = Tensor::<1, Int>::arange(0..9, &device).unsqueeze::<2>();
            let rows: Vec<f32> = positions.forward(all).into_data().try_to_vec().unwrap();
            let rows: Vec<&[f32]> = rows.chunks(6).collect();
            for (at, row) in rows.iter().enumerate() {
                for other in &rows[..at] {
                    assert!(row.iter().zip(*other).any(|(a, b)| (a - b).abs() > 0.1), "{row:?} {other:?}");
                }
            }
        }
    }

    #[test]
    fn the_last_position_is_followed_by_the_first() {
        let rows = waves([127, 8]);
        let distance = |a: usize, b: usize| {
            rows[8 * a..][..8].iter().zip(&rows[8 * b..][..8]).map(|(a, b)| (a - b).powi(2)).sum::<f32>()
        };
        let steps: Vec<f32> = (0..127).map(|at| distance(at, (at + 1) % 127)).collect();
        assert!(steps.iter().all(|step| (step - steps[0]).abs() < 1e-3), "{steps:?}");
    }
}
