//! The largest or smallest elements along an axis.

use std::cmp::Ordering;

use opendr_engine::Result;
use opendr_kernels::Number;
use opendr_onnx::proto::NodeProto;

use super::inputs::{axis, required};
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::Kind;

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
            Kind::I64 => self.select::<i64>(io),
            _ => self.select::<f32>(io),
        }
        Ok(())
    }
}

/// Elements that are compared with the worst candidate at a time.
const BLOCK: usize = 64;

/// An element with a key that orders it; floats in their total order.
trait Ranked: Number {
    type Key: Ord + Copy;

    fn key(self) -> Self::Key;
}

impl Ranked for i64 {
    type Key = Self;

    fn key(self) -> Self {
        self
    }
}

impl Ranked for f32 {
    type Key = i32;

    fn key(self) -> i32 {
        let bits = self.to_bits().cast_signed();
        // Larger magnitudes of negative numbers come first.
        bits ^ ((bits >> 31).cast_unsigned() >> 1).cast_signed()
    }
}

impl TopKStep {
    fn select<T: Ranked>(&self, io: &mut Io<'_>) {
        let x = io.read::<T>(0);
        let (values, positions) = io.write_two::<T, i64>();
        let inner = self.inner.max(1);
        if self.k == 0 || values.is_empty() {
            return;
        }
        let mut gathered = Vec::new();
        let mut candidates = Candidates::new(self.k, self.length);
        for row in 0..values.len() / self.k {
            let (outer, column) = (row / inner, row % inner);
            let block = &x[outer * self.length * inner..][..self.length * inner];
            let line = if inner == 1 {
                block
            } else {
                gathered.clear();
                gathered.extend(block[column..].iter().step_by(inner));
                &gathered[..]
            };
            let best = match self.largest {
                true => candidates.best(line, |a: T, b: T| a.key() > b.key()),
                false => candidates.best(line, |a: T, b: T| a.key() < b.key()),
            };
            for (rank, &(value, i)) in best.iter().enumerate() {
                let to = (outer * self.k + rank) * inner + column;
                values[to] = value;
                positions[to] = i as i64;
            }
        }
    }
}

/// The best elements so far of a line, with their indices.
struct Candidates<T> {
    k: usize,
    list: Vec<(T, usize)>,
}

impl<T: Ranked> Candidates<T> {
    fn new(k: usize, length: usize) -> Self {
        // Half of the list is discarded at a time.
        Self { k, list: Vec::with_capacity((2 * k).max(2 * BLOCK).min(length) + BLOCK) }
    }

    /// Returns the `k` best elements of `line`, best first; the lower index comes first where elements are equal.
    fn best(&mut self, line: &[T], is_better: impl Fn(T, T) -> bool) -> &[(T, usize)] {
        let by_rank = |a: &(T, usize), b: &(T, usize)| match (is_better(a.0, b.0), is_better(b.0, a.0)) {
            (true, _) => Ordering::Less,
            (_, true) => Ordering::Greater,
            _ => a.1.cmp(&b.1),
        };
        let k = self.k;
        let most = (2 * k).max(2 * BLOCK);
        self.list.clear();
        // The worst of the best `k` elements so far: a later element must be better.
        let mut worst = None;
        for (number, block) in line.chunks(BLOCK).enumerate() {
            let first = number * BLOCK;
            match worst {
                Some(worst) if !block.iter().fold(false, |any, &x| any | is_better(x, worst)) => continue,
                Some(worst) => {
                    let better = block.iter().enumerate().filter(|(_, x)| is_better(**x, worst));
                    self.list.extend(better.map(|(i, &x)| (x, first + i)));
                }
                None => self.list.extend(block.iter().enumerate().map(|(i, &x)| (x, first + i))),
            }
            if self.list.len() >= most {
                self.list.select_nth_unstable_by(k - 1, by_rank);
                self.list.truncate(k);
                worst = self.list.last().map(|last| last.0);
            }
        }
        if self.list.len() > k {
            self.list.select_nth_unstable_by(k - 1, by_rank);
            self.list.truncate(k);
        }
        self.list.sort_unstable_by(by_rank);
        &self.list
    }
}
