//! Sums of products over named axes.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::inputs::required;
use super::matmul::multiply;
use super::reduce::sum_runs;
use crate::attributes::Attributes;
use crate::planner::{Id, Layout, Planner};
use crate::remap::{Axis, Remap, strides};
use crate::tensor::{Kind, count};

/// An axis: a letter, or a dimension of an ellipsis counted from the last.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Label {
    Ellipsis(u8),
    Letter(char),
}

/// A value with the names of its axes.
struct Operand {
    id: Id,
    labels: Vec<Label>,
}

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let equation: String =
        node.text("equation", "").chars().filter(|letter| !letter.is_whitespace()).collect();
    let (left, right) = match equation.split_once("->") {
        Some((left, right)) => (left, Some(right)),
        None => (equation.as_str(), None),
    };
    let terms: Vec<&str> = left.split(',').collect();
    if terms.len() != inputs.len() {
        return Err(node.damaged(&format!("equation {equation:?} for {} inputs", inputs.len())));
    }
    let damaged = || node.damaged(&format!("equation {equation:?}"));
    let mut operands = Vec::new();
    let mut sizes: Vec<(Label, usize)> = Vec::new();
    for (slot, term) in terms.iter().enumerate() {
        let id = required(node, inputs, slot)?;
        let id = planner.plain(id)?;
        let dims = planner.shape(id);
        let labels = labels(term, Some(dims.len())).ok_or_else(damaged)?;
        if labels.len() != dims.len() {
            return Err(damaged());
        }
        for (&label, &dim) in labels.iter().zip(&dims) {
            match sizes.iter_mut().find(|(other, _)| *other == label) {
                Some((_, size)) if *size == dim || dim == 1 => {}
                Some((_, size)) if *size == 1 => *size = dim,
                Some(_) => return Err(node.damaged(&format!("an axis of two sizes in {equation:?}"))),
                None => sizes.push((label, dim)),
            }
        }
        operands.push(Operand { id, labels });
    }
    let result = match right {
        Some(right) => {
            // The ellipsis of the result has the axes of all others.
            let ellipsis = sizes.iter().filter(|(label, _)| matches!(label, Label::Ellipsis(_))).count();
            let letters = right.chars().filter(|letter| *letter != '.').count();
            let rank = letters + if right.contains('.') { ellipsis } else { 0 };
            labels(right, Some(rank)).ok_or_else(damaged)?
        }
        None => implied(&operands),
    };
    let is_known = |label: &Label| sizes.iter().any(|(other, _)| other == label);
    let is_twice = result.iter().enumerate().any(|(at, label)| result[..at].contains(label));
    if !result.iter().all(is_known) || is_twice {
        return Err(damaged());
    }
    let sum = Sum { node, sizes };
    let mut rest = operands.into_iter();
    let mut product = rest.next().ok_or_else(damaged)?;
    let rest: Vec<Operand> = rest.collect();
    for (at, next) in rest.iter().enumerate() {
        let later = rest[at + 1..].iter().flat_map(|operand| &operand.labels);
        let needed: Vec<Label> = result.iter().chain(later).copied().collect();
        let number = u8::try_from(at).map_err(|_| node.refused("more than 256 inputs"))?;
        product = sum.contracted(planner, [&product, next], &needed, number)?;
    }
    Ok(vec![sum.summed(planner, &product, &result)?.id])
}

/// Returns the labels of a term whose value has `rank` dimensions.
fn labels(term: &str, rank: Option<usize>) -> Option<Vec<Label>> {
    let (before, after) = match term.split_once("...") {
        Some((before, after)) => (before, Some(after)),
        None => (term, None),
    };
    let letters = |part: &str| -> Option<Vec<Label>> {
        part.chars().map(|letter| letter.is_ascii_alphabetic().then_some(Label::Letter(letter))).collect()
    };
    let mut all = letters(before)?;
    if let Some(after) = after {
        let after = letters(after)?;
        let hidden = u8::try_from(rank?.checked_sub(all.len() + after.len())?).ok()?;
        all.extend((0..hidden).rev().map(Label::Ellipsis));
        all.extend(after);
    }
    Some(all)
}

/// Returns the labels of the result that an equation without one has: those that occur once, in alphabetical order.
fn implied(operands: &[Operand]) -> Vec<Label> {
    let all: Vec<Label> = operands.iter().flat_map(|operand| &operand.labels).copied().collect();
    let mut ellipsis: Vec<Label> =
        all.iter().filter(|label| matches!(label, Label::Ellipsis(_))).copied().collect();
    ellipsis.sort_unstable_by(|a, b| b.cmp(a));
    ellipsis.dedup();
    let once = |label: &&Label| all.iter().filter(|other| other == label).count() == 1;
    let mut letters: Vec<Label> =
        all.iter().filter(|label| matches!(label, Label::Letter(_))).filter(once).copied().collect();
    letters.sort_unstable();
    [ellipsis, letters].concat()
}

