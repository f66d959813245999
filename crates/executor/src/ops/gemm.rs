//! Products of two matrices with a sum.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::elementwise::{Function, combine};
use super::inputs::{optional, required};
use super::matmul::{Weights, multiply, with_weights};
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::planner::{Id, Layout, Planner};
use crate::remap::transposed;
use crate::tensor::Kind;

pub(crate) fn build(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let (a, b) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    let (alpha, beta) = (node.float("alpha", 1.0), node.float("beta", 1.0));
    if planner.kind(a) != Kind::F32 || planner.kind(b) != Kind::F32 {
        return Err(node.refused("elements that are not floats"));
    }
    if planner.rank(a) != 2 || planner.rank(b) != 2 {
        return Err(node.damaged("matrices have two dimensions"));
    }
    let a = if node.int_or("transA", 0) != 0 { flipped(planner, a)? } else { planner.plain(a)? };
    let c = optional(inputs, 2).filter(|_| beta != 0.0);
    let is_transposed = node.int_or("transB", 0) != 0;
    let weights = planner.constant(b).filter(|b| alpha == 1.0 && !b.shape.contains(&0));
    let Some(weights) = weights else {
        let b = if is_transposed { flipped(planner, b)? } else { planner.plain(b)? };
        let product = multiply(planner, node, [a, b], 0, false)?;
        let product = scaled(planner, node, product, alpha)?;
        return sum(planner, node, product, c, beta);
    };
    let (&[rows, depth], &[first, second]) = (planner.shape(a).as_slice(), weights.shape.as_slice()) else {
        return Err(node.damaged("matrices have two dimensions"));
    };
    let (inner, columns) = if is_transposed { (second, first) } else { (first, second) };
    if inner != depth {
        return Err(node.damaged(&format!("shapes {:?} and {:?}", [rows, depth], weights.shape)));
    }
    let shape = vec![rows, columns];
    let bias =
        c.and_then(|c| planner.constant(c)).filter(|bias| beta == 1.0 && bias.shape.last() == Some(&columns));
    let bias = bias.as_ref().and_then(|bias| bias.floats()).filter(|bias| bias.len() == columns);
    let sizes = [rows, depth, columns];
    let is_last = c.is_none() || bias.is_some();
    let weights = Weights { constant: &weights, is_transposed, bias, product: 0, is_last };
    let product = with_weights(planner, node, a, &weights, sizes, shape)?;
    sum(planner, node, product, c.filter(|_| bias.is_none()), beta)
}

/// Adds a multiple of a matrix, if there is one.
fn sum(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    product: Id,
    c: Option<Id>,
    beta: f32,
) -> Result<Vec<Id>> {
    let Some(c) = c else { return Ok(vec![product]) };
    let c = scaled(planner, node, c, beta)?;
    let sum = combine(planner, node, Function::Add, product, c)?;
    if planner.shape(sum) != planner.shape(product) {
        return Err(node.damaged("the sum is larger than the product"));
    }
    Ok(vec![sum])
}

fn scaled(planner: &mut Planner<'_>, node: &NodeProto, x: Id, factor: f32) -> Result<Id> {
    if factor == 1.0 {
        return Ok(x);
    }
    let factor = planner.add_constant(Constant::from_floats(Vec::new(), &[factor]));
    combine(planner, node, Function::Mul, x, factor)
}

/// Transposes a matrix.
fn flipped(planner: &mut Planner<'_>, x: Id) -> Result<Id> {
    let x = planner.plain(x)?;
    let (dims, kind) = (planner.shape(x), planner.kind(x));
    let shape = dims.iter().rev().copied().collect();
    planner.emit_one(transposed(&dims, &[1, 0], kind.bytes()), &[x], kind, shape, Layout::Plain)
}
