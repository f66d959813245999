//! Positions of the elements that are not zero.

use opendr_engine::Result;
use opendr_kernels::Number;
use opendr_onnx::proto::NodeProto;

use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::remap::strides;
use crate::tensor::Kind;

pub(crate) fn non_zero(node: &NodeProto, inputs: &[Option<&Constant>]) -> Result<Vec<Constant>> {
    let [Some(x)] = inputs else { return Err(node.damaged("it has one input")) };
    match x.kind {
        Kind::F32 => found(x, |x: f32| x != 0.0),
        Kind::I64 => found(x, |x: i64| x != 0),
        Kind::I32 => found(x, |x: i32| x != 0),
        Kind::F16 => found(x, |x: u16| x & 0x7fff != 0),
        Kind::U8 | Kind::I8 | Kind::Bool => found(x, |x: u8| x != 0),
    }
    .map(|found| vec![found])
}

/// Returns the indices of the elements, a row for each dimension.
fn found<T: Number>(x: &Constant, is_set: impl Fn(T) -> bool) -> Result<Constant> {
    let dims = if x.shape.is_empty() { &[1][..] } else { &x.shape };
    let elements = x.numbers::<T>();
    let count = elements.iter().filter(|element| is_set(**element)).count();
    let mut found = Constant::zeros(Kind::I64, vec![dims.len(), count])?;
    let rows = found.numbers_mut::<i64>();
    let (rows, last) = rows.split_at_mut((dims.len() - 1) * count);
    let places = elements.iter().enumerate().filter(|(_, element)| is_set(**element));
    last.iter_mut().zip(places).for_each(|(to, (place, _))| *to = place as i64);
    if count == 0 {
        return Ok(found);
    }
    let strides = strides(dims);
    for (row, (dim, stride)) in rows.chunks_mut(count).zip(dims.iter().zip(&strides)) {
        row.iter_mut().zip(&*last).for_each(|(to, place)| *to = place / *stride as i64 % *dim as i64);
    }
    let length = dims.last().copied().unwrap_or(1) as i64;
    last.iter_mut().for_each(|place| *place %= length);
    Ok(found)
}
