//! Operators that are applied to each element, with broadcasting.

use opendr_engine::Result;
use opendr_kernels::{Binary, Operand, Unary};
use opendr_onnx::proto::NodeProto;

use super::functions;
use super::inputs::{optional, required};
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::{Kind, count};
use crate::value::channels_to_end;

/// Returns the function of a node of one input.
pub(crate) fn unary_of(node: &NodeProto) -> Option<Unary> {
    Some(match node.op_type.as_str() {
        "Abs" => Unary::Abs,
        "Erf" => Unary::Erf,
        "Exp" => Unary::Exp,
        "Gelu" if node.text("approximate", "none") == "none" => Unary::Gelu,
        "HardSigmoid" => {
            Unary::HardSigmoid { alpha: node.float("alpha", 0.2), beta: node.float("beta", 0.5) }
        }
        "HardSwish" => Unary::HardSwish,
        "LeakyRelu" => Unary::LeakyRelu { slope: node.float("alpha", 0.01) },
        "Neg" => Unary::Neg,
        "Reciprocal" => Unary::Reciprocal,
        "Relu" => Unary::Relu,
        "Sigmoid" => Unary::Sigmoid,
        "Sqrt" => Unary::Sqrt,
        "Tanh" => Unary::Tanh,
        _ => return None,
    })
}

struct UnaryStep(Unary);

impl Kernel for UnaryStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<f32>(0);
        self.0.apply(io.compute, x, io.write());
        Ok(())
    }
}

pub(crate) fn unary(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    if node.op_type == "Gelu" && node.text("approximate", "none") == "tanh" {
        return Ok(vec![functions::gelu_by_tanh(planner, node, x)?]);
    }
    let function = unary_of(node).ok_or_else(|| node.refused("its attributes"))?;
    Ok(vec![apply(planner, node, x, function)?])
}

/// Applies a function to a value of floats.
pub(crate) fn apply(planner: &mut Planner<'_>, node: &NodeProto, x: Id, function: Unary) -> Result<Id> {
    let value = planner.value(x).clone();
    if value.kind != Kind::F32 {
        return Err(node.refused(&format!("elements of type {:?}", value.kind)));
    }
    planner.emit_one(UnaryStep(function), &[x], Kind::F32, value.shape, value.layout)
}

/// Returns the bounds of a `Clip`, or of a `Min` or `Max` with a constant.
pub(crate) fn clip_of(planner: &Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Option<Unary> {
    let bound = |slot: usize, key: &str, default: f32| match (node.find(key), optional(inputs, slot)) {
        (Some(attribute), _) => Some(attribute.f),
        (None, Some(id)) => planner.scalar(id),
        (None, None) => Some(default),
    };
    Some(Unary::Clip { low: bound(1, "min", f32::NEG_INFINITY)?, high: bound(2, "max", f32::INFINITY)? })
}

pub(crate) fn clip(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    if planner.kind(x) == Kind::F32
        && let Some(function) = clip_of(planner, node, inputs)
    {
        return Ok(vec![apply(planner, node, x, function)?]);
    }
    let mut y = x;
    for (slot, function) in [(1, Function::Max), (2, Function::Min)] {
        if let Some(bound) = optional(inputs, slot) {
            y = combine(planner, node, function, y, bound)?;
        }
    }
    Ok(vec![y])
}

pub(crate) fn variadic(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    inputs: &[Option<Id>],
) -> Result<Vec<Id>> {
    let mut sum = required(node, inputs, 0)?;
    let function = match node.op_type.as_str() {
        "Sum" | "Mean" => Function::Add,
        "Max" => Function::Max,
        _ => Function::Min,
    };
    for slot in 1..inputs.len() {
        let other = required(node, inputs, slot)?;
        sum = combine(planner, node, function, sum, other)?;
    }
    if node.op_type == "Mean" {
        let count = planner.add_constant(Constant::from_floats(vec![1], &[inputs.len() as f32]));
        sum = combine(planner, node, Function::Div, sum, count)?;
    }
    Ok(vec![sum])
}

/// A function of two elements.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Function {
    Add,
    Sub,
    Mul,
    Div,
    Max,
    Min,
    Pow,
    Mod,
    FloatMod,
    PRelu,
    Equal,
    Less,
    LessOrEqual,
    Greater,
    GreaterOrEqual,
    And,
    Or,
    Xor,
}

