//! Operators along one axis or over matrices: sums of what came before, triangles, encodings of indices.

use opendr_engine::Result;
use opendr_kernels::Number;
use opendr_onnx::proto::NodeProto;

use super::inputs::{axis, optional, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::by_size;
use crate::tensor::{Kind, count};

/// Largest side of the tensor that an index is encoded in.
const MAX_DEPTH: i64 = 1 << 24;

pub(crate) fn cumulative_sum(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let (dims, kind) = (planner.shape(x), planner.kind(x));
    let along = planner.ints(node, required(node, inputs, 1)?)?;
    let [along] = along[..] else { return Err(node.damaged("its axis")) };
    let along = axis(node, along, dims.len())?;
    if !matches!(kind, Kind::F32 | Kind::I64 | Kind::I32) {
        return Err(node.refused(&format!("elements of type {kind:?}")));
    }
    let step = CumulativeSumStep {
        kind,
        length: dims[along],
        inner: dims[along + 1..].iter().product(),
        is_exclusive: node.int_or("exclusive", 0) != 0,
        is_reversed: node.int_or("reverse", 0) != 0,
    };
    Ok(vec![planner.emit_one(step, &[x], kind, dims, Layout::Plain)?])
}

struct CumulativeSumStep {
    kind: Kind,
    length: usize,
    inner: usize,
    is_exclusive: bool,
    is_reversed: bool,
}

impl Kernel for CumulativeSumStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        match self.kind {
            Kind::F32 => self.sums(io, 0.0, |a: f32, b: f32| a + b),
            Kind::I64 => self.sums(io, 0, i64::wrapping_add),
            _ => self.sums(io, 0, i32::wrapping_add),
        }
        Ok(())
    }
}

impl CumulativeSumStep {
    fn sums<T: Number>(&self, io: &mut Io<'_>, zero: T, add: impl Fn(T, T) -> T) {
        let (x, y) = (io.read::<T>(0), io.write::<T>());
        let inner = self.inner.max(1);
        let block = self.length.max(1) * inner;
        for (x, y) in x.chunks(block).zip(y.chunks_mut(block)) {
            for column in 0..inner {
                let mut sum = zero;
                for step in 0..self.length {
                    let row = if self.is_reversed { self.length - 1 - step } else { step };
                    let at = row * inner + column;
                    let next = add(sum, x[at]);
                    y[at] = if self.is_exclusive { sum } else { next };
                    sum = next;
                }
            }
        }
    }
}

pub(crate) fn triangle(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let x = planner.plain(x)?;
    let (dims, kind) = (planner.shape(x), planner.kind(x));
    let diagonal = match optional(inputs, 1) {
        Some(diagonal) => planner.ints(node, diagonal)?.first().copied().unwrap_or(0),
        None => 0,
    };
    let &[.., rows, columns] = &dims[..] else { return Err(node.damaged("an input without matrices")) };
    let step =
        TriangleStep { size: kind.bytes(), rows, columns, diagonal, is_upper: node.int_or("upper", 1) != 0 };
    Ok(vec![planner.emit_one(step, &[x], kind, dims, Layout::Plain)?])
}

struct TriangleStep {
    size: usize,
    rows: usize,
    columns: usize,
    diagonal: i64,
    is_upper: bool,
}

impl Kernel for TriangleStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        by_size!(self.size, T => {
            let (x, y) = (io.read::<T>(0), io.write::<T>());
            y.copy_from_slice(x);
            for (index, y) in y.chunks_mut(self.columns.max(1)).enumerate() {
                let row = (index % self.rows.max(1)) as i64;
                // The first column of the diagonal, or the one after it.
                let end = row.saturating_add(self.diagonal).saturating_add(i64::from(!self.is_upper));
                let end = end.clamp(0, self.columns as i64) as usize;
                if self.is_upper { y[..end].fill(T::default()) } else { y[end..].fill(T::default()) }
            }
        });
        Ok(())
    }
}

