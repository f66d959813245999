//! Spaces of observations and actions.

mod dtype;
mod flatten;
mod sample;
#[cfg(test)]
mod tests;

use std::collections::BTreeMap;
use std::fmt;

use crate::{Error, Result};

pub use dtype::Dtype;

/// A set of observations or actions.
///
/// An element is a flat slice of numbers: those of a box or of binary digits in row-major order, the value of a discrete
/// choice, the parts of a dictionary in the order of their names, the parts of a tuple in order.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub enum Space {
    /// Real numbers within bounds, any shape; a bound may be infinite.
    Box {
        /// Smallest value of each element.
        low: Vec<f32>,
        /// Largest value of each element.
        high: Vec<f32>,
        /// Size of each axis.
        shape: Vec<usize>,
        /// Type of the numbers.
        dtype: Dtype,
    },
    /// One of `n` integers from `start`.
    Discrete {
        /// Number of choices.
        n: u32,
        /// First choice.
        start: i32,
    },
    /// Several discrete choices, each from 0.
    MultiDiscrete(Vec<u32>),
    /// An array of zeros and ones of this shape.
    MultiBinary(Vec<usize>),
    /// Named parts.
    Dict(BTreeMap<String, Space>),
    /// Parts in order.
    Tuple(Vec<Space>),
}

impl Space {
    /// Creates a box with bounds for each element.
    ///
    /// # Errors
    /// Returns `InvalidInput` if the lengths do not fit the shape, a bound is NaN, or a lower bound exceeds the upper one.
    pub fn bounded(low: Vec<f32>, high: Vec<f32>, shape: Vec<usize>) -> Result<Self> {
        let expected = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        if expected != Some(low.len()) || low.len() != high.len() {
            return Err(Error::invalid_input(format!(
                "a box of shape {shape:?} has {} low and {} high bounds; give one of each per element",
                low.len(),
                high.len()
            )));
        }
        let is_wrong = |(low, high): (&f32, &f32)| low.is_nan() || high.is_nan() || low > high;
        if let Some(at) = low.iter().zip(&high).position(is_wrong) {
            return Err(Error::invalid_input(format!(
                "element {at} of a box is bounded by {} and {}; give a low that is not above its high",
                low[at], high[at]
            )));
        }
        Ok(Self::Box { low, high, shape, dtype: Dtype::Float32 })
    }

    /// Creates a box with the same bounds for all elements.
    ///
    /// # Errors
    /// As [`Self::bounded`].
    pub fn uniform(low: f32, high: f32, shape: &[usize]) -> Result<Self> {
        let count = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        let count = count.filter(|count| *count <= 1 << 28).ok_or_else(|| {
            Error::invalid_input(format!(
                "a box of shape {shape:?} is too large; an element has at most 2^28"
            ))
        })?;
        Self::bounded(vec![low; count], vec![high; count], shape.to_vec())
    }

    /// Creates a one-dimensional box, each element within plus and minus its limit.
    pub fn symmetric(limits: &[f32]) -> Self {
        let high: Vec<_> = limits.iter().map(|limit| limit.abs()).collect();
        let low = high.iter().map(|limit| -limit).collect();
        Self::Box { low, shape: vec![high.len()], high, dtype: Dtype::Float32 }
    }

    /// Returns the same box with another element type.
    ///
    /// # Errors
    /// Returns `InvalidInput` for other spaces, and for bounds that the type does not represent.
    pub fn with_dtype(mut self, new_dtype: Dtype) -> Result<Self> {
        let Self::Box { low, high, dtype, .. } = &mut self else {
            return Err(Error::invalid_input(format!(
                "{self} is not a box and cannot have the element type {}",
                new_dtype.name()
            )));
        };
        let mut bounds = low.iter().chain(high.iter());
        let fits = |bound: &f32| match new_dtype {
            Dtype::Uint8 => is_choice(f64::from(*bound), 256),
            Dtype::Int64 => bound.fract() == 0.0,
            Dtype::Float32 | Dtype::Float64 => true,
        };
        if let Some(bound) = bounds.find(|bound| !fits(bound)) {
            let name = new_dtype.name();
            return Err(Error::invalid_input(format!(
                "{name} cannot represent the bound {bound}; give one that it can"
            )));
        }
        *dtype = new_dtype;
        Ok(self)
    }

    /// Creates a space of `n` choices from 0.
    pub fn discrete(n: u32) -> Self {
        Self::Discrete { n, start: 0 }
    }