pub(crate) fn binary(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let function = match node.op_type.as_str() {
        "Add" => Function::Add,
        "Sub" => Function::Sub,
        "Mul" => Function::Mul,
        "Div" => Function::Div,
        "Pow" => Function::Pow,
        "Mod" if node.int_or("fmod", 0) != 0 => Function::FloatMod,
        "Mod" => Function::Mod,
        "Equal" => Function::Equal,
        "Less" => Function::Less,
        "LessOrEqual" => Function::LessOrEqual,
        "Greater" => Function::Greater,
        "GreaterOrEqual" => Function::GreaterOrEqual,
        "And" => Function::And,
        "Xor" => Function::Xor,
        _ => Function::Or,
    };
    if node.find("axis").is_some() {
        return Err(node.refused("attribute \"axis\" of old models"));
    }
    let (a, b) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    Ok(vec![combine(planner, node, function, a, b)?])
}

pub(crate) fn prelu(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let (a, b) = (required(node, inputs, 0)?, required(node, inputs, 1)?);
    Ok(vec![combine(planner, node, Function::PRelu, a, b)?])
}

/// Returns the shape that several ones broadcast to.
pub(crate) fn broadcast_shape(node: &NodeProto, shapes: &[Vec<usize>]) -> Result<Vec<usize>> {
    let rank = shapes.iter().map(Vec::len).max().unwrap_or(0);
    let mut all = vec![1; rank];
    for shape in shapes {
        for (to, &dim) in all[rank - shape.len()..].iter_mut().zip(shape) {
            match (*to, dim) {
                (_, 1) => {}
                (1, _) => *to = dim,
                (to, dim) if to == dim => {}
                _ => return Err(node.damaged(&format!("shapes {shapes:?} do not broadcast"))),
            }
        }
    }
    count(&all)?;
    Ok(all)
}

/// Brings operands to one layout; returns them with the shape and the layout of the result.
fn aligned(planner: &mut Planner<'_>, node: &NodeProto, ids: &[Id]) -> Result<(Vec<Id>, Vec<usize>, Layout)> {
    let shapes: Vec<Vec<usize>> = ids.iter().map(|&id| planner.shape(id)).collect();
    let shape = broadcast_shape(node, &shapes)?;
    let rank = shape.len();
    let last = rank > 2 && ids.iter().any(|&id| planner.is_channels_last(id) && planner.rank(id) == rank);
    let mut laid = Vec::new();
    for &id in ids {
        laid.push(if !last || shapes.is_empty() {
            planner.plain(id)?
        } else if planner.rank(id) == rank {
            planner.channels_last(id)?
        } else {
            let plain = planner.plain(id)?;
            let mut dims = vec![1; rank - planner.rank(plain)];
            dims.extend(planner.shape(plain));
            let wide = planner.alias(plain, dims, Layout::Plain);
            planner.channels_last(wide)?
        });
    }
    Ok((laid, shape, if last { Layout::ChannelsLast } else { Layout::Plain }))
}

