//! Recurrent layers.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{Compute, Convolution, Filters, Finish, LayerCost, Strides, Window};
use opendr_onnx::proto::NodeProto;

use super::inputs::{optional, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

pub(crate) fn lstm(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    if node.int_or("input_forget", 0) != 0 || optional(inputs, 7).is_some() {
        return Err(node.refused("coupled gates or peepholes"));
    }
    build(planner, node, inputs, 4)
}

pub(crate) fn gru(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    build(planner, node, inputs, 3)
}

fn build(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
    gates: usize,
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let standard = ["activations", "activation_alpha", "activation_beta", "clip"];
    if standard.iter().any(|key| node.find(key).is_some())
        || node.int_or("layout", 0) != 0
        || optional(inputs, 4).is_some()
    {
        return Err(node.refused("its activations, layout or lengths"));
    }
    let reversed = match node.text("direction", "forward").as_str() {
        "forward" => vec![false],
        "reverse" => vec![true],
        _ => vec![false, true],
    };
    let weights = |slot: usize| {
        let constant = planner.known(node, required(node, inputs, slot)?)?;
        if constant.floats().is_none() {
            return Err(node.refused("weights that are not floats"));
        }
        Ok(constant)
    };
    let (w, r) = (weights(1)?, weights(2)?);
    let b = if optional(inputs, 3).is_some() { Some(weights(3)?) } else { None };
    let (&[steps, batch, features], &[directions, rows, _], &[_, _, hidden]) =
        (planner.shape(x).as_slice(), w.shape.as_slice(), r.shape.as_slice())
    else {
        return Err(node.damaged("its shapes"));
    };
    let fits = directions == reversed.len()
        && hidden > 0
        && rows == gates * hidden
        && w.shape == [directions, rows, features]
        && r.shape == [directions, rows, hidden]
        && b.as_ref().is_none_or(|b| b.shape == [directions, 2 * rows])
        && features > 0
        && planner.kind(x) == Kind::F32;
    if !fits {
        return Err(node.damaged(&format!("weights {:?} and {:?}", w.shape, r.shape)));
    }
    let (Some(w), Some(r)) = (w.floats(), r.floats()) else { return Err(node.damaged("its weights")) };
    let b = b.as_ref().and_then(|b| b.floats());
    let before = node.int_or("linear_before_reset", 0) != 0;
    let mut cells = Vec::new();
    for (direction, &is_reversed) in reversed.iter().enumerate() {
        let part = |all: &'_ [f32], length: usize| all[direction * length..(direction + 1) * length].to_vec();
        let bias = b.map_or_else(|| vec![0.0; 2 * rows], |b| part(b, 2 * rows));
        let (input_bias, hidden_bias) = bias.split_at(rows);
        let filters = |weights: &[f32], bias: &[f32], depth: usize| {
            let columns = weights.len() / depth;
            Arc::new(Filters::from_matrix(planner.compute, weights, [depth, columns], true, Some(bias)))
        };
        let w = filters(&part(w, rows * features), input_bias, features);
        let r = part(r, rows * hidden);
        // The last gate of a GRU is computed from the reset state, where the reset comes first.
        let split = if gates == 3 && !before { 2 * hidden } else { rows };
        let last = (split < rows).then(|| filters(&r[split * hidden..], &hidden_bias[split..], hidden));
        let r = filters(&r[..split * hidden], &hidden_bias[..split], hidden);
        cells.push(Cell {
            input: product(w, steps * batch, features),
            hidden: product(r, batch, hidden),
            last: last.map(|last| product(last, batch, hidden)),
            is_reversed,
        });
    }
    let state_shape = vec![directions, batch, hidden];
    let initial = |planner: &mut Planner<'_>, slot: usize| -> Result<Option<Id>> {
        let Some(id) = optional(inputs, slot) else { return Ok(None) };
        if planner.shape(id) != state_shape || planner.kind(id) != Kind::F32 {
            return Err(node.damaged("its initial state"));
        }
        Ok(Some(planner.plain(id)?))
    };
    let (h, c) = (initial(planner, 5)?, if gates == 4 { initial(planner, 6)? } else { None });
    let all = vec![steps, directions, batch, hidden];
    let output = count(&all)?;
    // One output has sequence, last state and cells; the others are views of it.
    let state = count(&state_shape)?;
    let lines = |elements: usize| elements.next_multiple_of(16);
    let step =
        RecurrentStep { cells, gates, before, steps, batch, hidden, parts: [lines(output), lines(state)] };
    let whole = lines(output) + 2 * lines(state);
    let y = planner.emit(step, &[Some(x), h, c], &[(Kind::F32, vec![whole], Layout::Plain)])?;
    let y = y.first().copied().ok_or_else(|| node.damaged("its outputs"))?;
    let mut outputs = vec![planner.view(y, 0, all, Layout::Plain)];
    outputs.push(planner.view(y, 4 * lines(output), state_shape.clone(), Layout::Plain));
    if gates == 4 {
        outputs.push(planner.view(y, 4 * (lines(output) + lines(state)), state_shape, Layout::Plain));
    }
    outputs
        .into_iter()
        .map(|output| output.ok_or_else(|| node.refused("inputs that are all constant")))
        .collect()
}

fn product(filters: Arc<Filters>, rows: usize, depth: usize) -> Convolution {
    let input = [1, rows];
    let y = Strides::channels_last(input, filters.outputs());
    Convolution {
        filters,
        window: Window {
            kernel: [1, 1],
            strides: [1, 1],
            dilations: [1, 1],
            pads: [0, 0],
            input,
            output: input,
        },
        batch: 1,
        x: Strides::channels_last(input, depth),
        y,
        residual: y,
        finish: Finish::default(),
    }
}

