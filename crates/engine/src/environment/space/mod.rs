//! What observations and actions look like.

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
/// An element is numbers in a row: those of a box or of binary digits last axis fastest, the number of a discrete
/// choice itself, the parts of a dictionary in the order of their names, of a tuple in its own order.
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
        /// What the numbers are.
        dtype: Dtype,
    },
    /// One of `n` whole numbers beginning with `start`.
    Discrete {
        /// How many.
        n: u32,
        /// The first.
        start: i32,
    },
    /// Several choices at once, each from 0.
    MultiDiscrete(Vec<u32>),
    /// Zeros and ones of a shape.
    MultiBinary(Vec<usize>),
    /// Parts with names.
    Dict(BTreeMap<String, Space>),
    /// Parts in a row.
    Tuple(Vec<Space>),
}

impl Space {
    /// A box with a bound on each element.
    ///
    /// # Errors
    /// `InvalidInput` when the lengths differ from the shape's, a bound is NaN, or a low is above its high.
    pub fn bounded(low: Vec<f32>, high: Vec<f32>, shape: Vec<usize>) -> Result<Self> {
        let wanted = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
        if wanted != Some(low.len()) || low.len() != high.len() {
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

    /// A box with the same bounds on all elements.
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

    /// A row of elements, each within plus and minus its limit.
    pub fn symmetric(limits: &[f32]) -> Self {
        let high: Vec<_> = limits.iter().map(|limit| limit.abs()).collect();
        let low = high.iter().map(|limit| -limit).collect();
        Self::Box { low, shape: vec![high.len()], high, dtype: Dtype::Float32 }
    }

    /// The same box of numbers of another type.
    ///
    /// # Errors
    /// `InvalidInput` for what is no box, and for bounds that the type has not.
    pub fn with_dtype(mut self, wanted: Dtype) -> Result<Self> {
        let Self::Box { low, high, dtype, .. } = &mut self else {
            return Err(Error::invalid_input(format!("{self} has no numbers of type {}", wanted.name())));
        };
        let mut bounds = low.iter().chain(high.iter());
        let fits = |bound: &f32| match wanted {
            Dtype::Uint8 => is_choice(f64::from(*bound), 256),
            Dtype::Int64 => bound.fract() == 0.0,
            Dtype::Float32 | Dtype::Float64 => true,
        };
        if let Some(bound) = bounds.find(|bound| !fits(bound)) {
            let name = wanted.name();
            return Err(Error::invalid_input(format!("a bound of {bound} is no {name}; give one that is")));
        }
        *dtype = wanted;
        Ok(self)
    }

    /// One of `n` numbers from 0.
    pub fn discrete(n: u32) -> Self {
        Self::Discrete { n, start: 0 }
    }

    /// How many numbers one element has.
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

    /// Whether an element has no number.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Whether the numbers are an element.
    pub fn contains(&self, element: &[f32]) -> bool {
        self.check(element).is_ok()
    }

    /// As [`Self::contains`], with a word on what does not fit.
    ///
    /// # Errors
    /// `InvalidInput` for a wrong count, NaN, a number out of range, a choice that is no whole number.
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

    /// Checks numbers of the right count; `at` is the place of the first among those of the whole element.
    fn check_numbers(&self, element: &[f32], at: usize) -> Result<()> {
        let outside = |index: usize| {
            Error::invalid_input(format!(
                "number {} is {}, which lies outside {self}; clip or scale it",
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

/// Whether a number is one of 0 to `count` - 1.
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

/// As Gymnasium prints it: `Box(-2.0, 2.0, (1,))`, `Discrete(3)`.
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
