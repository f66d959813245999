//! Gated recurrent unit.

use burn::config::Config;
use burn::module::{Initializer, Module, Param};
use burn::tensor::activation::{sigmoid, tanh};
use burn::tensor::{Device, Tensor};

use crate::export::record_gru;
use crate::operations::gru;

/// Configuration of a [`Gru`].
#[derive(Config, Debug)]
pub struct GruConfig {
    /// Number of input features.
    pub input_size: usize,
    /// Number of features of the state.
    pub hidden_size: usize,
}

/// One layer of gated recurrent units with a zero initial state (Cho et al., 2014), equal to PyTorch's `nn.GRU` with
/// `batch_first=True`:
///
/// ```text
/// r = σ(W_ir x + b_ir + W_hr h + b_hr)
/// z = σ(W_iz x + b_iz + W_hz h + b_hz)
/// n = tanh(W_in x + b_in + r (W_hn h + b_hn))
/// h' = (1 - z) n + z h
/// ```
///
/// It is exported as ONNX's `GRU` with `linear_before_reset`. Parameters have PyTorch's names and shapes.
#[derive(Module, Debug)]
pub struct Gru {
    /// `[3 hidden, input]`: `W_ir`, `W_iz`, `W_in`.
    pub weight_ih_l0: Param<Tensor<2>>,
    /// `[3 hidden, hidden]`: `W_hr`, `W_hz`, `W_hn`.
    pub weight_hh_l0: Param<Tensor<2>>,
    /// `[3 hidden]`: `b_ir`, `b_iz`, `b_in`.
    pub bias_ih_l0: Param<Tensor<1>>,
    /// `[3 hidden]`: `b_hr`, `b_hz`, `b_hn`.
    pub bias_hh_l0: Param<Tensor<1>>,
}

impl GruConfig {
    /// Initialises weights and biases uniformly within `1 / √hidden`, as PyTorch does.
    pub fn init(&self, device: &Device) -> Gru {
        let bound = 1.0 / (self.hidden_size as f64).sqrt();
        let initializer = Initializer::Uniform { min: -bound, max: bound };
        let gates = 3 * self.hidden_size;
        Gru {
            weight_ih_l0: initializer.init([gates, self.input_size], device),
            weight_hh_l0: initializer.init([gates, self.hidden_size], device),
            bias_ih_l0: initializer.init([gates], device),
            bias_hh_l0: initializer.init([gates], device),
        }
    }
}

impl Gru {
    /// Returns the states of all steps, `[batch, time, hidden]`, for input `[batch, time, features]`.
    pub fn forward(&self, input: Tensor<3>) -> Tensor<3> {
        let (weight, recurrence) = (self.weight_ih_l0.val(), self.weight_hh_l0.val());
        let (bias, recurrence_bias) = (self.bias_ih_l0.val(), self.bias_hh_l0.val());
        if let Some(states) = record_gru(&input, [&weight, &recurrence], [&bias, &recurrence_bias]) {
            return states;
        }
        if let Some(states) = gru(&input, [&weight, &recurrence], [&bias, &recurrence_bias]) {
            return states;
        }
        let [batch, time, features] = input.dims();
        let [gates, hidden] = recurrence.dims();
        // Terms that do not depend on the state, for all steps at once.
        let projected = input.reshape([batch * time, features]).matmul(weight.transpose()) + bias.unsqueeze();
        let projected = projected.reshape([batch, time, gates]);
        let recurrence = recurrence.transpose();
        let recurrence_bias = recurrence_bias.unsqueeze::<2>();
        let mut state = Tensor::<2>::zeros([batch, hidden], &projected.device());
        let mut states = Vec::with_capacity(time);
        for step in 0..time {
            let input = projected.clone().narrow(1, step, 1).reshape([batch, gates]);
            let recurrent = state.clone().matmul(recurrence.clone()) + recurrence_bias.clone();
            let gate = |of: &Tensor<2>, index: usize| of.clone().narrow(1, index * hidden, hidden);
            let reset = sigmoid(gate(&input, 0) + gate(&recurrent, 0));
            let update = sigmoid(gate(&input, 1) + gate(&recurrent, 1));
            let new = tanh(gate(&input, 2) + reset * gate(&recurrent, 2));
            state = new.clone() + update * (state - new);
            states.push(state.clone());
        }
        Tensor::stack(states, 1)
    }

    /// Returns the state after the last step, `[batch, hidden]`.
    pub fn last(&self, input: Tensor<3>) -> Tensor<2> {
        let states = self.forward(input);
        let [batch, time, hidden] = states.dims();
        states.narrow(1, time - 1, 1).reshape([batch, hidden])
    }
}
