//! Operators that write elements at indices.

use opendr_engine::Result;
use opendr_kernels::Number;
use opendr_onnx::proto::NodeProto;

use super::index::{Tuples, index, indices, read_index, tuples};
use super::inputs::{axis, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::by_size;
use crate::tensor::Kind;

/// What becomes of an element and its update.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reduction {
    Replace,
    Add,
    Mul,
    Max,
    Min,
}

impl Reduction {
    fn of(node: &NodeProto, kind: Kind) -> Result<Self> {
        let reduction = match node.text("reduction", "none").as_str() {
            "none" => Self::Replace,
            "add" => Self::Add,
            "mul" => Self::Mul,
            "max" => Self::Max,
            "min" => Self::Min,
            other => return Err(node.refused(&format!("reduction {other:?}"))),
        };
        if reduction != Self::Replace && !matches!(kind, Kind::F32 | Kind::I64 | Kind::I32) {
            return Err(node.refused(&format!("a reduction of elements of type {kind:?}")));
        }
        Ok(reduction)
    }
}

/// Copies the input, and calls `update` with its numbers and their updates.
macro_rules! scattered {
    ($self:expr, $io:expr, $update:ident) => {
        match ($self.reduction, $self.kind) {
            (Reduction::Replace, kind) => by_size!(kind.bytes(), T => $self.$update($io, |_: T, update: T| update)),
            (Reduction::Add, Kind::F32) => $self.$update($io, |own: f32, update: f32| own + update),
            (Reduction::Mul, Kind::F32) => $self.$update($io, |own: f32, update: f32| own * update),
            (Reduction::Max, Kind::F32) => $self.$update($io, f32::max),
            (Reduction::Min, Kind::F32) => $self.$update($io, f32::min),
            (Reduction::Add, Kind::I64) => $self.$update($io, i64::wrapping_add),
            (Reduction::Mul, Kind::I64) => $self.$update($io, i64::wrapping_mul),
            (Reduction::Max, Kind::I64) => $self.$update($io, i64::max),
            (Reduction::Min, Kind::I64) => $self.$update($io, i64::min),
            (Reduction::Add, _) => $self.$update($io, i32::wrapping_add),
            (Reduction::Mul, _) => $self.$update($io, i32::wrapping_mul),
            (Reduction::Max, _) => $self.$update($io, i32::max),
            (Reduction::Min, _) => $self.$update($io, i32::min),
        }
    };
}

pub(crate) fn nd(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let [x, at, updates] = [0, 1, 2].map(|slot| required(node, inputs, slot));
    let (x, updates) = (planner.plain(x?)?, planner.plain(updates?)?);
    let (tuples, at, shape) = tuples(planner, node, x, at?, 0)?;
    let kind = planner.kind(x);
    let reduction = Reduction::of(node, kind)?;
    if planner.shape(updates) != shape || planner.kind(updates) != kind {
        return Err(node.damaged("its updates do not match its indices"));
    }
    let dims = planner.shape(x);
    let step = NdStep { kind, reduction, tuples };
    Ok(vec![planner.emit_one(step, &[x, at, updates], kind, dims, Layout::Plain)?])
}

struct NdStep {
    kind: Kind,
    reduction: Reduction,
    tuples: Tuples,
}

impl Kernel for NdStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        scattered!(self, io, update)
    }
}

impl NdStep {
    fn update<T: Number>(&self, io: &mut Io<'_>, combine: impl Fn(T, T) -> T) -> Result<()> {
        let (x, updates, y) = (io.read::<T>(0), io.read::<T>(2), io.write::<T>());
        y.copy_from_slice(x);
        let inner = self.tuples.inner;
        for (tuple, updates) in updates.chunks(inner.max(1)).enumerate() {
            let at = self.tuples.start(io, tuple)?;
            y[at..at + inner].iter_mut().zip(updates).for_each(|(y, update)| *y = combine(*y, *update));
        }
        Ok(())
    }
}

pub(crate) fn elements(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let [x, at, updates] = [0, 1, 2].map(|slot| required(node, inputs, slot));
    let (x, updates) = (planner.plain(x?)?, planner.plain(updates?)?);
    let (at, at_kind) = indices(planner, node, at?)?;
    let (dims, at_dims) = (planner.shape(x), planner.shape(at));
    let along = axis(node, node.int_or("axis", 0), dims.len())?;
    let kind = planner.kind(x);
    let reduction = Reduction::of(node, kind)?;
    let fits = at_dims.len() == dims.len() && (0..dims.len()).all(|d| d == along || at_dims[d] <= dims[d]);
    if !fits || planner.shape(updates) != at_dims || planner.kind(updates) != kind {
        return Err(node.damaged("its updates do not match its indices"));
    }
    let step = ElementsStep { kind, reduction, along, dims: dims.clone(), at_dims, at_kind };
    Ok(vec![planner.emit_one(step, &[x, at, updates], kind, dims, Layout::Plain)?])
}

struct ElementsStep {
    kind: Kind,
    reduction: Reduction,
    along: usize,
    dims: Vec<usize>,
    at_dims: Vec<usize>,
    at_kind: Kind,
}

impl Kernel for ElementsStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        scattered!(self, io, update)
    }
}

impl ElementsStep {
    fn update<T: Number>(&self, io: &mut Io<'_>, combine: impl Fn(T, T) -> T) -> Result<()> {
        let strides = crate::remap::strides(&self.dims);
        let (x, updates, y) = (io.read::<T>(0), io.read::<T>(2), io.write::<T>());
        y.copy_from_slice(x);
        for (i, update) in updates.iter().enumerate() {
            let (mut rest, mut at) = (i, 0);
            for d in (0..self.dims.len()).rev() {
                let own = rest % self.at_dims[d];
                rest /= self.at_dims[d];
                let selected = d == self.along;
                let own =
                    if selected { index(read_index(io, 1, self.at_kind, i), self.dims[d])? } else { own };
                at += own * strides[d];
            }
            y[at] = combine(y[at], *update);
        }
        Ok(())
    }
}
