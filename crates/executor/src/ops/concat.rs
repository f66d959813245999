//! Concatenation.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::inputs::{axis, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::by_size;
use crate::tensor::{Kind, count};

pub(crate) fn concat(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let ids = (0..inputs.len()).map(|slot| required(node, inputs, slot)).collect::<Result<Vec<_>>>()?;
    let first = required(node, inputs, 0)?;
    let (mut shape, kind) = (planner.shape(first), planner.kind(first));
    let along = axis(node, node.int_or("axis", 0), shape.len())?;
    let mut total = 0_usize;
    for &id in &ids {
        let other = planner.shape(id);
        let fits = other.len() == shape.len() && (0..shape.len()).all(|d| d == along || other[d] == shape[d]);
        if !fits || planner.kind(id) != kind {
            return Err(node.damaged(&format!("parts {shape:?} and {other:?}")));
        }
        total = total.saturating_add(other[along]);
    }
    shape[along] = total;
    count(&shape)?;
    let images: Option<Vec<Id>> = ids.iter().map(|&id| planner.images(id, along)).collect();
    if let Some(images) = images.filter(|images| {
        let image = |id: &Id| planner.value(*id).shape.get(1..);
        images.iter().all(|id| image(id) == image(&images[0]))
    }) {
        let joined = joined(planner, &images, 0)?;
        return Ok(vec![planner.reshaped(joined, shape)?]);
    }
    if along == 1
        && kind == Kind::F32
        && let Some(joined) = written_in_place(planner, &ids, &shape)?
    {
        return Ok(vec![joined]);
    }
    Ok(vec![joined(planner, &ids, along)?])
}

/// Makes the steps that compute parts write them to their channels of the result, where nothing else reads these parts, and copies
/// the other ones. Returns `None` where all parts would be copied.
fn written_in_place(planner: &mut Planner<'_>, ids: &[Id], shape: &[usize]) -> Result<Option<Id>> {
    let (Some(&channels), true) = (shape.get(1), shape.len() > 2) else { return Ok(None) };
    let steps: Vec<Option<usize>> = ids.iter().map(|&id| planner.only_step(id)).collect();
    let (mut first, mut places, mut moved) = (0, Vec::new(), Vec::new());
    for (&id, step) in ids.iter().zip(steps) {
        let part = planner.value(id).shape[1];
        match step.filter(|&step| planner.steps[step].kernel.widen(channels, first)) {
            Some(step) => moved.push(step),
            None => places.push((id, part, first)),
        }
        first += part;
    }
    if moved.is_empty() {
        return Ok(None);
    }
    let joined = planner.add_joined(&moved, shape)?;
    if !places.is_empty() {
        let mut reads = Vec::new();
        for &(id, ..) in &places {
            reads.push(planner.channels_last(id)?);
        }
        let parts = places.iter().map(|&(_, part, first)| (part, first)).collect();
        let kernel = ConcatCopy { parts, total: channels, size: Kind::F32.bytes() };
        planner.emit_part(kernel, &reads, joined);
    }
    Ok(Some(joined))
}

/// Joins values of one type, whose other dimensions are equal, along an axis.
fn joined(planner: &mut Planner<'_>, ids: &[Id], along: usize) -> Result<Id> {
    let (mut shape, kind) = (planner.shape(ids[0]), planner.kind(ids[0]));
    shape[along] = ids.iter().map(|&id| planner.value(id).shape[along]).sum();
    let last = shape.len() > 2 && ids.iter().any(|&id| planner.is_channels_last(id));
    let layout = if last { Layout::ChannelsLast } else { Layout::Plain };
    let mut reads = Vec::new();
    for &id in ids {
        reads.push(if last { planner.channels_last(id)? } else { planner.plain(id)? });
    }
    let place = match (layout, along) {
        (Layout::Plain, along) => along,
        (_, 0) => 0,
        (_, 1) => shape.len() - 1,
        (_, along) => along - 1,
    };
    let (mut parts, mut total) = (Vec::new(), 0);
    for &id in &reads {
        let length: usize = planner.value(id).physical()[place..].iter().product();
        parts.push((length, total));
        total += length;
    }
    let kernel = ConcatCopy { parts, total, size: kind.bytes() };
    planner.emit_one(kernel, &reads, kind, shape, layout)
}

/// Elements that a thread copies at a time.
const PIECE: usize = 1 << 15;
/// Inputs that are joined in one pass over the output.
const GROUP: usize = 8;

/// Copies its inputs to their places in the output.
struct ConcatCopy {
    /// Elements of each input per step along the outer dimensions, and the first one in the output.
    parts: Vec<(usize, usize)>,
    /// Elements of the output per step.
    total: usize,
    size: usize,
}

impl Kernel for ConcatCopy {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        by_size!(self.size, T => {
            let (y, total) = (io.write::<T>(), self.total.max(1));
            // A group of inputs at a time, so that nothing is allocated.
            for (group, parts) in self.parts.chunks(GROUP).enumerate() {
                let mut inputs = [&[] as &[T]; GROUP];
                for (slot, input) in inputs.iter_mut().enumerate().take(parts.len()) {
                    *input = io.read::<T>(group * GROUP + slot);
                }
                let rows = (PIECE / total).max(1);
                io.compute.pool().run_on_pieces(y, rows * total, |piece, y| {
                    for (x, &(length, at)) in inputs.iter().zip(parts).filter(|(_, part)| part.0 > 0) {
                        let x = x[piece * rows * length..].chunks(length);
                        y.chunks_mut(total).zip(x).for_each(|(y, x)| y[at..at + length].copy_from_slice(x));
                    }
                });
            }
        });
        Ok(())
    }
}
