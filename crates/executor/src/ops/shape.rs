//! Operators that change or compute shapes: none of them computes in a run.

use opendr_engine::Result;
use opendr_onnx::proto::NodeProto;

use super::inputs::{axis, list, optional, required};
use super::movement::sizes;
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::planner::{Id, Planner};
use crate::tensor::{Kind, count};

pub(crate) fn identity(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    if optional(inputs, 2).is_some_and(|training| {
        planner.constant(training).is_none_or(|flag| flag.data.get::<u8>(flag.region()) != [0])
    }) {
        return Err(node.refused("training mode"));
    }
    Ok(vec![required(node, inputs, 0)?])
}

fn reshaped(planner: &mut Planner<'_>, node: &NodeProto, x: Id, shape: Vec<usize>) -> Result<Vec<Id>> {
    if count(&shape)? != count(&planner.shape(x))? {
        return Err(node.damaged(&format!("{:?} does not become {shape:?}", planner.shape(x))));
    }
    Ok(vec![planner.reshaped(x, shape)?])
}

pub(crate) fn reshape(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let wanted = list(planner, node, inputs, "shape", 1)?.ok_or_else(|| node.damaged("no shape"))?;
    let keep_zero = node.int_or("allowzero", 0) != 0;
    let mut shape = Vec::new();
    let mut open = None;
    for (index, &size) in wanted.iter().enumerate() {
        shape.push(match size {
            -1 if open.is_none() => {
                open = Some(index);
                1
            }
            0 if !keep_zero => {
                *dims.get(index).ok_or_else(|| node.damaged("a dimension that is not there"))?
            }
            _ => usize::try_from(size).map_err(|_| node.damaged(&format!("shape {wanted:?}")))?,
        });
    }
    if let Some(open) = open {
        let known = count(&shape)?;
        let all = count(&dims)?;
        shape[open] = all.checked_div(known).unwrap_or(0);
    }
    reshaped(planner, node, x, shape)
}

pub(crate) fn flatten(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let along = axis(node, node.int_or("axis", 1), dims.len() + 1)?;
    let along = if node.int_or("axis", 1) < 0 { along.saturating_sub(1) } else { along };
    let shape = vec![dims[..along].iter().product(), dims[along..].iter().product()];
    reshaped(planner, node, x, shape)
}

pub(crate) fn squeeze(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let gone = match list(planner, node, inputs, "axes", 1)? {
        Some(axes) => axes.iter().map(|&along| axis(node, along, dims.len())).collect::<Result<Vec<_>>>()?,
        None => (0..dims.len()).filter(|&d| dims[d] == 1).collect(),
    };
    let shape = (0..dims.len()).filter(|d| !gone.contains(d)).map(|d| dims[d]).collect();
    reshaped(planner, node, x, shape)
}

pub(crate) fn unsqueeze(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let dims = planner.shape(x);
    let axes = list(planner, node, inputs, "axes", 1)?.ok_or_else(|| node.damaged("no axes"))?;
    let rank = dims.len() + axes.len();
    let axes = axes.iter().map(|&along| axis(node, along, rank)).collect::<Result<Vec<_>>>()?;
    let mut rest = dims.iter().copied();
    let shape: Vec<usize> =
        (0..rank).map(|d| if axes.contains(&d) { 1 } else { rest.next().unwrap_or(1) }).collect();
    reshaped(planner, node, x, shape)
}

pub(crate) fn shape(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let dims = planner.shape(required(node, inputs, 0)?);
    let rank = dims.len() as i64;
    let clamp = |at: i64| (if at < 0 { at.saturating_add(rank) } else { at }).clamp(0, rank) as usize;
    let (start, end) = (clamp(node.int_or("start", 0)), clamp(node.int_or("end", rank)));
    let values: Vec<i64> = dims[start.min(end)..end].iter().map(|&dim| dim as i64).collect();
    Ok(vec![planner.add_size(Constant::from_ints(vec![values.len()], &values))])
}