/// The sizes of the axes.
struct Sum<'a> {
    node: &'a NodeProto,
    sizes: Vec<(Label, usize)>,
}

impl Sum<'_> {
    fn size(&self, label: Label) -> usize {
        self.sizes.iter().find(|(other, _)| *other == label).map_or(1, |(_, size)| *size)
    }

    fn shape(&self, labels: &[Label]) -> Vec<usize> {
        labels.iter().map(|&label| self.size(label)).collect()
    }

    /// Orders the axes of an operand: repeated ones become their diagonal, and those of size 1 are repeated where others are longer.
    fn ordered(&self, planner: &mut Planner<'_>, operand: &Operand, labels: &[Label]) -> Result<Id> {
        let dims = planner.shape(operand.id);
        let shape = self.shape(labels);
        count(&shape)?;
        if operand.labels == labels && shape == dims {
            return Ok(operand.id);
        }
        let strides = strides(&dims);
        let axes = labels.iter().zip(&shape).map(|(label, &length)| {
            let own =
                operand.labels.iter().zip(dims.iter().zip(&strides)).filter(|(other, _)| *other == label);
            // An axis of one element has one place.
            let stride = own.map(|(_, (&dim, &stride))| if dim == 1 { 0 } else { stride }).sum();
            Axis::Strided { length, stride }
        });
        let kind = planner.kind(operand.id);
        let remap = Remap::new(axes.collect(), kind.bytes());
        planner.emit_one(remap, &[operand.id], kind, shape, Layout::Plain)
    }

    /// Sums an operand over the axes that `kept` does not have, and orders the others.
    fn summed(&self, planner: &mut Planner<'_>, operand: &Operand, kept: &[Label]) -> Result<Operand> {
        let mut gone: Vec<Label> = Vec::new();
        for &label in operand.labels.iter().filter(|label| !kept.contains(label)) {
            if !gone.contains(&label) {
                gone.push(label);
            }
        }
        let labels = kept.to_vec();
        let all = [kept, &gone].concat();
        let id = self.ordered(planner, operand, &all)?;
        if gone.is_empty() {
            return Ok(Operand { id, labels });
        }
        if !matches!(planner.kind(id), Kind::F32 | Kind::I64 | Kind::I32) {
            return Err(self.node.refused("sums of its elements"));
        }
        let id = sum_runs(planner, id, count(&self.shape(&gone))?, self.shape(kept))?;
        Ok(Operand { id, labels })
    }

    /// Multiplies two operands, summed over the axes that are not `needed`; `number` counts the products.
    fn contracted(
        &self,
        planner: &mut Planner<'_>,
        [left, right]: [&Operand; 2],
        needed: &[Label],
        number: u8,
    ) -> Result<Operand> {
        let unique = |operand: &Operand, is_used: &dyn Fn(&Label) -> bool| {
            let mut unique: Vec<Label> = Vec::new();
            for &label in operand.labels.iter().filter(|label| is_used(label)) {
                if !unique.contains(&label) {
                    unique.push(label);
                }
            }
            unique
        };
        let in_right = |label: &Label| right.labels.contains(label);
        let in_left = |label: &Label| left.labels.contains(label);
        let batch = unique(left, &|label| in_right(label) && needed.contains(label));
        let depth = unique(left, &|label| in_right(label) && !needed.contains(label));
        let rows = unique(left, &|label| !in_right(label) && needed.contains(label));
        let columns = unique(right, &|label| !in_left(label) && needed.contains(label));
        let a = self.summed(planner, left, &[batch.as_slice(), &rows, &depth].concat())?;
        let b = self.summed(planner, right, &[batch.as_slice(), &depth, &columns].concat())?;
        let size = |labels: &[Label]| count(&self.shape(labels));
        let stack = if batch.is_empty() { None } else { Some(size(&batch)?) };
        let matrix = |sizes: [usize; 2]| stack.into_iter().chain(sizes).collect::<Vec<_>>();
        let a = planner.alias(a.id, matrix([size(&rows)?, size(&depth)?]), Layout::Plain);
        let b = planner.alias(b.id, matrix([size(&depth)?, size(&columns)?]), Layout::Plain);
        let product = multiply(planner, self.node, [a, b], number, false)?;
        let labels = [batch, rows, columns].concat();
        let id = planner.alias(product, self.shape(&labels), Layout::Plain);
        Ok(Operand { id, labels })
    }
}
