//! Rotary position embeddings.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::index::{index, indices, read_index};
use super::inputs::{optional, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::Kind;

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let [x, cos, sin] = [0, 1, 2].map(|slot| required(node, inputs, slot));
    let (x, cos, sin) = (planner.plain(x?)?, planner.plain(cos?)?, planner.plain(sin?)?);
    if [x, cos, sin].iter().any(|&id| planner.kind(id) != Kind::F32) {
        return Err(node.refused("elements that are not floats"));
    }
    let dims = planner.shape(x);
    let stated = usize::try_from(node.int_or("num_heads", 0)).unwrap_or(0);
    // Heads come before the steps in four dimensions, and within a step in three.
    let (batch, steps, heads, size) = match dims[..] {
        [batch, heads, steps, size] => (batch, steps, heads, size),
        [batch, steps, hidden] if stated > 0 && hidden % stated == 0 => {
            (batch, steps, stated, hidden / stated)
        }
        _ => return Err(node.damaged(&format!("an input of shape {dims:?}"))),
    };
    let rotated = match usize::try_from(node.int_or("rotary_embedding_dim", 0)) {
        Ok(0) => size,
        Ok(rotated) if rotated <= size => rotated,
        _ => return Err(node.damaged("attribute \"rotary_embedding_dim\"")),
    };
    let half = rotated / 2;
    let (positions, rows) = match optional(inputs, 3) {
        Some(positions) => {
            let (positions, kind) = indices(planner, node, positions)?;
            let &[rows, width] = planner.shape(cos).as_slice() else { return Err(node.damaged("its cache")) };
            if planner.shape(positions) != [batch, steps] || width != half {
                return Err(node.damaged("its positions or its cache"));
            }
            (Some((positions, kind)), rows)
        }
        None if planner.shape(cos) == [batch, steps, half] => (None, 0),
        None => return Err(node.damaged("its cache")),
    };
    if planner.shape(cos) != planner.shape(sin) || rotated % 2 != 0 {
        return Err(node.damaged("its cache"));
    }
    let step = RotaryStep {
        sizes: [heads, steps, size],
        is_head_first: dims.len() == 4,
        half,
        is_interleaved: node.int_or("interleaved", 0) != 0,
        positions: positions.map(|(_, kind)| (kind, rows)),
    };
    let reads = [Some(x), Some(cos), Some(sin), positions.map(|(id, _)| id)];
    planner.emit(step, &reads, &[(Kind::F32, dims, Layout::Plain)])
}

struct RotaryStep {
    /// Heads, steps, and elements of a head.
    sizes: [usize; 3],
    is_head_first: bool,
    /// Pairs of elements that are rotated.
    half: usize,
    is_interleaved: bool,
    /// Type of the positions, and number of rows of the cache.
    positions: Option<(Kind, usize)>,
}

impl Kernel for RotaryStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let (x, cos, sin, y) = (io.read::<f32>(0), io.read::<f32>(1), io.read::<f32>(2), io.write::<f32>());
        let [heads, steps, size] = self.sizes;
        y.copy_from_slice(x);
        if size == 0 {
            return Ok(());
        }
        for (row, y) in y.chunks_mut(size).enumerate() {
            let (image, step) = if self.is_head_first {
                (row / steps / heads, row % steps)
            } else {
                (row / heads / steps, row / heads % steps)
            };
            let token = image * steps + step;
            let at = match self.positions {
                Some((kind, rows)) => index(read_index(io, 3, kind, token), rows)?,
                None => token,
            };
            let (cos, sin) = (&cos[at * self.half..][..self.half], &sin[at * self.half..][..self.half]);
            for (i, (cos, sin)) in cos.iter().zip(sin).enumerate() {
                let [a, b] = if self.is_interleaved { [2 * i, 2 * i + 1] } else { [i, i + self.half] };
                (y[a], y[b]) = (cos * y[a] - sin * y[b], sin * y[a] + cos * y[b]);
            }
        }
        Ok(())
    }
}
