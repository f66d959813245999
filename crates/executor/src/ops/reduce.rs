//! Reductions.

use opendr_engine::Result;
use opendr_kernels::{Binary, add_column_sums};
use opendr_onnx::proto::NodeProto;

use super::inputs::{axis, list, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Reduction {
    Sum,
    Mean,
    Max,
    Min,
    Prod,
    SumSquare,
    L1,
    L2,
    LogSum,
    LogSumExp,
}

pub(crate) fn reduce(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let axes = list(planner, node, inputs, "axes", 1)?.unwrap_or_default();
    if axes.is_empty() && node.int_or("noop_with_empty_axes", 0) != 0 {
        return Ok(vec![x]);
    }
    let mut gone = axes.iter().map(|&along| axis(node, along, dims.len())).collect::<Result<Vec<_>>>()?;
    if gone.is_empty() {
        gone = (0..dims.len()).collect();
    }
    let reduction = match node.op_type.as_str() {
        "ReduceSum" => Reduction::Sum,
        "ReduceMean" => Reduction::Mean,
        "ReduceMax" => Reduction::Max,
        "ReduceMin" => Reduction::Min,
        "ReduceProd" => Reduction::Prod,
        "ReduceSumSquare" => Reduction::SumSquare,
        "ReduceL1" => Reduction::L1,
        "ReduceLogSum" => Reduction::LogSum,
        "ReduceLogSumExp" => Reduction::LogSumExp,
        _ => Reduction::L2,
    };
    let kind = planner.kind(x);
    let integers = matches!(kind, Kind::I64 | Kind::I32)
        && matches!(reduction, Reduction::Sum | Reduction::Max | Reduction::Min | Reduction::Prod);
    if kind != Kind::F32 && !integers {
        return Err(node.refused(&format!("elements of type {kind:?}")));
    }
    let keep = node.int_or("keepdims", 1) != 0;
    let kept: Vec<usize> = (0..dims.len()).map(|d| if gone.contains(&d) { 1 } else { dims[d] }).collect();
    let shape: Vec<usize> = (0..dims.len()).filter(|d| keep || !gone.contains(d)).map(|d| kept[d]).collect();
    let length = count(&gone.iter().map(|&d| dims[d]).collect::<Vec<_>>())?;
    let first = gone.iter().copied().min().unwrap_or(0);
    // The last dimensions but the channels lie side by side in a tensor with channels last.
    let spatial = dims.len() > 2
        && planner.is_channels_last(x)
        && reduction != Reduction::LogSumExp
        && first >= 2
        && (first..dims.len()).all(|d| gone.contains(&d));
    if spatial {
        let step = ReduceStep { reduction, kind, length, inner: dims[1] };
        let y = planner.emit_one(step, &[x], kind, kept, Layout::ChannelsLast)?;
        return Ok(vec![if keep { y } else { planner.reshaped(y, shape)? }]);
    }
    let mut x = planner.plain(x)?;
    let last = gone.iter().copied().max().unwrap_or(0);
    let joined = (first..=last).all(|d| gone.contains(&d) || dims[d] == 1);
    let rest: usize = dims.get(last + 1..).map_or(1, |rest| rest.iter().product());
    // The largest exponent has to be known before the sum.
    let is_sequential = reduction == Reduction::LogSumExp && rest != 1;
    let inner = if joined && !is_sequential || gone.is_empty() {
        rest
    } else {
        let mut order: Vec<usize> = (0..dims.len()).filter(|d| !gone.contains(d)).collect();
        order.extend(gone.iter().copied());
        let moved: Vec<usize> = order.iter().map(|&d| dims[d]).collect();
        let remap = crate::remap::transposed(&dims, &order, kind.bytes());
        x = planner.emit_one(remap, &[x], kind, moved, Layout::Plain)?;
        1
    };
    let step = ReduceStep { reduction, kind, length, inner };
    Ok(vec![planner.emit_one(step, &[x], kind, shape, Layout::Plain)?])
}

/// Sums runs of `length` elements, of floats or integers.
pub(super) fn sum_runs(planner: &mut Planner<'_>, x: Id, length: usize, shape: Vec<usize>) -> Result<Id> {
    let kind = planner.kind(x);
    let step = ReduceStep { reduction: Reduction::Sum, kind, length, inner: 1 };
    planner.emit_one(step, &[x], kind, shape, Layout::Plain)
}

struct ReduceStep {
    reduction: Reduction,
    kind: Kind,
    length: usize,
    inner: usize,
}

impl Kernel for ReduceStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        match self.kind {
            Kind::F32 => self.floats(io),
            Kind::I64 => self.integers::<i64>(io, |x| x, |y| y),
            _ => self.integers::<i32>(io, i64::from, |y| y as i32),
        }
        Ok(())
    }
}

