//! Conversion of layers that change shapes.

use opendr_engine::{Error, Result};
use opendr_onnx::{Dim, GraphTensor, Operator};

use super::param::Layer;
use super::trace::Trace;

/// Value of an axis that is not present.
const ABSENT: i64 = -233;

/// Converts `Reshape`: width, height, channels, as far as present; 0 keeps an axis, -1 is inferred.
pub fn reshape(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let parameters = &layer.parameters;
    let input = trace.input(layer, 0)?;
    let [width, height, channels] = [0, 1, 2].map(|key| parameters.int(key, ABSENT));
    let (width, height, channels) = (width?, height?, channels?);
    if parameters.has(11) || parameters.int(3, 0)? != 0 {
        return Err(Error::unsupported("a reshape to four axes, or a transposed one, is not supported"));
    }
    let mut shape: Vec<i64> =
        [channels, height, width].into_iter().skip_while(|side| *side == ABSENT).collect();
    if shape.is_empty() || shape.iter().any(|side| *side < -1) {
        return Err(Error::format(format!("invalid shape {shape:?}")));
    }
    let own = &input.dims()[1..];
    // ncnn counts axes from the last one, so that the shapes are aligned at their ends.
    let aligned = own.len() as i64 - shape.len() as i64;
    for (at, side) in shape.iter_mut().enumerate().filter(|(_, side)| **side == 0) {
        let kept =
            usize::try_from(at as i64 + aligned).ok().and_then(|axis| own.get(axis).copied().flatten());
        *side = kept.ok_or_else(|| Error::unsupported("an axis of open size cannot be kept"))? as i64;
    }
    let dims = inferred(&shape, input.dims());
    let shape = GraphTensor::ints([1].into_iter().chain(shape));
    trace.add(layer, Operator::new("Reshape"), &[&input, &shape], dims)
}

/// Returns the sizes of a shape, with -1 replaced where it can be inferred.
fn inferred(shape: &[i64], own: &[Dim]) -> Vec<Dim> {
    let all = own.iter().try_fold(1usize, |count, side| count.checked_mul((*side)?));
    let mut given = shape.iter().filter(|side| **side > 0);
    let given = given.try_fold(1usize, |count, side| count.checked_mul(usize::try_from(*side).ok()?));
    let left = all.zip(given).and_then(|(all, given)| all.checked_div(given));
    let side = |side: &i64| if *side < 0 { left } else { usize::try_from(*side).ok() };
    [Some(1)].into_iter().chain(shape.iter().map(side)).collect()
}

/// Converts `Permute`: ncnn numbers the orders, the fastest axis first.
pub fn permute(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let input = trace.input(layer, 0)?;
    let order: &[i64] = match (input.rank(), layer.parameters.int(0, 0)?) {
        (2, 0) => &[0, 1],
        (3, 0) => &[0, 1, 2],
        (3, 1) => &[0, 2, 1],
        (4, 0) => &[0, 1, 2, 3],
        (4, 1) => &[0, 1, 3, 2],
        (4, 2) => &[0, 2, 1, 3],
        (4, 3) => &[0, 2, 3, 1],
        (4, 4) => &[0, 3, 1, 2],
        (4, 5) => &[0, 3, 2, 1],
        (rank, other) => {
            return Err(Error::unsupported(format!(
                "unsupported order {other} of {} axes",
                rank.saturating_sub(1)
            )));
        }
    };
    let dims = order.iter().map(|axis| input.dims()[*axis as usize]).collect();
    trace.add(layer, Operator::new("Transpose").ints("perm", order.iter().copied()), &[&input], dims)
}

/// Converts `Concat`: along an axis, counted without the batch.
pub fn concat(trace: &mut Trace<'_>, layer: &Layer<'_>) -> Result<GraphTensor> {
    let inputs = (0..layer.inputs.len()).map(|at| trace.input(layer, at)).collect::<Result<Vec<_>>>()?;
    let first = inputs.first().ok_or_else(|| Error::format("it has no inputs"))?;
    let axes = first.rank() - 1;
    let axis = layer.parameters.int(0, 0)?;
    let axis = if axis < 0 { axis + axes as i64 } else { axis };
    let axis = usize::try_from(axis).ok().filter(|axis| *axis < axes).map(|axis| axis + 1);
    let axis = axis.filter(|_| inputs.iter().all(|input| input.rank() == first.rank()));
    let axis = axis.ok_or_else(|| Error::format("the tensors cannot be concatenated along this axis"))?;
    let mut dims = first.dims().to_vec();
    dims[axis] = inputs.iter().try_fold(0usize, |sum, input| sum.checked_add(input.dims()[axis]?));
    let inputs: Vec<_> = inputs.iter().collect();
    trace.add(layer, Operator::new("Concat").int("axis", axis as i64), &inputs, dims)
}

/// Flattens a tensor to `[1, count]`.
pub fn flat(trace: &mut Trace<'_>, layer: &Layer<'_>, input: &GraphTensor) -> Result<GraphTensor> {
    if input.rank() == 2 {
        return Ok(input.clone());
    }
    let count = input.element_count();
    trace.add(layer, Operator::new("Flatten").int("axis", 1), &[input], vec![Some(1), count])
}
