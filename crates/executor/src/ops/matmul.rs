//! Products of matrices and stacks of them.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_kernels::{Convolution, Filters, LayerCost, Matrix, MatrixMut, Product, Strides, Window};
use opendr_onnx::proto::NodeProto;

use super::conv::{ConvStep, finish};
use super::fusion::{self, Fused, Fusible};
use super::inputs::required;
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::graph::Packed;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::remap::transposed;
use crate::tensor::{Kind, count};

/// Channels from which on images are multiplied as they lie.
const MANY: usize = 16;

/// Multiplications of a piece of small products.
const PIECE: usize = 1 << 18;

pub(crate) fn matmul(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let (a, b) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    Ok(vec![multiply(planner, node, [a, b], 0, true)?])
}

/// Multiplies matrices, or stacks of them that broadcast. `product` counts the products of the node, the last of
/// which is its output.
pub(super) fn multiply(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    [a, b]: [Id; 2],
    product: u8,
    is_last: bool,
) -> Result<Id> {
    if let Some(product) = along_width(planner, [a, b])? {
        return Ok(product);
    }
    let (a, b) = (planner.plain(a)?, planner.plain(b)?);
    if planner.kind(a) != Kind::F32 || planner.kind(b) != Kind::F32 {
        return Err(node.refused("elements that are not floats"));
    }
    let Shapes { sizes, left, right, shape } = Shapes::of(node, &planner.shape(a), &planner.shape(b))?;
    let [rows, depth, columns] = sizes;
    if let Some(constant) = planner.constant(b).filter(|b| b.shape.len() == 2 && depth > 0 && columns > 0) {
        let all_rows = count(&planner.shape(a))? / depth;
        let weights = Weights { constant: &constant, is_transposed: false, bias: None, product, is_last };
        return with_weights(planner, node, a, &weights, [all_rows, depth, columns], shape);
    }
    let (left, right) = (left.offsets(rows * depth), right.offsets(depth * columns));
    batched(planner, [a, b], sizes, [left, right], shape)
}

/// Multiplies rows of images with channels last by a constant matrix, for each channel as they lie.
fn along_width(planner: &mut Planner<'_>, [a, b]: [Id; 2]) -> Result<Option<Id>> {
    let images = if planner.is_channels_last(a) { Some(a) } else { planner.value(a).reshaped };
    let (Some(images), Some(matrix)) = (images, planner.constant(b)) else { return Ok(None) };
    let (&[count, channels, height, width], &[depth, columns]) =
        (planner.value(images).shape.as_slice(), matrix.shape.as_slice())
    else {
        return Ok(None);
    };
    let of_floats = planner.kind(images) == Kind::F32 && matrix.kind == Kind::F32;
    if !of_floats || depth != width || planner.value(a).shape.last() != Some(&width) || channels < MANY {
        return Ok(None);
    }
    let matrix = planner.plain(b)?;
    let left = planner.emit_one(
        transposed(&[depth, columns], &[1, 0], Kind::F32.bytes()),
        &[matrix],
        Kind::F32,
        vec![columns, depth],
        Layout::Plain,
    )?;
    let rows = count * height;
    let step = ProductStep {
        sizes: [columns, width, channels],
        left: vec![0; rows],
        right: (0..rows).map(|row| row * width * channels).collect(),
    };
    let mut shape = planner.shape(a);
    if let Some(last) = shape.last_mut() {
        *last = columns;
    }
    let of_images = vec![count, channels, height, columns];
    let product = planner.emit_one(step, &[left, images], Kind::F32, of_images, Layout::ChannelsLast)?;
    planner.reshaped(product, shape).map(Some)
}

/// Emits products of matrices that begin at these elements of the two values.
pub(super) fn batched(
    planner: &mut Planner<'_>,
    [a, b]: [Id; 2],
    sizes: [usize; 3],
    [left, right]: [Vec<usize>; 2],
    shape: Vec<usize>,
) -> Result<Id> {
    let step = ProductStep { sizes, left, right };
    planner.emit_one(step, &[a, b], Kind::F32, shape, Layout::Plain)
}

/// The shapes of a product of stacks of matrices.
pub(super) struct Shapes {
    /// Rows, depth and columns.
    pub(super) sizes: [usize; 3],
    pub(super) left: Stack,
    pub(super) right: Stack,
    /// The shape of the product.
    pub(super) shape: Vec<usize>,
}

