//! Element-wise operators.

use super::super::array::{Array, Data, element_count};
use super::super::proto::DataType;
use super::indexing::{MAX_ELEMENTS, broadcast, broadcast_strides, strided};
use super::movement::partial_values;

/// Broadcasts both operands to their common dimensions.
fn spread<A: Clone, B: Clone>(x: (&Array, &[A]), y: (&Array, &[B])) -> Option<(Vec<usize>, Vec<A>, Vec<B>)> {
    let dims = broadcast(x.0.dims(), y.0.dims())?;
    let left = strided(x.1, &dims, &broadcast_strides(x.0.dims(), &dims)?, 0)?;
    let right = strided(y.1, &dims, &broadcast_strides(y.0.dims(), &dims)?, 0)?;
    Some((dims, left, right))
}

fn zip<A: Clone, B: Clone, C>(
    x: (&Array, &[A]),
    y: (&Array, &[B]),
    wrap: fn(Vec<C>) -> Data,
    f: impl Fn(A, B) -> Option<C>,
) -> Option<Array> {
    let (dims, left, right) = spread(x, y)?;
    let values: Option<Vec<C>> = left.into_iter().zip(right).map(|(a, b)| f(a, b)).collect();
    Array::new(dims, wrap(values?))
}

pub(super) fn binary(name: &str, x: &Array, y: &Array) -> Option<Array> {
    match (x.data(), y.data()) {
        (Data::Float(a), Data::Float(b)) => match compare::<f32>(name) {
            Some(f) => zip((x, a), (y, b), Data::Bool, |a, b| Some(f(&a, &b))),
            None => {
                let f = float_operation(name)?;
                zip((x, a), (y, b), Data::Float, |a, b| Some(f(a, b)))
            }
        },
        (Data::Int(a), Data::Int(b)) => match compare::<i64>(name) {
            Some(f) => zip((x, a), (y, b), Data::Bool, |a, b| Some(f(&a, &b))),
            None => {
                let f = int_operation(name)?;
                zip((x, a), (y, b), Data::Int, f)
            }
        },
        (Data::Bool(a), Data::Bool(b)) => {
            let f: fn(bool, bool) -> bool = match name {
                "And" => |a, b| a && b,
                "Or" => |a, b| a || b,
                "Xor" | "Equal" => |a, b| a == b,
                _ => return None,
            };
            let flip = name == "Xor";
            zip((x, a), (y, b), Data::Bool, |a, b| Some(f(a, b) != flip))
        }
        (a, b) => {
            let f = int_operation(name)?;
            let (a, b) = (partial_values(a)?, partial_values(b)?);
            let result =
                zip((x, &a), (y, &b), Data::Partial, |a, b| Some(a.zip(b).and_then(|(a, b)| f(a, b))));
            result.map(Array::completed)
        }
    }
}

fn compare<T: PartialOrd>(name: &str) -> Option<fn(&T, &T) -> bool> {
    Some(match name {
        "Equal" => T::eq,
        "Less" => T::lt,
        "LessOrEqual" => T::le,
        "Greater" => T::gt,
        "GreaterOrEqual" => T::ge,
        _ => return None,
    })
}

fn float_operation(name: &str) -> Option<fn(f32, f32) -> f32> {
    Some(match name {
        "Add" => |a, b| a + b,
        "Sub" => |a, b| a - b,
        "Mul" => |a, b| a * b,
        "Div" => |a, b| a / b,
        "Pow" => f32::powf,
        "Min" => f32::min,
        "Max" => f32::max,
        _ => return None,
    })
}

fn int_operation(name: &str) -> Option<fn(i64, i64) -> Option<i64>> {
    Some(match name {
        "Add" => i64::checked_add,
        "Sub" => i64::checked_sub,
        "Mul" => i64::checked_mul,
        "Div" => i64::checked_div,
        // ONNX's integer `Mod` has the sign of the divisor.
        "Mod" => |a, b| a.checked_rem(b).map(|r| if r != 0 && (r < 0) != (b < 0) { r + b } else { r }),
        "Min" => |a, b| Some(a.min(b)),
        "Max" => |a, b| Some(a.max(b)),
        _ => return None,
    })
}