impl ReduceStep {
    fn floats(&self, io: &mut Io<'_>) {
        let (x, y) = (io.read::<f32>(0), io.write::<f32>());
        let isa = io.compute.isa();
        let (length, inner) = (self.length, self.inner.max(1));
        let start = match self.reduction {
            Reduction::Max => f32::NEG_INFINITY,
            Reduction::Min => f32::INFINITY,
            Reduction::Prod => 1.0,
            _ => 0.0,
        };
        if length == 0 {
            y.fill(match self.reduction {
                Reduction::LogSum | Reduction::LogSumExp => f32::NEG_INFINITY,
                _ => start,
            });
            return;
        }
        for (y, x) in y.chunks_mut(inner).zip(x.chunks(length * inner)) {
            if inner == 1 {
                y[0] = match self.reduction {
                    Reduction::Sum | Reduction::Mean | Reduction::LogSum => super::normalise::sum(x),
                    Reduction::L1 => x.iter().map(|x| x.abs()).sum(),
                    Reduction::LogSumExp => log_sum_exp(x),
                    Reduction::SumSquare | Reduction::L2 => super::normalise::squares(x),
                    Reduction::Max => x.iter().copied().fold(start, f32::max),
                    Reduction::Min => x.iter().copied().fold(start, f32::min),
                    Reduction::Prod => x.iter().product(),
                };
            } else if matches!(self.reduction, Reduction::Sum | Reduction::Mean | Reduction::LogSum) {
                y.fill(start);
                add_column_sums(isa, x, y);
            } else {
                y.fill(start);
                for x in x.chunks_exact(inner) {
                    match self.reduction {
                        Reduction::L1 => y.iter_mut().zip(x).for_each(|(y, x)| *y += x.abs()),
                        Reduction::Max => Binary::Max.apply_to(isa, y, x),
                        Reduction::Min => Binary::Min.apply_to(isa, y, x),
                        Reduction::Prod => Binary::Mul.apply_to(isa, y, x),
                        _ => y.iter_mut().zip(x).for_each(|(y, x)| *y += x * x),
                    }
                }
            }
            match self.reduction {
                Reduction::Mean => Binary::Mul.apply_scalar(isa, y, 1.0 / length as f32),
                Reduction::L2 => y.iter_mut().for_each(|y| *y = y.sqrt()),
                Reduction::LogSum => y.iter_mut().for_each(|y| *y = y.ln()),
                _ => {}
            }
        }
    }

    fn integers<T: opendr_kernels::Number>(
        &self,
        io: &mut Io<'_>,
        read: impl Fn(T) -> i64,
        write: impl Fn(i64) -> T,
    ) {
        let (x, y) = (io.read::<T>(0), io.write::<T>());
        let inner = self.inner.max(1);
        for (index, y) in y.iter_mut().enumerate() {
            let from = index / inner * self.length * inner + index % inner;
            let values = (0..self.length).map(|i| read(x[from + i * inner]));
            *y = write(match self.reduction {
                Reduction::Max => values.max().unwrap_or(i64::MIN),
                Reduction::Min => values.min().unwrap_or(i64::MAX),
                Reduction::Prod => values.fold(1, i64::wrapping_mul),
                _ => values.fold(0, i64::wrapping_add),
            });
        }
    }
}

/// Returns the logarithm of the sum of exponentials, without overflow.
fn log_sum_exp(x: &[f32]) -> f32 {
    let largest = x.iter().copied().fold(f32::NEG_INFINITY, f32::max);
    // Infinities have no difference.
    let base = if largest.is_finite() { largest } else { 0.0 };
    base + x.iter().map(|x| (x - base).exp()).sum::<f32>().ln()
}

pub(crate) fn arg(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let kind = planner.kind(x);
    let dims = planner.shape(x);
    let along = axis(node, node.int_or("axis", 0), dims.len())?;
    if !matches!(kind, Kind::F32 | Kind::I64 | Kind::I32 | Kind::U8 | Kind::I8) {
        return Err(node.refused(&format!("elements of type {kind:?}")));
    }
    let mut kept = dims.clone();
    kept[along] = 1;
    let mut shape = kept.clone();
    if node.int_or("keepdims", 1) == 0 {
        shape.remove(along);
    }
    let largest = node.op_type == "ArgMax";
    let last = node.int_or("select_last_index", 0) != 0;
    // The channels of a tensor with channels last are contiguous, and the result has one.
    let contiguous = along == 1 && planner.is_channels_last(x);
    let x = if contiguous { x } else { planner.plain(x)? };
    let inner = if contiguous { 1 } else { dims[along + 1..].iter().product() };
    let step = ArgStep { length: dims[along], inner, kind, largest, last };
    Ok(vec![planner.emit_one(step, &[x], Kind::I64, shape, Layout::Plain)?])
}

struct ArgStep {
    length: usize,
    inner: usize,
    kind: Kind,
    largest: bool,
    last: bool,
}

impl Kernel for ArgStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        match self.kind {
            Kind::F32 => self.find::<f32>(io),
            Kind::I64 => self.find::<i64>(io),
            Kind::I32 => self.find::<i32>(io),
            Kind::I8 => self.find::<i8>(io),
            _ => self.find::<u8>(io),
        }
        Ok(())
    }
}

impl ArgStep {
    fn find<T: opendr_kernels::Number + PartialOrd>(&self, io: &mut Io<'_>) {
        let (x, y) = (io.read::<T>(0), io.write::<i64>());
        let inner = self.inner.max(1);
        if self.length == 0 || y.is_empty() {
            return;
        }
        const PIECE: usize = 1 << 10;
        io.compute.pool().run_on_pieces(y, PIECE, |piece, y| {
            for (i, y) in y.iter_mut().enumerate() {
                let index = piece * PIECE + i;
                let from = index / inner * self.length * inner + index % inner;
                let mut best = 0;
                let mut value = x[from];
                for i in 1..self.length {
                    let other = x[from + i * inner];
                    let better = if self.largest { other > value } else { other < value };
                    if better || (self.last && other == value) {
                        (best, value) = (i, other);
                    }
                }
                *y = best as i64;
            }
        });
    }
}
