use opendr_engine::Result;

use super::checked_size;
use crate::{Activation, Bias, Compute, Matrix, MatrixMut, Product, add_column_sums};

/// A gated recurrent unit (Cho et al., 2014) as in PyTorch, with gates r, z and n from input and state:
/// `r = sigmoid(x Wr + cr + h Ur + dr)`, `z` likewise, `n = tanh(x Wn + cn + r (h Un + dn))`, `h' = (1 - z) n + z h`.
///
/// Parameters: W `[inputs, 3 size]`, U `[size, 3 size]`, c `[3 size]`, d `[3 size]`, each with the columns of r, z and n.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Gru {
    inputs: usize,
    size: usize,
}

/// Values of a forward pass over a sequence for the backward pass; the memory is reused.
#[derive(Debug, Clone, Default)]
pub struct GruTape {
    steps: usize,
    batch: usize,
    /// Gates r, z and n of every step and sample.
    gates: Vec<f32>,
    /// h U + d of one step; in the backward pass its gradient, of every step.
    hidden: Vec<f32>,
    /// Columns of n in h U + d.
    candidates: Vec<f32>,
    /// State before every step, zero where an episode starts.
    before: Vec<f32>,
    /// State after every step.
    states: Vec<f32>,
    /// Gradient of the state between two steps.
    carried: Vec<f32>,
    inputs: Vec<f32>,
}

impl Gru {
    /// Creates a unit of these sizes.
    ///
    /// # Errors
    /// When a size is zero or the whole is too large.
    pub fn new(inputs: usize, size: usize) -> Result<Self> {
        checked_size("the inputs of a recurrent unit", &[inputs, size, 3])?;
        checked_size("the state of a recurrent unit", &[size, size, 3])?;
        Ok(Self { inputs, size })
    }

    /// Returns the number of input values per sample and step.
    pub fn inputs(&self) -> usize {
        self.inputs
    }

    /// Returns the size of the state.
    pub fn size(&self) -> usize {
        self.size
    }

    /// Returns the number of parameters: W, U, c and d.
    pub fn parameters(&self) -> usize {
        3 * self.size * (self.inputs + self.size + 2)
    }

