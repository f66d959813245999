//! The largest or smallest elements along an axis.

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