pub(super) fn unary(name: &str, x: &Array) -> Option<Array> {
    let data = match x.data() {
        Data::Float(values) => {
            let f: fn(f32) -> f32 = match name {
                "Neg" => |v| -v,
                "Abs" => f32::abs,
                "Floor" => f32::floor,
                "Ceil" => f32::ceil,
                "Sqrt" => f32::sqrt,
                "Reciprocal" => f32::recip,
                "Exp" => f32::exp,
                "Log" => f32::ln,
                "Relu" => |v| v.max(0.0),
                _ => return None,
            };
            Data::Float(values.iter().map(|&v| f(v)).collect())
        }
        Data::Int(values) => {
            let f: fn(i64) -> Option<i64> = match name {
                "Neg" => i64::checked_neg,
                "Abs" => i64::checked_abs,
                _ => return None,
            };
            Data::Int(values.iter().map(|&v| f(v)).collect::<Option<_>>()?)
        }
        Data::Bool(values) if name == "Not" => Data::Bool(values.iter().map(|&v| !v).collect()),
        _ => return None,
    };
    Array::new(x.dims().to_vec(), data)
}

pub(super) fn cast(x: &Array, to: i64) -> Option<Array> {
    let to = DataType::try_from(i32::try_from(to).ok()?).ok()?;
    let data = match (x.data(), to) {
        (Data::Float(values), DataType::Int64) => Data::Int(values.iter().map(|&v| v as i64).collect()),
        (Data::Float(values), DataType::Bool) => Data::Bool(values.iter().map(|&v| v != 0.0).collect()),
        (Data::Int(values), DataType::Float) => Data::Float(values.iter().map(|&v| v as f32).collect()),
        (Data::Int(values), DataType::Bool) => Data::Bool(values.iter().map(|&v| v != 0).collect()),
        (Data::Bool(values), DataType::Float) => {
            Data::Float(values.iter().map(|&v| f32::from(u8::from(v))).collect())
        }
        (Data::Bool(values), DataType::Int64) => Data::Int(values.iter().map(|&v| i64::from(v)).collect()),
        (data, to) if data.data_type() == to => data.clone(),
        _ => return None,
    };
    Array::new(x.dims().to_vec(), data)
}

pub(super) fn select(condition: &Array, x: &Array, y: &Array) -> Option<Array> {
    let Data::Bool(flags) = condition.data() else { return None };
    let dims = broadcast(&broadcast(condition.dims(), x.dims())?, y.dims())?;
    let flags = strided(flags, &dims, &broadcast_strides(condition.dims(), &dims)?, 0)?;
    fn pick<T: Clone>(flags: &[bool], x: Vec<T>, y: Vec<T>) -> Vec<T> {
        flags.iter().zip(x.into_iter().zip(y)).map(|(&flag, (x, y))| if flag { x } else { y }).collect()
    }
    let (to_x, to_y) = (broadcast_strides(x.dims(), &dims)?, broadcast_strides(y.dims(), &dims)?);
    let data = match (x.data(), y.data()) {
        (Data::Float(a), Data::Float(b)) => {
            Data::Float(pick(&flags, strided(a, &dims, &to_x, 0)?, strided(b, &dims, &to_y, 0)?))
        }
        (Data::Int(a), Data::Int(b)) => {
            Data::Int(pick(&flags, strided(a, &dims, &to_x, 0)?, strided(b, &dims, &to_y, 0)?))
        }
        _ => return None,
    };
    Array::new(dims, data)
}

pub(super) fn range(start: &Array, limit: &Array, delta: &Array) -> Option<Array> {
    let data = match (start.data(), limit.data(), delta.data()) {
        (Data::Int(start), Data::Int(limit), Data::Int(delta)) => {
            let (start, limit, delta) = (*start.first()?, *limit.first()?, *delta.first()?);
            let span = limit.checked_sub(start)?;
            let span = if delta < 0 { span.checked_neg()? } else { span }.max(0) as u64;
            let count = span.checked_add(delta.unsigned_abs() - u64::from(delta != 0))?
                / match delta {
                    0 => return None,
                    delta => delta.unsigned_abs(),
                };
            let count = i64::try_from(count).ok().filter(|&count| count as usize <= MAX_ELEMENTS)?;
            Data::Int((0..count).map(|i| start + i * delta).collect())
        }
        (Data::Float(start), Data::Float(limit), Data::Float(delta)) => {
            let (start, limit, delta) = (*start.first()?, *limit.first()?, *delta.first()?);
            let count = ((limit - start) / delta).ceil().max(0.0);
            if !count.is_finite() || count > MAX_ELEMENTS as f32 {
                return None;
            }
            Data::Float((0..count as usize).map(|i| start + i as f32 * delta).collect())
        }
        _ => return None,
    };
    Array::new(vec![element_count(&[data.len()])?], data)
}
