//! Gated recurrent units.

use std::sync::{Arc, Mutex, PoisonError};

use burn::backend::Flex;
use burn::backend::autodiff::checkpoint::base::Checkpointer;
use burn::backend::autodiff::checkpoint::strategy::NoCheckpointing;
use burn::backend::autodiff::grads::Gradients;
use burn::backend::autodiff::ops::{Backward, Ops, OpsKind};
use burn::tensor::{DType, Tensor};
use opendr_kernels::{Gru, GruTape};

use super::{Cpu, Trained, compute, numbers, register, shape, tensor};

/// Returns the states of all steps, `[batch, time, hidden]`, of an input `[batch, time, features]` that is trained on the CPU, from a zero
/// state; `None` for others. Weights are `[3 hidden, features]` and `[3 hidden, hidden]`, in the order of PyTorch's gates.
pub(crate) fn gru(input: &Tensor<3>, weights: [&Tensor<2>; 2], biases: [&Tensor<1>; 2]) -> Option<Tensor<3>> {
    let x = input.clone().try_into_primitive::<Trained>().ok().filter(|_| input.dtype() == DType::F32)?;
    let [w, u] = weights.map(|weight| weight.clone().try_into_primitive::<Trained>());
    let [c, d] = biases.map(|bias| bias.clone().try_into_primitive::<Trained>());
    let (w, u, c, d) = (w.ok()?, u.ok()?, c.ok()?, d.ok()?);
    let [batch, time, features] = input.dims();
    let unit = Gru::new(features, weights[1].dims()[1]).ok().filter(|_| batch * time > 0)?;
    let mut parameters = Vec::with_capacity(unit.parameters());
    for weight in [&w, &u] {
        parameters.extend_from_slice(numbers(&weight.primitive().transpose(0, 1).to_contiguous()));
    }
    for bias in [&c, &d] {
        parameters.extend_from_slice(numbers(&bias.primitive().to_contiguous()));
    }
    let sequence = Sequence { unit, batch, time, parameters, x: steps_first(x.primitive()) };
    let tape = sequence.forward();
    let states = batch_first(tensor(tape.states().to_vec(), [time, batch, unit.size()]));
    let nodes = [x.node(), w.node(), u.node(), c.node(), d.node()];
    let states = match Recurrent.prepare::<NoCheckpointing>(nodes).compute_bound().stateful() {
        OpsKind::Tracked(prepared) => {
            prepared.finish(Arc::new(State { sequence, tape: Mutex::new(Some(tape)) }), states)
        }
        OpsKind::UnTracked(prepared) => prepared.finish(states),
    };
    Some(Tensor::from_primitive::<Trained>(states))
}

/// Returns `[time, batch, ...]` of `[batch, time, ...]`.
fn steps_first(tensor: &Cpu) -> Cpu {
    tensor.transpose(0, 1).to_contiguous()
}

/// Returns a view `[batch, time, ...]` of `[time, batch, ...]`.
fn batch_first(tensor: Cpu) -> Cpu {
    tensor.transpose(0, 1)
}

/// A sequence and the parameters of the unit.
#[derive(Debug)]
struct Sequence {
    unit: Gru,
    batch: usize,
    time: usize,
    parameters: Vec<f32>,
    x: Cpu,
}

impl Sequence {
    fn forward(&self) -> GruTape {
        let mut tape = GruTape::default();
        let state = vec![0.0; self.batch * self.unit.size()];
        self.unit.forward(compute(), &self.parameters, numbers(&self.x), &state, &self.starts(), &mut tape);
        tape
    }

    /// No step starts an episode.
    fn starts(&self) -> Vec<bool> {
        vec![false; self.batch * self.time]
    }
}

#[derive(Debug)]
struct State {
    sequence: Sequence,
    /// The values of the forward pass, which the first backward pass takes.
    tape: Mutex<Option<GruTape>>,
}

#[derive(Debug)]
struct Recurrent;

impl Backward<Flex, 5> for Recurrent {
    type State = Arc<State>;

    fn backward(self, ops: Ops<Arc<State>, 5>, gradients: &mut Gradients, _: &mut Checkpointer) {
        let dy = steps_first(&gradients.consume::<Flex>(&ops.node));
        let State { sequence, tape } = &*ops.state;
        let tape = tape.lock().unwrap_or_else(PoisonError::into_inner).take();
        let mut tape = tape.unwrap_or_else(|| sequence.forward());
        let unit = sequence.unit;
        let (features, hidden) = (unit.inputs(), unit.size());
        let mut flat = vec![0.0; unit.parameters()];
        let mut dx = ops.parents[0].is_some().then(|| vec![0.0; sequence.batch * sequence.time * features]);
        unit.backward(
            compute(),
            &sequence.parameters,
            &sequence.starts(),
            numbers(&dy),
            &mut tape,
            &mut flat,
            dx.as_deref_mut(),
            None,
        );
        let (w, rest) = flat.split_at(3 * hidden * features);
        let (u, biases) = rest.split_at(3 * hidden * hidden);
        let (c, d) = biases.split_at(3 * hidden);
        let weight =
            |all: &[f32], rows| tensor(all.to_vec(), [rows, 3 * hidden]).transpose(0, 1).to_contiguous();
        let bias = |all: &[f32]| tensor(all.to_vec(), [3 * hidden]);
        let all = [
            dx.map(|dx| batch_first(tensor(dx, shape(&sequence.x)))),
            Some(weight(w, features)),
            Some(weight(u, hidden)),
            Some(bias(c)),
            Some(bias(d)),
        ];
        register(gradients, ops.parents.map(|node| node.map(|node| node.id)), all);
    }
}