pub(crate) fn size(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let elements = count(&planner.shape(required(node, inputs, 0)?))?;
    Ok(vec![planner.add_size(Constant::from_ints(Vec::new(), &[elements as i64]))])
}

pub(crate) fn constant(planner: &mut Planner<'_>, node: &NodeProto, _: &[Option<Id>]) -> Result<Vec<Id>> {
    let constant = if let Some(tensor) = node.find("value").and_then(|attribute| attribute.t.as_ref()) {
        Constant::from_tensor(tensor.clone())?
    } else if let Some(value) = node.find("value_float") {
        Constant::from_floats(Vec::new(), &[value.f])
    } else if let Some(value) = node.find("value_floats") {
        Constant::from_floats(vec![value.floats.len()], &value.floats)
    } else if let Some(value) = node.find("value_int") {
        Constant::from_ints(Vec::new(), &[value.i])
    } else if let Some(value) = node.find("value_ints") {
        Constant::from_ints(vec![value.ints.len()], &value.ints)
    } else {
        return Err(node.refused("this kind of constant"));
    };
    Ok(vec![planner.add_constant(constant)])
}

pub(crate) fn constant_of_shape(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let shape = sizes(node, &planner.ints(node, required(node, inputs, 0)?)?)?;
    let value = match node.find("value").and_then(|attribute| attribute.t.as_ref()) {
        Some(tensor) => Constant::from_tensor(tensor.clone())?,
        None => Constant::from_floats(vec![1], &[0.0]),
    };
    if count(&value.shape)? != 1 {
        return Err(node.damaged("attribute \"value\" must have one element"));
    }
    let value = planner.add_constant(Constant { shape: vec![1; shape.len()], ..value });
    super::movement::repeated(planner, value, shape).map(|id| vec![id])
}

pub(crate) fn range(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let ids = [0, 1, 2].map(|slot| required(node, inputs, slot));
    let [start, limit, delta] = ids;
    let (start, limit, delta) = (start?, limit?, delta?);
    if planner.kind(start) == Kind::F32 {
        let number = |id| match planner.known(node, id)?.floats() {
            Some(&[number]) => Ok(number),
            _ => Err(node.damaged("its bounds")),
        };
        let (start, limit, delta) = (number(start)?, number(limit)?, number(delta)?);
        let length = ((f64::from(limit) - f64::from(start)) / f64::from(delta)).ceil().max(0.0);
        if !length.is_finite() || length > f64::from(1 << 24) {
            return Err(node.damaged("the range is too long"));
        }
        let values: Vec<f32> = (0..length as usize).map(|i| start + i as f32 * delta).collect();
        return Ok(vec![planner.add_constant(Constant::from_floats(vec![values.len()], &values))]);
    }
    let number = |id| planner.ints(node, id)?.first().copied().ok_or_else(|| node.damaged("an empty bound"));
    let (start, limit, delta) = (number(start)?, number(limit)?, number(delta)?);
    if delta == 0 {
        return Err(node.damaged("a step of 0"));
    }
    let span = i128::from(limit) - i128::from(start);
    let length = if (span > 0) == (delta > 0) {
        span.unsigned_abs().div_ceil(u128::from(delta.unsigned_abs()))
    } else {
        0
    };
    if length > 1 << 24 {
        return Err(node.damaged("the range is too long"));
    }
    let values: Vec<i64> = (0..length as i64).map(|i| start.wrapping_add(i.wrapping_mul(delta))).collect();
    let kind = planner.kind(required(node, inputs, 0)?);
    let constant = if kind == Kind::I32 {
        let values: Vec<i32> = values.iter().map(|&value| value as i32).collect();
        Constant::of(kind, vec![values.len()], &values)
    } else {
        Constant::from_ints(vec![values.len()], &values)
    };
    Ok(vec![planner.add_constant(constant)])
}
