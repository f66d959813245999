//! Reversal of the first steps of each sequence.

use opendr_engine::{Error, Result};
use opendr_onnx::proto::NodeProto;

use super::index::{indices, read_index};
use super::inputs::required;
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::by_size;
use crate::tensor::Kind;

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let (lengths, lengths_kind) = indices(planner, node, required(node, inputs, 1)?)?;
    let (dims, kind) = (planner.shape(x), planner.kind(x));
    let is_time_first = match (node.int_or("time_axis", 0), node.int_or("batch_axis", 1)) {
        (0, 1) => true,
        (1, 0) => false,
        _ => return Err(node.damaged("its axes")),
    };
    let &[first, second, ..] = dims.as_slice() else { return Err(node.damaged("two dimensions")) };
    let batch = if is_time_first { second } else { first };
    if planner.shape(lengths) != [batch] {
        return Err(node.damaged("one length per sequence"));
    }
    let step = ReverseStep {
        size: kind.bytes(),
        dims: [first, second],
        inner: dims[2..].iter().product(),
        is_time_first,
        lengths_kind,
    };
    Ok(vec![planner.emit_one(step, &[x, lengths], kind, dims, Layout::Plain)?])
}

struct ReverseStep {
    size: usize,
    dims: [usize; 2],
    inner: usize,
    is_time_first: bool,
    lengths_kind: Kind,
}

impl Kernel for ReverseStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let [first, second] = self.dims;
        let steps = if self.is_time_first { first } else { second };
        by_size!(self.size, T => {
            let (x, y) = (io.read::<T>(0), io.write::<T>());
            for (row, y) in y.chunks_mut(self.inner.max(1)).enumerate() {
                let (outer, inner) = (row / second, row % second);
                let (step, sequence) = if self.is_time_first { (outer, inner) } else { (inner, outer) };
                let length = read_index(io, 1, self.lengths_kind, sequence);
                let length = usize::try_from(length).ok().filter(|&length| length <= steps).ok_or_else(|| {
                    Error::invalid_input(format!("the ONNX model reverses {length} of {steps} steps"))
                })?;
                let from = if step < length { length - 1 - step } else { step };
                let row = if self.is_time_first { from * second + inner } else { outer * second + from };
                y.copy_from_slice(&x[row * self.inner..][..self.inner]);
            }
        });
        Ok(())
    }
}