pub(crate) fn eye_like(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let &[rows, columns] = planner.shape(x).as_slice() else { return Err(node.damaged("a matrix")) };
    let kind = match node.find("dtype") {
        Some(kind) => Kind::from_onnx(i32::try_from(kind.i).unwrap_or(-1), &node.name)?,
        None => planner.kind(x),
    };
    if kind == Kind::F16 {
        return Err(node.refused("16-bit floats"));
    }
    let step = EyeStep { kind, columns, diagonal: node.int_or("k", 0) };
    let eye = planner.emit_one(step, &[], kind, vec![rows, columns], Layout::Plain)?;
    Ok(vec![eye])
}

struct EyeStep {
    kind: Kind,
    columns: usize,
    diagonal: i64,
}

impl Kernel for EyeStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        match self.kind {
            Kind::F32 => self.write(io.write(), 1.0_f32),
            Kind::I64 => self.write(io.write(), 1_i64),
            Kind::I32 => self.write(io.write(), 1_i32),
            _ => self.write(io.write(), 1_u8),
        }
        Ok(())
    }
}

impl EyeStep {
    fn write<T: Number>(&self, y: &mut [T], one: T) {
        y.fill(T::default());
        for (row, y) in y.chunks_mut(self.columns.max(1)).enumerate() {
            let column = usize::try_from((row as i64).saturating_add(self.diagonal)).ok();
            if let Some(y) = column.and_then(|column| y.get_mut(column)) {
                *y = one;
            }
        }
    }
}

pub(crate) fn one_hot(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let [at, depth, values] = [0, 1, 2].map(|slot| required(node, inputs, slot));
    let (at, values) = (planner.plain(at?)?, planner.plain(values?)?);
    let depth = depth?;
    let depth = planner.known(node, depth)?;
    let depth = match depth.floats() {
        Some(depth) => depth.first().map(|&depth| depth as i64),
        None => depth.ints().and_then(|depth| depth.first().copied()),
    };
    let depth = depth.unwrap_or(-1);
    let depth = usize::try_from(depth).ok().filter(|_| (1..=MAX_DEPTH).contains(&depth));
    let depth = depth.ok_or_else(|| node.damaged("its depth"))?;
    let (dims, at_kind, kind) = (planner.shape(at), planner.kind(at), planner.kind(values));
    if !matches!(at_kind, Kind::I64 | Kind::I32 | Kind::F32) || planner.shape(values) != [2] {
        return Err(node.refused("its indices or values"));
    }
    let along = axis(node, node.int_or("axis", -1), dims.len() + 1)?;
    let mut shape = dims.clone();
    shape.insert(along, depth);
    count(&shape)?;
    let step = OneHotStep { size: kind.bytes(), at_kind, depth, inner: dims[along..].iter().product() };
    Ok(vec![planner.emit_one(step, &[at, values], kind, shape, Layout::Plain)?])
}

struct OneHotStep {
    size: usize,
    at_kind: Kind,
    depth: usize,
    inner: usize,
}

impl Kernel for OneHotStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let at = |io: &Io<'_>, index: usize| match self.at_kind {
            Kind::I64 => io.read::<i64>(0)[index],
            Kind::I32 => i64::from(io.read::<i32>(0)[index]),
            _ => io.read::<f32>(0)[index] as i64,
        };
        let (depth, inner) = (self.depth, self.inner.max(1));
        by_size!(self.size, T => {
            let (values, y) = (io.read::<T>(1), io.write::<T>());
            y.fill(values[0]);
            for index in 0..y.len() / depth {
                let class = at(io, index);
                let class = if class < 0 { class.saturating_add(depth as i64) } else { class };
                // An index outside of the depth sets nothing.
                if let Some(class) = usize::try_from(class).ok().filter(|&class| class < depth) {
                    y[(index / inner * depth + class) * inner + index % inner] = values[1];
                }
            }
        });
        Ok(())
    }
}