/// Applies a function to two values.
pub(crate) fn combine(
    planner: &mut Planner<'_>,
    node: &NodeProto,
    function: Function,
    a: Id,
    b: Id,
) -> Result<Id> {
    let kind = planner.kind(a);
    if planner.kind(b) != kind && function != Function::Pow {
        return Err(node.damaged(&format!("elements of types {kind:?} and {:?}", planner.kind(b))));
    }
    let b = if planner.kind(b) == kind { b } else { converted(planner, b, kind)? };
    let (ids, shape, layout) = aligned(planner, node, &[a, b])?;
    let truths = matches!(
        function,
        Function::Equal
            | Function::Less
            | Function::LessOrEqual
            | Function::Greater
            | Function::GreaterOrEqual
            | Function::And
            | Function::Or
            | Function::Xor
    );
    let logic = matches!(function, Function::And | Function::Or | Function::Xor);
    let fits = match kind {
        Kind::F32 => !logic,
        Kind::I64 | Kind::I32 => {
            !matches!(function, Function::PRelu | Function::Pow | Function::FloatMod) && !logic
        }
        Kind::Bool => logic || function == Function::Equal,
        Kind::U8 | Kind::I8 => matches!(function, Function::Equal),
        Kind::F16 => false,
    };
    if !fits {
        return Err(node.refused(&format!("elements of type {kind:?}")));
    }
    let physical = if layout == Layout::ChannelsLast { channels_to_end(&shape) } else { shape.clone() };
    let operands: Vec<Vec<usize>> = ids.iter().map(|&id| planner.value(id).physical()).collect();
    let step = BinaryStep { function, kind, rows: Rows::new(&physical, &operands) };
    planner.emit_one(step, &ids, if truths { Kind::Bool } else { kind }, shape, layout)
}

/// Rows of a result, and where they begin in each operand.
#[derive(Debug)]
pub(crate) struct Rows {
    /// Length and strides of the outer dimensions.
    outer: Vec<(usize, Vec<usize>)>,
    pub(crate) length: usize,
    /// Per operand, whether it has a number for each element of a row, or one for all.
    pub(crate) is_row: Vec<bool>,
}

impl Rows {
    pub(crate) fn new(dims: &[usize], operands: &[Vec<usize>]) -> Self {
        let rank = dims.len();
        let strides: Vec<Vec<usize>> = operands
            .iter()
            .map(|shape| {
                let own = crate::remap::strides(shape);
                let missing = rank - shape.len();
                (0..rank)
                    .map(|d| d.checked_sub(missing).filter(|&d| shape[d] != 1).map_or(0, |d| own[d]))
                    .collect()
            })
            .collect();
        let mut merged: Vec<(usize, Vec<usize>)> = Vec::new();
        for (d, &length) in dims.iter().enumerate().filter(|(_, length)| **length != 1) {
            let steps: Vec<usize> = strides.iter().map(|strides| strides[d]).collect();
            match merged.last_mut() {
                Some((outer, outer_steps))
                    if outer_steps.iter().zip(&steps).all(|(outer, step)| *outer == step * length) =>
                {
                    *outer *= length;
                    *outer_steps = steps;
                }
                _ => merged.push((length, steps)),
            }
        }
        let (length, steps) = merged.pop().unwrap_or_else(|| (1, vec![1; operands.len()]));
        Self { outer: merged, length, is_row: steps.iter().map(|&step| step != 0).collect() }
    }

    /// Returns the first element of a row in an operand.
    #[inline]
    pub(crate) fn start(&self, mut row: usize, operand: usize) -> usize {
        let mut at = 0;
        for (length, steps) in self.outer.iter().rev() {
            at += row % length * steps[operand];
            row /= length;
        }
        at
    }

    /// Returns the elements of a row of an operand: as many as the row has, or one.
    #[inline]
    pub(crate) fn of<'a, T>(&self, x: &'a [T], row: usize, operand: usize, length: usize) -> &'a [T] {
        let start = self.start(row, operand);
        &x[start..start + if self.is_row[operand] { length } else { 1 }]
    }
}

struct BinaryStep {
    function: Function,
    kind: Kind,
    rows: Rows,
}

