//! Matrix products.

use opendr_engine::{Error, Result};

use super::activation::Epilogue;
use crate::tensorflow::call::Call;
use crate::tensorflow::layout::Order;
use crate::tensorflow::lowering::Lowering;
use crate::tensorflow::value::Value;
use opendr_onnx::{Dim, ElementType, GraphTensor, Operator};

/// Converts `MatMul` of two matrices, and `_FusedMatMul` with bias and activation.
pub fn matmul(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let epilogue = Epilogue::of(call)?;
    let (a, b) = (call.input(0)?, call.input(1)?);
    let kind = a.kind();
    if a.rank() != 2 || b.rank() != 2 {
        return Err(Error::format(format!(
            "a matrix product of ranks {} and {} is not possible",
            a.rank(),
            b.rank()
        )));
    }
    let a = operand(ctx, a, call.attr().flag("transpose_a"))?;
    let b = operand(ctx, b, call.attr().flag("transpose_b"))?;
    let dims = [a.dims()[0], b.dims()[1]];
    check_inner(a.dims()[1], b.dims()[0])?;
    let product = match &epilogue.bias {
        Some(bias) if bias.rank() <= 1 => {
            ctx.emit_plain(call, Operator::new("Gemm"), &[&a, &b, &bias.wire], ElementType::Float, &dims)?
        }
        _ => {
            let product =
                ctx.emit_plain(call, Operator::new("MatMul"), &[&a, &b], ElementType::Float, &dims)?;
            epilogue.add_bias(ctx, call, product)?
        }
    };
    let product = epilogue.activate(ctx, call, product)?;
    Ok(vec![Value::plain(ctx.cast(&product.wire, kind)?)])
}

pub fn batch_matmul(ctx: &mut Lowering, call: &Call) -> Result<Vec<Value>> {
    let (a, b) = (call.input(0)?, call.input(1)?);
    let (kind, rank) = (a.kind(), a.rank().max(b.rank()));
    if a.rank() < 2 || b.rank() < 2 {
        return Err(Error::format(format!(
            "a matrix product of ranks {} and {} is not possible",
            a.rank(),
            b.rank()
        )));
    }
    let a = operand(ctx, a, call.attr().flag("adj_x"))?;
    let b = operand(ctx, b, call.attr().flag("adj_y"))?;
    check_inner(a.dims()[a.rank() - 1], b.dims()[b.rank() - 2])?;
    let outer = |wire: &GraphTensor, axis: usize| {
        (axis + wire.rank()).checked_sub(rank).map_or(Some(1), |i| wire.dims()[i])
    };
    let batch = |axis: usize| match (outer(&a, axis), outer(&b, axis)) {
        (Some(1), other) | (other, _) => other,
    };
    let mut dims: Vec<Dim> = (0..rank - 2).map(batch).collect();
    dims.extend([a.dims()[a.rank() - 2], b.dims()[b.rank() - 1]]);
    let product = ctx.emit_plain(call, Operator::new("MatMul"), &[&a, &b], ElementType::Float, &dims)?;
    Ok(vec![Value::plain(ctx.cast(&product.wire, kind)?)])
}

/// Returns a matrix, or one per batch element, transposed where requested. Runtimes multiply floats only.
fn operand(ctx: &mut Lowering, x: &Value, transposed: bool) -> Result<GraphTensor> {
    let mut perm: Vec<usize> = (0..x.rank()).collect();
    if transposed {
        perm.swap(x.rank() - 2, x.rank() - 1);
    }
    let value = Value::new(x.wire.clone(), x.order.transposed(&perm));
    let wire = ctx.ordered(&value, &Order::plain(x.rank()))?;
    ctx.cast(&wire, ElementType::Float)
}

fn check_inner(columns: Dim, rows: Dim) -> Result<()> {
    match (columns, rows) {
        (Some(columns), Some(rows)) if columns != rows => Err(Error::format(format!(
            "a matrix of {columns} columns cannot be multiplied by one of {rows} rows"
        ))),
        _ => Ok(()),
    }
}