/// A stack of matrices within the stack of the product.
pub(super) struct Stack {
    own: Vec<usize>,
    outer: Vec<usize>,
}

impl Stack {
    /// Returns where the matrix of each product begins, in units of `size`.
    pub(super) fn offsets(&self, size: usize) -> Vec<usize> {
        let Self { own, outer } = self;
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
        (0..outer.iter().product()).map(offset).collect()
    }
}

impl Shapes {
    pub(super) fn of(node: &NodeProto, left: &[usize], right: &[usize]) -> Result<Self> {
        let (mut left, mut right) = (left.to_vec(), right.to_vec());
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
        let outer = super::broadcast::broadcast_shape(node, &[outer_left.clone(), outer_right.clone()])?;
        let mut shape = outer.clone();
        if !vector_left {
            shape.push(rows);
        }
        if !vector_right {
            shape.push(columns);
        }
        count(&shape)?;
        Ok(Self {
            sizes: [rows, depth, columns],
            left: Stack { own: outer_left, outer: outer.clone() },
            right: Stack { own: outer_right, outer },
            shape,
        })
    }
}

/// Constant weights of a product.
pub(super) struct Weights<'a> {
    pub(super) constant: &'a Constant,
    pub(super) is_transposed: bool,
    pub(super) bias: Option<&'a [f32]>,
    /// Number of the product within its node.
    pub(super) product: u8,
    /// Whether the product with the bias is the output of the node, so that what follows can be computed with it.
    pub(super) is_last: bool,
}

/// Multiplies rows by constant weights, which are packed once.
pub(super) fn with_weights(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    a: Id,
    weights: &Weights<'_>,
    [rows, depth, columns]: [usize; 3],
    shape: Vec<usize>,
) -> Result<Id> {
    let &Weights { constant, is_transposed, bias, product, is_last } = weights;
    let floats = constant.floats().ok_or_else(|| node.refused("weights that are not floats"))?;
    let compute = planner.compute.clone();
    let fused = if is_last && shape.last() == Some(&columns) {
        let fusible = Fusible { axis: shape.len() - 1, bias: bias.is_none(), sum: true };
        fusion::after(planner, node, &shape, fusible)
    } else {
        Fused::default()
    };
    let bias = bias.or(fused.bias.as_deref());
    let filters = planner.packed(product, || {
        Packed::Dense(Arc::new(Filters::from_matrix(&compute, floats, [depth, columns], is_transposed, bias)))
    });
    let Packed::Dense(filters) = filters else { return Err(node.refused("weights of two kinds")) };
    let input = [1, rows];
    let window =
        Window { kernel: [1, 1], strides: [1, 1], dilations: [1, 1], pads: [0, 0], input, output: input };
    let y = Strides::channels_last(input, columns);
    let x = Strides::channels_last(input, depth);
    let finish = finish(&fused, |slopes| filters.padded(slopes));
    let conv = Convolution { filters, window, batch: 1, x, y, residual: y, finish };
    let residual = match fused.residual {
        Some(residual) => Some(planner.plain(residual)?),
        None => None,
    };
    let ids =
        planner.emit(ConvStep::new(conv), &[Some(a), residual], &[(Kind::F32, shape, Layout::Plain)])?;
    let y = ids.first().copied().ok_or_else(|| node.damaged("its outputs"))?;
    fused.absorb(planner, y);
    Ok(y)
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
        let product = |at: usize, y: &mut [f32]| {
            let (a_at, b_at) = (self.left[at], self.right[at]);
            let a = Matrix::new(&a[a_at..a_at + rows * depth], rows, depth);
            let b = Matrix::new(&b[b_at..b_at + depth * columns], depth, columns);
            Product::new().run(io.compute, a, b, MatrixMut::new(y, rows, columns));
        };
        let length = (rows * columns).max(1);
        // Small products run side by side, as many in a piece as are worth a thread; large ones use all threads themselves.
        let at_once = PIECE / (length * depth).max(1);
        let work = |piece: usize, y: &mut [f32]| {
            let products = y.chunks_mut(length).enumerate();
            products.for_each(|(at, y)| product(piece * at_once + at, y));
        };
        if at_once > 0 && self.left.len() > at_once {
            io.compute.pool().run_on_pieces(y, at_once * length, work);
        } else {
            work(0, y);
        }
        Ok(())
    }

    fn cost(&self) -> LayerCost {
        LayerCost::floats(&self.sizes) * self.left.len()
    }
}