impl Kernel for BinaryStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        use Function::*;
        match (self.kind, self.function) {
            (Kind::F32, Add) => self.fast(io, Binary::Add),
            (Kind::F32, Sub) => self.fast(io, Binary::Sub),
            (Kind::F32, Mul) => self.fast(io, Binary::Mul),
            (Kind::F32, Div) => self.fast(io, Binary::Div),
            (Kind::F32, Max) => self.fast(io, Binary::Max),
            (Kind::F32, Min) => self.fast(io, Binary::Min),
            (Kind::F32, Pow) => self.each(io, |a: f32, b: f32| if b == 2.0 { a * a } else { a.powf(b) }),
            (Kind::F32, FloatMod) => self.each(io, |a: f32, b: f32| a % b),
            (Kind::F32, Mod) => self.each(io, python_remainder),
            (Kind::F32, PRelu) => self.each(io, |x: f32, slope: f32| if x < 0.0 { slope * x } else { x }),
            (Kind::F32, function) => self.each(io, move |a: f32, b: f32| compared(function, &a, &b)),
            (Kind::I64, Equal | Less | LessOrEqual | Greater | GreaterOrEqual) => {
                self.each(io, |a: i64, b: i64| compared(self.function, &a, &b));
            }
            (Kind::I32, Equal | Less | LessOrEqual | Greater | GreaterOrEqual) => {
                self.each(io, |a: i32, b: i32| compared(self.function, &a, &b));
            }
            (Kind::I64, function) => self.each(io, move |a: i64, b: i64| integer(function, a, b)),
            (Kind::I32, function) => {
                self.each(io, move |a: i32, b: i32| integer(function, a.into(), b.into()) as i32);
            }
            (_, And) => self.each(io, |a: u8, b: u8| a & b),
            (_, Or) => self.each(io, |a: u8, b: u8| a | b),
            (_, Xor) => self.each(io, |a: u8, b: u8| a ^ b),
            (_, function) => self.each(io, move |a: u8, b: u8| compared(function, &a, &b)),
        }
        Ok(())
    }
}

/// The remainder with the sign of the divisor, as in Python.
fn python_remainder(a: f32, b: f32) -> f32 {
    let rest = a % b;
    if rest == 0.0 {
        rest.copysign(b)
    } else if (rest < 0.0) != (b < 0.0) {
        rest + b
    } else {
        rest
    }
}

fn compared<T: PartialOrd>(function: Function, a: &T, b: &T) -> u8 {
    u8::from(match function {
        Function::Less => a < b,
        Function::LessOrEqual => a <= b,
        Function::Greater => a > b,
        Function::GreaterOrEqual => a >= b,
        _ => a == b,
    })
}

fn integer(function: Function, a: i64, b: i64) -> i64 {
    match function {
        Function::Add => a.wrapping_add(b),
        Function::Sub => a.wrapping_sub(b),
        Function::Mul => a.wrapping_mul(b),
        // Division by zero is not defined.
        Function::Div if b == 0 => 0,
        Function::Div => a.wrapping_div(b),
        Function::Max => a.max(b),
        Function::Min => a.min(b),
        _ if b == 0 => 0,
        // The sign of the divisor, as in Python.
        _ => {
            let rest = a.wrapping_rem(b);
            if rest != 0 && (rest < 0) != (b < 0) { rest + b } else { rest }
        }
    }
}

impl BinaryStep {
    fn fast(&self, io: &mut Io<'_>, function: Binary) {
        let (a, b, y) = (io.read::<f32>(0), io.read::<f32>(1), io.write::<f32>());
        let rows = &self.rows;
        let isa = io.compute.isa();
        let piece = |first: usize, y: &mut [f32], length: usize| {
            for (row, y) in y.chunks_mut(length).enumerate() {
                let operand = |x: &'_ [f32], index: usize| {
                    let start = rows.start(first + row, index);
                    (start, rows.is_row[index], x.len())
                };
                let (a_at, b_at) = (operand(a, 0), operand(b, 1));
                let pick = |x, at: (usize, bool, usize)| part(x, at.0, at.1, y.len());
                let (a, b) = (pick(a, a_at), pick(b, b_at));
                function.apply(isa, a, b, y);
            }
        };
        if y.is_empty() {
            return;
        }
        if rows.outer.is_empty() {
            const PIECE: usize = 1 << 14;
            io.compute.pool().run_on_pieces(y, PIECE, |index, y| {
                let at = index * PIECE;
                let of = |x, operand: usize| {
                    if rows.is_row[operand] { part(x, at, true, y.len()) } else { part(x, 0, false, 1) }
                };
                let (a, b) = (of(a, 0), of(b, 1));
                function.apply(isa, a, b, y);
            });
            return;
        }
        let per_piece = ((1 << 14) / rows.length).max(1);
        io.compute
            .pool()
            .run_on_pieces(y, per_piece * rows.length, |index, y| piece(index * per_piece, y, rows.length));
    }

    fn each<T: opendr_kernels::Number, U: opendr_kernels::Number>(
        &self,
        io: &mut Io<'_>,
        function: impl Fn(T, T) -> U,
    ) {
        let (a, b, y) = (io.read::<T>(0), io.read::<T>(1), io.write::<U>());
        for (row, y) in y.chunks_mut(self.rows.length.max(1)).enumerate() {
            let (a, b) = (self.rows.of(a, row, 0, y.len()), self.rows.of(b, row, 1, y.len()));
            for (i, y) in y.iter_mut().enumerate() {
                *y = function(
                    a[if self.rows.is_row[0] { i } else { 0 }],
                    b[if self.rows.is_row[1] { i } else { 0 }],
                );
            }
        }
    }
}

