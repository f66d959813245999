//! Operators that select elements by indices.

use opendr_engine::{Error, Result};
use opendr_onnx::proto::NodeProto;

use super::inputs::{axis, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::by_size;
use crate::tensor::{Kind, count};

/// Returns an index of a dimension of `size`, which may be negative.
pub(super) fn index(at: i64, size: usize) -> Result<usize> {
    let signed = i64::try_from(size).unwrap_or(i64::MAX);
    let absolute = if at < 0 { at.saturating_add(signed) } else { at };
    usize::try_from(absolute)
        .ok()
        .filter(|&index| index < size)
        .ok_or_else(|| Error::invalid_input(format!("the ONNX model selects element {at} of {size}")))
}

/// Returns indices of either integer type, as a value of 64 bits.
pub(super) fn indices(planner: &mut Planner<'_>, node: &NodeProto, id: Id) -> Result<(Id, Kind)> {
    let kind = planner.kind(id);
    if !matches!(kind, Kind::I64 | Kind::I32) {
        return Err(node.damaged("indices that are not integers"));
    }
    Ok((planner.plain(id)?, kind))
}

pub(super) fn read_index(io: &Io<'_>, slot: usize, kind: Kind, at: usize) -> i64 {
    if kind == Kind::I64 { io.read::<i64>(slot)[at] } else { i64::from(io.read::<i32>(slot)[at]) }
}

pub(crate) fn gather(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let (at, at_kind) = indices(planner, node, required(node, inputs, 1)?)?;
    let (dims, at_dims) = (planner.shape(x), planner.shape(at));
    let along = axis(node, node.int_or("axis", 0), dims.len())?;
    let shape = [&dims[..along], &at_dims, &dims[along + 1..]].concat();
    count(&shape)?;
    let kind = planner.kind(x);
    let step = GatherStep {
        size: kind.bytes(),
        length: dims[along],
        inner: dims[along + 1..].iter().product(),
        indices: count(&at_dims)?,
        at_kind,
    };
    Ok(vec![planner.emit_one(step, &[x, at], kind, shape, Layout::Plain)?])
}

struct GatherStep {
    size: usize,
    length: usize,
    inner: usize,
    indices: usize,
    at_kind: Kind,
}

impl Kernel for GatherStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        by_size!(self.size, T => {
            let (x, y) = (io.read::<T>(0), io.write::<T>());
            if self.inner == 0 || self.indices == 0 {
                return Ok(());
            }
            for (outer, y) in y.chunks_mut(self.indices * self.inner).enumerate() {
                for (i, y) in y.chunks_mut(self.inner).enumerate() {
                    let at = index(read_index(io, 1, self.at_kind, i), self.length)?;
                    y.copy_from_slice(&x[(outer * self.length + at) * self.inner..][..self.inner]);
                }
            }
        });
        Ok(())
    }
}

/// How tuples of indices select slices.
pub(super) struct Tuples {
    at_kind: Kind,
    /// Sizes and strides of the indexed dimensions.
    dims: Vec<(usize, usize)>,
    /// Elements of a slice.
    pub(super) inner: usize,
    /// Tuples per batch, and elements per batch.
    per_batch: usize,
    batch_length: usize,
}

impl Tuples {
    /// Returns where the slice of a tuple begins.
    pub(super) fn start(&self, io: &Io<'_>, tuple: usize) -> Result<usize> {
        let mut at = tuple / self.per_batch.max(1) * self.batch_length;
        for (i, &(size, stride)) in self.dims.iter().enumerate() {
            at += index(read_index(io, 1, self.at_kind, tuple * self.dims.len() + i), size)? * stride;
        }
        Ok(at)
    }
}

/// Reads the tuples of `GatherND` and `ScatterND`.
pub(super) fn tuples(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    x: Id,
    at: Id,
    batch_dims: usize,
) -> Result<(Tuples, Id, Vec<usize>)> {
    let (at, at_kind) = indices(planner, node, at)?;
    let (dims, at_dims) = (planner.shape(x), planner.shape(at));
    let Some((&depth, outer)) = at_dims.split_last() else {
        return Err(node.damaged("indices without dimensions"));
    };
    if batch_dims > outer.len()
        || batch_dims + depth > dims.len()
        || dims.get(..batch_dims) != outer.get(..batch_dims)
    {
        return Err(node.damaged("its batch dimensions, or the length of its tuples"));
    }
    let strides = crate::remap::strides(&dims);
    let range = batch_dims..batch_dims + depth;
    let tuples = Tuples {
        at_kind,
        dims: range.map(|d| (dims[d], strides[d])).collect(),
        inner: dims[batch_dims + depth..].iter().product(),
        per_batch: outer[batch_dims..].iter().product(),
        batch_length: dims[batch_dims..].iter().product(),
    };
    let shape = [outer, &dims[batch_dims + depth..]].concat();
    count(&shape)?;
    Ok((tuples, at, shape))
}

pub(crate) fn gather_nd(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let batch_dims = usize::try_from(node.int_or("batch_dims", 0))
        .map_err(|_| node.damaged("attribute \"batch_dims\""))?;
    let (tuples, at, shape) = tuples(planner, node, x, required(node, inputs, 1)?, batch_dims)?;
    let kind = planner.kind(x);
    let step = GatherNdStep { size: kind.bytes(), tuples };
    Ok(vec![planner.emit_one(step, &[x, at], kind, shape, Layout::Plain)?])
}

struct GatherNdStep {
    size: usize,
    tuples: Tuples,
}

impl Kernel for GatherNdStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        by_size!(self.size, T => {
            let (x, y) = (io.read::<T>(0), io.write::<T>());
            let inner = self.tuples.inner;
            for (tuple, y) in y.chunks_mut(inner.max(1)).enumerate() {
                let at = self.tuples.start(io, tuple)?;
                y.copy_from_slice(&x[at..at + inner]);
            }
        });
        Ok(())
    }
}

pub(crate) fn gather_elements(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let (at, at_kind) = indices(planner, node, required(node, inputs, 1)?)?;
    let (dims, at_dims) = (planner.shape(x), planner.shape(at));
    let along = axis(node, node.int_or("axis", 0), dims.len())?;
    if at_dims.len() != dims.len() || (0..dims.len()).any(|d| d != along && at_dims[d] > dims[d]) {
        return Err(node.damaged(&format!("indices {at_dims:?} of an input {dims:?}")));
    }
    let kind = planner.kind(x);
    let step = GatherElementsStep { size: kind.bytes(), along, dims, at_dims: at_dims.clone(), at_kind };
    Ok(vec![planner.emit_one(step, &[x, at], kind, at_dims, Layout::Plain)?])
}

struct GatherElementsStep {
    size: usize,
    along: usize,
    dims: Vec<usize>,
    at_dims: Vec<usize>,
    at_kind: Kind,
}

impl Kernel for GatherElementsStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let strides = crate::remap::strides(&self.dims);
        by_size!(self.size, T => {
            let (x, y) = (io.read::<T>(0), io.write::<T>());
            for (i, y) in y.iter_mut().enumerate() {
                let selected = index(read_index(io, 1, self.at_kind, i), self.dims[self.along])?;
                let (mut rest, mut at) = (i, selected * strides[self.along]);
                for d in (0..self.dims.len()).rev() {
                    if d != self.along {
                        at += rest % self.at_dims[d] * strides[d];
                    }
                    rest /= self.at_dims[d];
                }
                *y = x[at];
            }
        });
        Ok(())
    }
}
