//! Operators that are applied to each element, with broadcasting.

use opendr_engine::Result;
use opendr_kernels::{Binary, Number, Operand, Unary};
use opendr_onnx::proto::NodeProto;

use super::broadcast::{Rows, aligned};
use super::cast::converted;
use super::functions;
use super::inputs::{optional, required};
use crate::attributes::Attributes;
use crate::constant::Constant;
use crate::io::{Io, Kernel};
use crate::planner::{Id, Layout, Planner};
use crate::tensor::Kind;
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
            (Kind::F32, _) => self.compare::<f32>(io),
            (Kind::I64, Equal | Less | LessOrEqual | Greater | GreaterOrEqual) => self.compare::<i64>(io),
            (Kind::I32, Equal | Less | LessOrEqual | Greater | GreaterOrEqual) => self.compare::<i32>(io),
            (Kind::I64, function) => self.each(io, move |a: i64, b: i64| integer(function, a, b)),
            (Kind::I32, function) => {
                self.each(io, move |a: i32, b: i32| integer(function, a.into(), b.into()) as i32);
            }
            (_, And) => self.each(io, |a: u8, b: u8| a & b),
            (_, Or) => self.each(io, |a: u8, b: u8| a | b),
            (_, Xor) => self.each(io, |a: u8, b: u8| a ^ b),
            _ => self.compare::<u8>(io),
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
        if let (Some(repeated), 1..SHORT) = (self.rows.repeated(), self.rows.length) {
            return self.repeat(io, function, repeated);
        }
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
        if rows.is_one() {
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

    /// Computes rows with one row of the other operand: as many at a time as fill some registers.
    fn repeat(&self, io: &mut Io<'_>, function: Binary, repeated: usize) {
        let (row, whole, y) = (io.read::<f32>(repeated), io.read::<f32>(1 - repeated), io.write::<f32>());
        let isa = io.compute.isa();
        let mut pattern = [0.0; 4 * SHORT];
        let size = pattern.len() / row.len() * row.len();
        pattern[..size].chunks_exact_mut(row.len()).for_each(|to| to.copy_from_slice(row));
        let piece = (1 << 14) / size * size;
        io.compute.pool().run_on_pieces(y, piece, |index, y| {
            let whole = &whole[index * piece..][..y.len()];
            for (y, whole) in y.chunks_mut(size).zip(whole.chunks(size)) {
                let (row, whole) = (Operand::Row(&pattern[..y.len()]), Operand::Row(whole));
                let (a, b) = if repeated == 0 { (row, whole) } else { (whole, row) };
                function.apply(isa, a, b, y);
            }
        });
    }

    fn compare<T: Number + PartialOrd>(&self, io: &mut Io<'_>) {
        match self.function {
            Function::Less => self.each(io, |a: T, b: T| u8::from(a < b)),
            Function::LessOrEqual => self.each(io, |a: T, b: T| u8::from(a <= b)),
            Function::Greater => self.each(io, |a: T, b: T| u8::from(a > b)),
            Function::GreaterOrEqual => self.each(io, |a: T, b: T| u8::from(a >= b)),
            _ => self.each(io, |a: T, b: T| u8::from(a == b)),
        }
    }

    fn each<T: Number, U: Number>(&self, io: &mut Io<'_>, function: impl Fn(T, T) -> U) {
        let (a, b, y) = (io.read::<T>(0), io.read::<T>(1), io.write::<U>());
        for (row, y) in y.chunks_mut(self.rows.length.max(1)).enumerate() {
            let (a, b) = (self.rows.of(a, row, 0, y.len()), self.rows.of(b, row, 1, y.len()));
            match (a, b) {
                (a, &[b]) => y.iter_mut().zip(a).for_each(|(y, &a)| *y = function(a, b)),
                (&[a], b) => y.iter_mut().zip(b).for_each(|(y, &b)| *y = function(a, b)),
                (a, b) => y.iter_mut().zip(a.iter().zip(b)).for_each(|(y, (&a, &b))| *y = function(a, b)),
            }
        }
    }
}

/// Length of rows below which several are computed at a time.
const SHORT: usize = 64;

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
