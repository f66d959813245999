//! Matrix products.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{Convolution, Filters, Finish, Matrix, MatrixMut, Product, Strides, Window};
use opendr_onnx::proto::NodeProto;

use super::elementwise::{Function, combine};
use super::inputs::{optional, required};
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::graph::Packed;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};

pub(crate) fn matmul(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let (a, b) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    let (a, b) = (planner.plain(a)?, planner.plain(b)?);
    if planner.kind(a) != Kind::F32 || planner.kind(b) != Kind::F32 {
        return Err(node.refused("elements that are not floats"));
    }
    let (mut left, mut right) = (planner.shape(a), planner.shape(b));
    if left.is_empty() || right.is_empty() {
        return Err(node.damaged("a product of scalars"));
    }
    let (vector_left, vector_right) = (left.len() == 1, right.len() == 1);
    if vector_left {
        left.insert(0, 1);
    }
    if vector_right {
        right.push(1);
    }
    let (rows, depth, columns) = (left[left.len() - 2], left[left.len() - 1], right[right.len() - 1]);
    if right[right.len() - 2] != depth {
        return Err(node.damaged(&format!("shapes {left:?} and {right:?}")));
    }
    let outer_left = left[..left.len() - 2].to_vec();
    let outer_right = right[..right.len() - 2].to_vec();
    let outer = super::elementwise::broadcast_shape(node, &[outer_left.clone(), outer_right.clone()])?;
    let mut shape = outer.clone();
    if !vector_left {
        shape.push(rows);
    }
    if !vector_right {
        shape.push(columns);
    }
    count(&shape)?;
    if let Some(constant) = planner.constant(b).filter(|_| right.len() == 2 && depth > 0 && columns > 0) {
        let all_rows = count(&outer_left)? * rows;
        let y = with_weights(planner, node, a, &constant, [all_rows, depth, columns], false, None, shape)?;
        return Ok(vec![y]);
    }
    let batch = count(&outer)?;
    let offsets = |own: &[usize], size: usize| -> Vec<usize> {
        let strides = crate::remap::strides(own);
        let missing = outer.len() - own.len();
        let offset = |mut index: usize| {
            let mut at = 0;
            for d in (0..outer.len()).rev() {
                if d >= missing && own[d - missing] != 1 {
                    at += index % outer[d] * strides[d - missing];
                }
                index /= outer[d];
            }
            at * size
        };
        (0..batch).map(offset).collect()
    };
    let step = ProductStep {
        sizes: [rows, depth, columns],
        left: offsets(&outer_left, rows * depth),
        right: offsets(&outer_right, depth * columns),
    };
    Ok(vec![planner.emit_one(step, &[a, b], Kind::F32, shape, Layout::Plain)?])
}

/// Multiplies rows by constant weights, which are packed once.
#[expect(clippy::too_many_arguments, reason = "sizes and names of one product")]
fn with_weights(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    a: Id,
    weights: &Constant,
    [rows, depth, columns]: [usize; 3],
    transposed: bool,
    bias: Option<&[f32]>,
    shape: Vec<usize>,
) -> Result<Id> {
    let floats = weights.floats().ok_or_else(|| node.refused("weights that are not floats"))?;
    let compute = planner.compute.clone();
    let filters = planner.packed(3, || {
        Packed::Dense(Arc::new(Filters::from_matrix(&compute, floats, [depth, columns], transposed, bias)))
    });
    let Packed::Dense(filters) = filters else { return Err(node.refused("weights of two kinds")) };
    let input = [1, rows];
    let window =
        Window { kernel: [1, 1], strides: [1, 1], dilations: [1, 1], pads: [0, 0], input, output: input };
    let y = Strides::channels_last(input, columns);
    let x = Strides::channels_last(input, depth);
    let conv = Convolution { filters, window, batch: 1, x, y, residual: y, finish: Finish::default() };
    planner.emit_one(RowsStep(conv), &[a], Kind::F32, shape, Layout::Plain)
}

struct RowsStep(Convolution);

impl Kernel for RowsStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        self.0.run(io.compute, x, None, io.write());
        Ok(())
    }
}

struct ProductStep {
    sizes: [usize; 3],
    left: Vec<usize>,
    right: Vec<usize>,
}

impl Kernel for ProductStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let [rows, depth, columns] = self.sizes;
        let (a, b, y) = (io.read::<f32>(0), io.read::<f32>(1), io.write::<f32>());
        for ((y, &a_at), &b_at) in y.chunks_mut((rows * columns).max(1)).zip(&self.left).zip(&self.right) {
            let a = Matrix::new(&a[a_at..a_at + rows * depth], rows, depth);
            let b = Matrix::new(&b[b_at..b_at + depth * columns], depth, columns);
            Product::new().run(io.compute, a, b, MatrixMut::new(y, rows, columns));
        }
        Ok(())
    }
}

pub(crate) fn gemm(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let (a, b) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    let a = planner.plain(a)?;
    let constant = planner.known(node, b)?;
    let (alpha, beta) = (node.float("alpha", 1.0), node.float("beta", 1.0));
    if alpha != 1.0 || node.int_or("transA", 0) != 0 || planner.kind(a) != Kind::F32 {
        return Err(node.refused("its factor, or a transposed first matrix"));
    }
    let transposed = node.int_or("transB", 0) != 0;
    let (&[rows, depth], &[first, second]) = (planner.shape(a).as_slice(), constant.shape.as_slice()) else {
        return Err(node.damaged("matrices have two dimensions"));
    };
    let (inner, columns) = if transposed { (second, first) } else { (first, second) };
    if inner != depth || depth == 0 || columns == 0 {
        return Err(node.damaged(&format!("shapes {:?} and {:?}", [rows, depth], constant.shape)));
    }
    let shape = vec![rows, columns];
    let c = optional(inputs, 2).filter(|_| beta != 0.0);
    let bias =
        c.and_then(|c| planner.constant(c)).filter(|bias| beta == 1.0 && bias.shape.last() == Some(&columns));
    let bias = bias.as_ref().and_then(|bias| bias.floats()).filter(|bias| bias.len() == columns);
    let y = with_weights(planner, node, a, &constant, [rows, depth, columns], transposed, bias, shape)?;
    match c.filter(|_| bias.is_none()) {
        Some(_) if beta != 1.0 => Err(node.refused("attribute \"beta\"")),
        Some(c) => Ok(vec![combine(planner, node, Function::Add, y, c)?]),
        None => Ok(vec![y]),
    }
}