    /// Returns the length of an element.
    pub fn len(&self) -> usize {
        match self {
            Self::Box { low, .. } => low.len(),
            Self::Discrete { .. } => 1,
            Self::MultiDiscrete(counts) => counts.len(),
            Self::MultiBinary(shape) => shape.iter().product(),
            Self::Dict(parts) => parts.values().map(Self::len).sum(),
            Self::Tuple(parts) => parts.iter().map(Self::len).sum(),
        }
    }

    /// Returns whether elements are empty.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns whether `element` is in the space.
    pub fn contains(&self, element: &[f32]) -> bool {
        self.check(element).is_ok()
    }

    /// Checks that `element` is in the space.
    ///
    /// # Errors
    /// Returns `InvalidInput` for a wrong length, NaN, a number out of range, or a choice that is not an integer.
    pub fn check(&self, element: &[f32]) -> Result<()> {
        if element.len() != self.len() {
            return Err(Error::invalid_input(format!(
                "an element of {self} has {} numbers, not {}",
                self.len(),
                element.len()
            )));
        }
        self.check_numbers(element, 0)
    }

    /// Checks numbers of the right count; `at` is the index of the first one in the whole element.
    fn check_numbers(&self, element: &[f32], at: usize) -> Result<()> {
        let outside = |index: usize| {
            Error::invalid_input(format!(
                "number {} is {}, which is outside {self}; clip or scale it",
                at + index,
                element[index]
            ))
        };
        let position = match self {
            Self::Box { low, high, dtype, .. } => {
                let fits = |(value, (low, high)): (&f32, (&f32, &f32))| {
                    low <= value && value <= high && (!dtype.is_whole() || value.fract() == 0.0)
                };
                element.iter().zip(low.iter().zip(high)).position(|pair| !fits(pair))
            }
            Self::Discrete { n, start } => element.iter().position(|value| {
                let choice = f64::from(*value) - f64::from(*start);
                !is_choice(choice, *n)
            }),
            Self::MultiDiscrete(counts) => {
                let mut pairs = element.iter().zip(counts);
                pairs.position(|(value, count)| !is_choice(f64::from(*value), *count))
            }
            Self::MultiBinary(_) => element.iter().position(|value| !is_choice(f64::from(*value), 2)),
            Self::Dict(parts) => return check_parts(parts.values(), element, at),
            Self::Tuple(parts) => return check_parts(parts.iter(), element, at),
        };
        position.map_or(Ok(()), |index| Err(outside(index)))
    }
}

/// Returns whether `value` is an integer from 0 to `count` - 1.
fn is_choice(value: f64, count: u32) -> bool {
    value >= 0.0 && value < f64::from(count) && value.fract() == 0.0
}

fn check_parts<'a>(parts: impl Iterator<Item = &'a Space>, mut element: &[f32], mut at: usize) -> Result<()> {
    for part in parts {
        let (own, rest) = element.split_at(part.len());
        part.check_numbers(own, at)?;
        (element, at) = (rest, at + own.len());
    }
    Ok(())
}

/// Writes a text like that of Gymnasium: `Box(-2.0, 2.0, [1])`, `Discrete(3)`.
impl fmt::Display for Space {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Box { low, high, shape, dtype } => {
                let of = |bounds: &[f32]| match bounds {
                    [first, rest @ ..] if rest.iter().all(|bound| bound == first) => format!("{first:?}"),
                    few if few.len() <= 8 => format!("{few:?}"),
                    [first, .., last] => format!("[{first:?} ... {last:?}]"),
                    [] | [_] => "[]".to_owned(),
                };
                write!(f, "Box({}, {}, {shape:?}", of(low), of(high))?;
                match dtype {
                    Dtype::Float32 => f.write_str(")"),
                    other => write!(f, ", {})", other.name()),
                }
            }
            Self::Discrete { n, start: 0 } => write!(f, "Discrete({n})"),
            Self::Discrete { n, start } => write!(f, "Discrete({n}, start={start})"),
            Self::MultiDiscrete(counts) => write!(f, "MultiDiscrete({counts:?})"),
            Self::MultiBinary(shape) => write!(f, "MultiBinary({shape:?})"),
            Self::Dict(parts) => {
                f.write_str("Dict(")?;
                for (index, (name, part)) in parts.iter().enumerate() {
                    write!(f, "{}'{name}': {part}", if index == 0 { "" } else { ", " })?;
                }
                f.write_str(")")
            }
            Self::Tuple(parts) => {
                f.write_str("Tuple(")?;
                for (index, part) in parts.iter().enumerate() {
                    write!(f, "{}{part}", if index == 0 { "" } else { ", " })?;
                }
                f.write_str(")")
            }
        }
    }
}