    /// Computes a sequence and returns the states after every step, `[steps, batch, size]`; the last ones continue
    /// the sequence in the next call.
    ///
    /// `x` is `[steps, batch, inputs]`, `state` `[batch, size]`, `starts` `[steps, batch]`: where an episode starts,
    /// the state is reset to zero before the step.
    ///
    /// # Panics
    /// When a length does not match.
    pub fn forward<'t>(
        &self,
        compute: &Compute,
        parameters: &[f32],
        x: &[f32],
        state: &[f32],
        starts: &[bool],
        tape: &'t mut GruTape,
    ) -> &'t [f32] {
        let batch = state.len() / self.size;
        let steps = starts.len().checked_div(batch).unwrap_or(0);
        let samples = steps * batch;
        let lengths = [x.len(), state.len(), starts.len()];
        assert_eq!(
            lengths,
            [samples * self.inputs, batch * self.size, samples],
            "the lengths are not those of a sequence for {self:?}"
        );
        let [w, u, c, d] = self.split(parameters);
        tape.prepare(self, steps, batch, x);
        Product::new().bias(Bias::Columns(c)).run(
            compute,
            Matrix::new(x, samples, self.inputs),
            Matrix::new(w, self.inputs, 3 * self.size),
            MatrixMut::new(&mut tape.gates, samples, 3 * self.size),
        );
        for step in 0..steps {
            let rows = step * batch * self.size..(step + 1) * batch * self.size;
            let before = &mut tape.before[rows.clone()];
            match step.checked_sub(1) {
                None => before.copy_from_slice(state),
                Some(last) => {
                    before.copy_from_slice(&tape.states[last * batch * self.size..][..batch * self.size])
                }
            }
            for (before, &starts) in before.chunks_exact_mut(self.size).zip(&starts[step * batch..]) {
                if starts {
                    before.fill(0.0);
                }
            }
            Product::new().bias(Bias::Columns(d)).run(
                compute,
                Matrix::new(before, batch, self.size),
                Matrix::new(u, self.size, 3 * self.size),
                MatrixMut::new(&mut tape.hidden[..3 * batch * self.size], batch, 3 * self.size),
            );
            self.gate(compute, tape, step);
        }
        &tape.states
    }

    /// Computes gates and state of a step from its sums.
    fn gate(&self, compute: &Compute, tape: &mut GruTape, step: usize) {
        let (size, batch) = (self.size, tape.batch);
        let hidden = tape.hidden.chunks_exact(3 * size);
        let gates = tape.gates[3 * step * batch * size..].chunks_exact_mut(3 * size);
        let candidates = tape.candidates[step * batch * size..].chunks_exact_mut(size);
        let before = tape.before[step * batch * size..].chunks_exact(size);
        let states = tape.states[step * batch * size..].chunks_exact_mut(size);
        let rows = gates.zip(hidden).zip(candidates).zip(before).zip(states).take(batch);
        for ((((gates, hidden), candidates), before), state) in rows {
            let (rz, n) = gates.split_at_mut(2 * size);
            for (gate, &hidden) in rz.iter_mut().zip(hidden) {
                *gate += hidden;
            }
            Activation::Sigmoid.apply(compute.isa(), rz);
            let (r, z) = rz.split_at(size);
            candidates.copy_from_slice(&hidden[2 * size..]);
            for ((n, &r), &candidate) in n.iter_mut().zip(r).zip(&*candidates) {
                *n += r * candidate;
            }
            Activation::Tanh.apply(compute.isa(), n);
            for (((state, &z), &n), &before) in state.iter_mut().zip(z).zip(&*n).zip(before) {
                *state = (1.0 - z) * n + z * before;
            }
        }
    }

    /// Computes the backward pass of the last [`Gru::forward`] on this tape, from `dy`, the gradient of all states.
    ///
    /// Adds to `gradients`; writes the gradient of `x` to `dx` and that of the first state to `dstate`, where they
    /// are given. Each call needs a forward pass of its own.
    ///
    /// # Panics
    /// When a length does not match.
    #[expect(clippy::too_many_arguments, reason = "inputs and outputs of a backward pass")]
    pub fn backward(
        &self,
        compute: &Compute,
        parameters: &[f32],
        starts: &[bool],
        dy: &[f32],
        tape: &mut GruTape,
        gradients: &mut [f32],
        dx: Option<&mut [f32]>,
        dstate: Option<&mut [f32]>,
    ) {
        let (size, batch, steps) = (self.size, tape.batch, tape.steps);
        let samples = steps * batch;
        let lengths = [dy.len(), starts.len(), gradients.len()];
        assert_eq!(
            lengths,
            [samples * size, samples, self.parameters()],
            "the lengths are not those of the tape's sequence"
        );
        let [w, u, ..] = self.split(parameters);
        tape.carried.clear();
        tape.carried.resize(batch * size, 0.0);
        for step in (0..steps).rev() {
            self.gate_backward(tape, step, &dy[step * batch * size..][..batch * size]);
            Product::new().beta(1.0).run(
                compute,
                Matrix::new(&tape.hidden[3 * step * batch * size..], batch, 3 * size),
                Matrix::new(u, size, 3 * size).transposed(),
                MatrixMut::new(&mut tape.carried, batch, size),
            );
            for (carried, &starts) in tape.carried.chunks_exact_mut(size).zip(&starts[step * batch..]) {
                if starts {
                    carried.fill(0.0);
                }
            }
        }
        if let Some(dstate) = dstate {
            dstate.copy_from_slice(&tape.carried);
        }
        self.add_gradients(compute, tape, gradients);
        if let Some(dx) = dx {
            Product::new().run(
                compute,
                Matrix::new(&tape.gates, samples, 3 * size),
                Matrix::new(w, self.inputs, 3 * size).transposed(),
                MatrixMut::new(dx, samples, self.inputs),
            );
        }
    }

    /// Replaces the gates of a step by their gradients, of the input's part in `gates` and of the state's part in
    /// `hidden`, and writes the gradient that bypasses the gates to `carried`.
    fn gate_backward(&self, tape: &mut GruTape, step: usize, dy: &[f32]) {
        let (size, batch) = (self.size, tape.batch);
        let gates = tape.gates[3 * step * batch * size..].chunks_exact_mut(3 * size);
        let hidden = tape.hidden[3 * step * batch * size..].chunks_exact_mut(3 * size);
        let candidates = tape.candidates[step * batch * size..].chunks_exact(size);
        let before = tape.before[step * batch * size..].chunks_exact(size);
        let carried = tape.carried.chunks_exact_mut(size).zip(dy.chunks_exact(size));
        let rows = gates.zip(hidden).zip(candidates).zip(before).zip(carried);
        for ((((gates, hidden), candidates), before), (carried, dy)) in rows {
            let (r, zn) = gates.split_at_mut(size);
            let (z, n) = zn.split_at_mut(size);
            let (hidden_r, hidden_zn) = hidden.split_at_mut(size);
            let (hidden_z, hidden_n) = hidden_zn.split_at_mut(size);
            for i in 0..size {
                let dh = dy[i] + carried[i];
                let dn = dh * (1.0 - z[i]) * (1.0 - n[i] * n[i]);
                let dz = dh * (before[i] - n[i]) * z[i] * (1.0 - z[i]);
                let dr = dn * candidates[i] * r[i] * (1.0 - r[i]);
                carried[i] = dh * z[i];
                (hidden_r[i], hidden_z[i], hidden_n[i]) = (dr, dz, dn * r[i]);
                (r[i], z[i], n[i]) = (dr, dz, dn);
            }
        }
    }

    fn add_gradients(&self, compute: &Compute, tape: &GruTape, gradients: &mut [f32]) {
        let samples = tape.steps * tape.batch;
        let (w, rest) = gradients.split_at_mut(3 * self.size * self.inputs);
        let (u, biases) = rest.split_at_mut(3 * self.size * self.size);
        let (c, d) = biases.split_at_mut(3 * self.size);
        let sides = [(&tape.inputs, self.inputs, &tape.gates, w), (&tape.before, self.size, &tape.hidden, u)];
        for (from, rows, gradient, weights) in sides {
            Product::new().beta(1.0).run(
                compute,
                Matrix::new(from, samples, rows).transposed(),
                Matrix::new(gradient, samples, 3 * self.size),
                MatrixMut::new(weights, rows, 3 * self.size),
            );
        }
        add_column_sums(compute.isa(), &tape.gates, c);
        add_column_sums(compute.isa(), &tape.hidden[..3 * samples * self.size], d);
    }

    fn split<'p>(&self, parameters: &'p [f32]) -> [&'p [f32]; 4] {
        assert_eq!(
            parameters.len(),
            self.parameters(),
            "`parameters` must have the length of the layer's parameters"
        );
        let (w, rest) = parameters.split_at(3 * self.size * self.inputs);
        let (u, biases) = rest.split_at(3 * self.size * self.size);
        let (c, d) = biases.split_at(3 * self.size);
        [w, u, c, d]
    }
}

impl GruTape {
    /// Returns the states after every step of the last forward pass, `[steps, batch, size]`.
    pub fn states(&self) -> &[f32] {
        &self.states
    }

    fn prepare(&mut self, gru: &Gru, steps: usize, batch: usize, x: &[f32]) {
        (self.steps, self.batch) = (steps, batch);
        let samples = steps * batch;
        for buffer in [&mut self.gates, &mut self.hidden] {
            buffer.resize(3 * samples * gru.size, 0.0);
        }
        for buffer in [&mut self.candidates, &mut self.before, &mut self.states] {
            buffer.resize(samples * gru.size, 0.0);
        }
        self.inputs.clear();
        self.inputs.extend_from_slice(x);
    }
}