struct Cell {
    input: Convolution,
    hidden: Convolution,
    last: Option<Convolution>,
    is_reversed: bool,
}

struct RecurrentStep {
    cells: Vec<Cell>,
    gates: usize,
    before: bool,
    steps: usize,
    batch: usize,
    hidden: usize,
    /// Elements of the sequence and of a state, rounded up to lines.
    parts: [usize; 2],
}

impl Kernel for RecurrentStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        let (h0, c0) = (io.read::<f32>(1), io.read::<f32>(2));
        let whole = io.write::<f32>();
        let (sequence, states) = whole.split_at_mut(self.parts[0]);
        let (last_h, last_c) = states.split_at_mut(self.parts[1]);
        let size = self.batch * self.hidden;
        let rows = self.gates * self.hidden;
        let directions = self.cells.len();
        let mut projected = vec![0.0; self.steps * self.batch * rows];
        let mut gates = vec![0.0; self.batch * rows];
        let mut reset = vec![0.0; size];
        for (direction, cell) in self.cells.iter().enumerate() {
            cell.input.run(io.compute, x, None, &mut projected);
            let part = direction * size..(direction + 1) * size;
            let (h, c) = (&mut last_h[part.clone()], &mut last_c[part.clone()]);
            match h0.get(part.clone()) {
                Some(initial) => h.copy_from_slice(initial),
                None => h.fill(0.0),
            }
            match c0.get(part) {
                Some(initial) => c.copy_from_slice(initial),
                None => c.fill(0.0),
            }
            for step in 0..self.steps {
                let step = if cell.is_reversed { self.steps - 1 - step } else { step };
                let input = &projected[step * self.batch * rows..][..self.batch * rows];
                if self.gates == 4 {
                    cell.hidden.run(io.compute, h, None, &mut gates);
                    self.lstm_step(io.compute, input, &mut gates, h, c);
                } else {
                    self.gru_step(io.compute, cell, input, &mut gates, &mut reset, h);
                }
                sequence[(step * directions + direction) * size..][..size].copy_from_slice(h);
            }
        }
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        let per_step = |product: &Convolution| product.cost() * self.steps;
        self.cells.iter().fold(LayerCost::default(), |sum, cell| {
            let last = cell.last.as_ref().map(per_step).unwrap_or_default();
            sum + cell.input.cost() + per_step(&cell.hidden) + last
        })
    }
}

impl RecurrentStep {
    /// Gates in the order input, output, forget, cell.
    fn lstm_step(&self, compute: &Compute, input: &[f32], gates: &mut [f32], h: &mut [f32], c: &mut [f32]) {
        let (n, isa) = (self.hidden, compute.isa());
        gates.iter_mut().zip(input).for_each(|(gate, input)| *gate += input);
        for ((gates, h), c) in gates.chunks_mut(4 * n).zip(h.chunks_mut(n)).zip(c.chunks_mut(n)) {
            opendr_kernels::sigmoid_in_place(isa, &mut gates[..3 * n]);
            opendr_kernels::tanh_in_place(isa, &mut gates[3 * n..]);
            for i in 0..n {
                c[i] = gates[2 * n + i] * c[i] + gates[i] * gates[3 * n + i];
                h[i] = c[i];
            }
            opendr_kernels::tanh_in_place(isa, h);
            for i in 0..n {
                h[i] *= gates[n + i];
            }
        }
    }

    /// Gates in the order update, reset, hidden.
    fn gru_step(
        &self,
        compute: &Compute,
        cell: &Cell,
        input: &[f32],
        gates: &mut [f32],
        reset: &mut [f32],
        h: &mut [f32],
    ) {
        let (n, isa) = (self.hidden, compute.isa());
        let width = if self.before { 3 * n } else { 2 * n };
        let product = &mut gates[..self.batch * width];
        cell.hidden.run(compute, h, None, product);
        for (gates, input) in product.chunks_mut(width).zip(input.chunks(3 * n)) {
            gates[..2 * n].iter_mut().zip(input).for_each(|(gate, input)| *gate += input);
            opendr_kernels::sigmoid_in_place(isa, &mut gates[..2 * n]);
        }
        let mut candidates = vec![0.0; self.batch * n];
        if let Some(last) = &cell.last {
            for ((reset, gates), h) in reset.chunks_mut(n).zip(product.chunks(width)).zip(h.chunks(n)) {
                (0..n).for_each(|i| reset[i] = gates[n + i] * h[i]);
            }
            last.run(compute, reset, None, &mut candidates);
        } else {
            for (candidate, gates) in candidates.chunks_mut(n).zip(product.chunks(width)) {
                (0..n).for_each(|i| candidate[i] = gates[n + i] * gates[2 * n + i]);
            }
        }
        for (candidate, input) in candidates.chunks_mut(n).zip(input.chunks(3 * n)) {
            candidate.iter_mut().zip(&input[2 * n..]).for_each(|(candidate, input)| *candidate += input);
        }
        opendr_kernels::tanh_in_place(isa, &mut candidates);
        for ((h, gates), candidate) in h.chunks_mut(n).zip(product.chunks(width)).zip(candidates.chunks(n)) {
            (0..n).for_each(|i| h[i] = (1.0 - gates[i]) * candidate[i] + gates[i] * h[i]);
        }
    }
}
