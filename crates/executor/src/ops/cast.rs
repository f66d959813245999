//! Conversions of element types.

use half::f16;
use opendr_engine::Result;
use opendr_kernels::Number;
use opendr_onnx::proto::NodeProto;

use super::inputs::required;
use crate::attributes::Attributes;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Planner};
use crate::tensor::Kind;

pub(crate) fn cast(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let to = i32::try_from(node.int_or("to", 0)).map_err(|_| node.damaged("attribute \"to\""))?;
    let to = Kind::from_onnx(to, &node.name)?;
    if to == Kind::F16 {
        return Err(node.refused("16-bit floats"));
    }
    Ok(vec![converted(planner, x, to)?])
}

pub(crate) fn cast_like(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let (x, like) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    let to = planner.kind(like);
    if to == Kind::F16 {
        return Err(node.refused("16-bit floats"));
    }
    Ok(vec![converted(planner, x, to)?])
}

pub(super) fn converted(planner: &mut Planner<'_>, x: Id, to: Kind) -> Result<Id> {
    let value = planner.value(x).clone();
    if value.kind == to {
        return Ok(x);
    }
    planner.emit_one(CastStep { from: value.kind, to }, &[x], to, value.shape, value.layout)
}

struct CastStep {
    from: Kind,
    to: Kind,
}

impl Kernel for CastStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        match self.from {
            Kind::F32 => self.write(io, |x: f32| (f64::from(x), x as i64)),
            Kind::I64 => self.write(io, |x: i64| (x as f64, x)),
            Kind::I32 => self.write(io, |x: i32| (f64::from(x), i64::from(x))),
            Kind::U8 | Kind::Bool => self.write(io, |x: u8| (f64::from(x), i64::from(x))),
            Kind::I8 => self.write(io, |x: i8| (f64::from(x), i64::from(x))),
            Kind::F16 => self.write(io, |x: u16| {
                let x = f16::from_bits(x).to_f32();
                (f64::from(x), x as i64)
            }),
        }
        Ok(())
    }
}

impl CastStep {
    fn write<T: Number>(&self, io: &mut Io<'_>, read: impl Fn(T) -> (f64, i64)) {
        let x = io.read::<T>(0);
        match self.to {
            Kind::F32 => io.write::<f32>().iter_mut().zip(x).for_each(|(y, &x)| *y = read(x).0 as f32),
            Kind::I64 => io.write::<i64>().iter_mut().zip(x).for_each(|(y, &x)| *y = read(x).1),
            Kind::I32 => io.write::<i32>().iter_mut().zip(x).for_each(|(y, &x)| *y = read(x).1 as i32),
            Kind::U8 => io.write::<u8>().iter_mut().zip(x).for_each(|(y, &x)| *y = read(x).1 as u8),
            Kind::I8 => io.write::<i8>().iter_mut().zip(x).for_each(|(y, &x)| *y = read(x).1 as i8),
            Kind::Bool => {
                io.write::<u8>().iter_mut().zip(x).for_each(|(y, &x)| *y = u8::from(read(x).0 != 0.0))
            }
            Kind::F16 => {}
        }
    }
}
