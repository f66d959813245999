//! Operators that select elements by indices or by size.

use opendr_engine::{Error, Result};
use opendr_kernels::Number;
use opendr_onnx::proto::NodeProto;

use super::inputs::{axis, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::by_size;
use crate::tensor::{Kind, count};

/// Returns an index of a dimension of `size`, which may be negative.
fn index(at: i64, size: usize) -> Result<usize> {
    let signed = i64::try_from(size).unwrap_or(i64::MAX);
    let absolute = if at < 0 { at.saturating_add(signed) } else { at };
    usize::try_from(absolute)
        .ok()
        .filter(|&index| index < size)
        .ok_or_else(|| Error::invalid_input(format!("the ONNX model selects element {at} of {size}")))
}

/// Returns indices of either integer type, as a value of 64 bits.
fn indices(planner: &mut Planner<'_>, node: &NodeProto, id: Id) -> Result<(Id, Kind)> {
    let kind = planner.kind(id);
    if !matches!(kind, Kind::I64 | Kind::I32) {
        return Err(node.damaged("indices that are not integers"));
    }
    Ok((planner.plain(id)?, kind))
}

fn read_index(io: &Io<'_>, slot: usize, kind: Kind, at: usize) -> i64 {
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
struct Tuples {
    at_kind: Kind,
    /// Sizes and strides of the indexed dimensions.
    dims: Vec<(usize, usize)>,
    /// Elements of a slice.
    inner: usize,
    /// Tuples per batch, and elements per batch.
    per_batch: usize,
    batch_length: usize,
}

impl Tuples {
    /// Returns where the slice of a tuple begins.
    fn start(&self, io: &Io<'_>, tuple: usize) -> Result<usize> {
        let mut at = tuple / self.per_batch.max(1) * self.batch_length;
        for (i, &(size, stride)) in self.dims.iter().enumerate() {
            at += index(read_index(io, 1, self.at_kind, tuple * self.dims.len() + i), size)? * stride;
        }
        Ok(at)
    }
}

/// Reads the tuples of `GatherND` and `ScatterND`.
fn tuples(
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

pub(crate) fn scatter_nd(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let [x, at, updates] = [0, 1, 2].map(|slot| required(node, inputs, slot));
    let (x, updates) = (planner.plain(x?)?, planner.plain(updates?)?);
    let (tuples, at, shape) = tuples(planner, node, x, at?, 0)?;
    let kind = planner.kind(x);
    if planner.shape(updates) != shape
        || planner.kind(updates) != kind
        || node.text("reduction", "none") != "none"
    {
        return Err(node.refused("its updates or its reduction"));
    }
    let dims = planner.shape(x);
    let step = ScatterNdStep { size: kind.bytes(), tuples };
    Ok(vec![planner.emit_one(step, &[x, at, updates], kind, dims, Layout::Plain)?])
}

struct ScatterNdStep {
    size: usize,
    tuples: Tuples,
}

impl Kernel for ScatterNdStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        by_size!(self.size, T => {
            let (x, updates, y) = (io.read::<T>(0), io.read::<T>(2), io.write::<T>());
            y.copy_from_slice(x);
            let inner = self.tuples.inner;
            for (tuple, update) in updates.chunks(inner.max(1)).enumerate() {
                let at = self.tuples.start(io, tuple)?;
                y[at..at + inner].copy_from_slice(update);
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

pub(crate) fn scatter_elements(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let [x, at, updates] = [0, 1, 2].map(|slot| required(node, inputs, slot));
    let (x, updates) = (planner.plain(x?)?, planner.plain(updates?)?);
    let (at, at_kind) = indices(planner, node, at?)?;
    let (dims, at_dims) = (planner.shape(x), planner.shape(at));
    let along = axis(node, node.int_or("axis", 0), dims.len())?;
    let fits = at_dims.len() == dims.len() && (0..dims.len()).all(|d| d == along || at_dims[d] <= dims[d]);
    if !fits
        || planner.shape(updates) != at_dims
        || planner.kind(updates) != planner.kind(x)
        || node.text("reduction", "none") != "none"
    {
        return Err(node.refused("its updates or its reduction"));
    }
    let kind = planner.kind(x);
    let step = ScatterElementsStep { size: kind.bytes(), along, dims: dims.clone(), at_dims, at_kind };
    Ok(vec![planner.emit_one(step, &[x, at, updates], kind, dims, Layout::Plain)?])
}

struct ScatterElementsStep {
    size: usize,
    along: usize,
    dims: Vec<usize>,
    at_dims: Vec<usize>,
    at_kind: Kind,
}

impl Kernel for ScatterElementsStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let strides = crate::remap::strides(&self.dims);
        by_size!(self.size, T => {
            let (x, updates, y) = (io.read::<T>(0), io.read::<T>(2), io.write::<T>());
            y.copy_from_slice(x);
            for (i, update) in updates.iter().enumerate() {
                let (mut rest, mut at) = (i, 0);
                for d in (0..self.dims.len()).rev() {
                    let own = rest % self.at_dims[d];
                    rest /= self.at_dims[d];
                    let own = if d == self.along { index(read_index(io, 1, self.at_kind, i), self.dims[d])? } else { own };
                    at += own * strides[d];
                }
                y[at] = *update;
            }
        });
        Ok(())
    }
}

pub(crate) fn top_k(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let dims = planner.shape(x);
    let along = axis(node, node.int_or("axis", -1), dims.len())?;
    let wanted = match node.find("k") {
        Some(attribute) => attribute.i,
        None => planner.ints(node, required(node, inputs, 1)?)?.first().copied().unwrap_or(-1),
    };
    let k = usize::try_from(wanted).ok().filter(|&k| k <= dims[along]);
    let k = k.ok_or_else(|| node.damaged(&format!("the {wanted} largest of {}", dims[along])))?;
    let kind = planner.kind(x);
    if !matches!(kind, Kind::F32 | Kind::I64) {
        return Err(node.refused(&format!("elements of type {kind:?}")));
    }
    let mut shape = dims.clone();
    shape[along] = k;
    let inner = dims[along + 1..].iter().product();
    let step = TopKStep { kind, length: dims[along], inner, k, largest: node.int_or("largest", 1) != 0 };
    let outputs = [(kind, shape.clone(), Layout::Plain), (Kind::I64, shape, Layout::Plain)];
    planner.emit(step, &[Some(x)], &outputs)
}

struct TopKStep {
    kind: Kind,
    length: usize,
    inner: usize,
    k: usize,
    largest: bool,
}

impl Kernel for TopKStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        match self.kind {
            Kind::I64 => self.select::<i64>(io, |a, b| a.cmp(b)),
            _ => self.select::<f32>(io, f32::total_cmp),
        }
        Ok(())
    }
}

impl TopKStep {
    fn select<T: Number>(&self, io: &mut Io<'_>, compare: impl Fn(&T, &T) -> std::cmp::Ordering) {
        let x = io.read::<T>(0);
        let (values, positions) = io.write_two::<T, i64>();
        let inner = self.inner.max(1);
        if self.k == 0 || values.is_empty() {
            return;
        }
        let mut order: Vec<usize> = Vec::with_capacity(self.length);
        for row in 0..values.len() / self.k {
            let (outer, column) = (row / inner, row % inner);
            let at = |i: usize| x[(outer * self.length + i) * inner + column];
            let by_rank = |a: &usize, b: &usize| {
                let sizes = compare(&at(*a), &at(*b));
                // The lower index comes first where values are equal.
                (if self.largest { sizes.reverse() } else { sizes }).then(a.cmp(b))
            };
            order.clear();
            order.extend(0..self.length);
            if self.k < self.length {
                order.select_nth_unstable_by(self.k - 1, by_rank);
            }
            order[..self.k].sort_unstable_by(by_rank);
            for (rank, &i) in order[..self.k].iter().enumerate() {
                let to = (outer * self.k + rank) * inner + column;
                values[to] = at(i);
                positions[to] = i as i64;
            }
        }
    }
}