fn part(x: &[f32], start: usize, is_row: bool, length: usize) -> Operand<'_> {
    if is_row { Operand::Row(&x[start..start + length]) } else { Operand::Scalar(x[start]) }
}

pub(crate) fn not(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let x = required(node, inputs, 0)?;
    let value = planner.value(x).clone();
    if value.kind != Kind::Bool {
        return Err(node.damaged("its input must be of booleans"));
    }
    Ok(vec![planner.emit_one(NotStep, &[x], Kind::Bool, value.shape, value.layout)?])
}

struct NotStep;

impl Kernel for NotStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let x = io.read::<u8>(0);
        io.write::<u8>().iter_mut().zip(x).for_each(|(y, x)| *y = 1 - (*x).min(1));
        Ok(())
    }
}

pub(crate) fn select(planner: &mut Planner<'_>, node: &NodeProto, inputs: &[Option<Id>]) -> Result<Vec<Id>> {
    let [condition, a, b] = [0, 1, 2].map(|slot| required(node, inputs, slot));
    let (condition, a, b) = (condition?, a?, b?);
    let kind = planner.kind(a);
    if planner.kind(condition) != Kind::Bool || planner.kind(b) != kind {
        return Err(node.damaged("the types of its inputs"));
    }
    let (ids, shape, layout) = aligned(planner, node, &[condition, a, b])?;
    let physical = if layout == Layout::ChannelsLast { channels_to_end(&shape) } else { shape.clone() };
    let operands: Vec<Vec<usize>> = ids.iter().map(|&id| planner.value(id).physical()).collect();
    let step = SelectStep { size: kind.bytes(), rows: Rows::new(&physical, &operands) };
    Ok(vec![planner.emit_one(step, &ids, kind, shape, layout)?])
}

struct SelectStep {
    size: usize,
    rows: Rows,
}

impl Kernel for SelectStep {
    fn run(&self, io: &mut Io<'_>) -> Result<()> {
        let rows = &self.rows;
        let condition = io.read::<u8>(0);
        crate::remap::by_size!(self.size, T => {
            let (a, b, y) = (io.read::<T>(1), io.read::<T>(2), io.write::<T>());
            for (row, y) in y.chunks_mut(rows.length.max(1)).enumerate() {
                let condition = rows.of(condition, row, 0, y.len());
                let (a, b) = (rows.of(a, row, 1, y.len()), rows.of(b, row, 2, y.len()));
                let at = |operand: usize, i: usize| if rows.is_row[operand] { i } else { 0 };
                for (i, y) in y.iter_mut().enumerate() {
                    *y = if condition[at(0, i)] != 0 { a[at(1, i)] } else { b[at(2, i)] };
                }
            }
        });
        Ok(())
    }
}

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

fn converted(planner: &mut Planner<'_>, x: Id, to: Kind) -> Result<Id> {
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
                let x = opendr_onnx::float_from_half(x);
                (f64::from(x), x as i64)
            }),
        }
        Ok(())
    }
}

impl CastStep {
    fn write<T: opendr_kernels::Number>(&self, io: &mut Io<'_>, read: impl Fn(T) -> (f64, i64)) {
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
