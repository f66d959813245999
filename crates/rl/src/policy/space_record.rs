//! Spaces as JSON.

use std::collections::BTreeMap;

use opendr_engine::environment::{Dtype, Space};
use opendr_engine::{Error, Result};
use serde::{Deserialize, Serialize};

/// JSON form of a space. Bounds are strings, so that infinite ones can be stored; equal ones are stored once.
#[derive(Debug, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum SpaceRecord {
    /// Numbers within bounds.
    Box {
        /// Lower bounds.
        low: Vec<String>,
        /// Upper bounds.
        high: Vec<String>,
        /// Lengths of the axes.
        shape: Vec<usize>,
        /// Type of the numbers.
        dtype: String,
    },
    /// One of `n` choices.
    Discrete {
        /// Number of choices.
        n: u32,
        /// The first one.
        start: i32,
    },
    /// Several choices.
    MultiDiscrete(Vec<u32>),
    /// Several bits.
    MultiBinary(Vec<usize>),
    /// Spaces by name.
    Dict(BTreeMap<String, SpaceRecord>),
    /// Spaces in order.
    Tuple(Vec<SpaceRecord>),
}

/// Maximum numbers, or choices, of an element.
const MOST_NUMBERS: usize = 1 << 24;

impl SpaceRecord {
    /// Returns the form of a space.
    ///
    /// # Errors
    /// `Unsupported` for a space that cannot be stored.
    pub fn of(space: &Space) -> Result<Self> {
        Ok(match space {
            Space::Box { low, high, shape, dtype } => Self::Box {
                low: texts(low),
                high: texts(high),
                shape: shape.clone(),
                dtype: dtype.name().to_owned(),
            },
            Space::Discrete { n, start } => Self::Discrete { n: *n, start: *start },
            Space::MultiDiscrete(counts) => Self::MultiDiscrete(counts.clone()),
            Space::MultiBinary(shape) => Self::MultiBinary(shape.clone()),
            Space::Dict(parts) => {
                let parts = parts.iter().map(|(name, part)| Ok((name.clone(), Self::of(part)?)));
                Self::Dict(parts.collect::<Result<_>>()?)
            }
            Space::Tuple(parts) => Self::Tuple(parts.iter().map(Self::of).collect::<Result<_>>()?),
            other => return Err(Error::unsupported(format!("the space {other} cannot be stored"))),
        })
    }

    /// Returns the space.
    ///
    /// # Errors
    /// `Format` for damaged bounds, and where the space is too large.
    pub fn space(&self) -> Result<Space> {
        let mut left = MOST_NUMBERS;
        self.within(&mut left)
    }

    /// Returns the space and subtracts its size from `left`.
    fn within(&self, left: &mut usize) -> Result<Space> {
        Ok(match self {
            Self::Box { low, high, shape, dtype } => {
                let count = take(shape.iter().copied(), left)?;
                let dtype = Dtype::from_name(dtype)
                    .ok_or_else(|| Error::format(format!("{dtype:.40?} is not a number type")))?;
                Space::bounded(numbers(low, count)?, numbers(high, count)?, shape.clone())?
                    .with_dtype(dtype)?
            }
            Self::Discrete { n, start } => {
                take([*n as usize], left)?;
                Space::Discrete { n: *n, start: *start }
            }
            Self::MultiDiscrete(counts) => {
                counts.iter().try_for_each(|count| take([*count as usize], left).map(drop))?;
                Space::MultiDiscrete(counts.clone())
            }
            Self::MultiBinary(shape) => {
                take(shape.iter().copied(), left)?;
                Space::MultiBinary(shape.clone())
            }
            Self::Dict(parts) => {
                let parts = parts.iter().map(|(name, part)| Ok((name.clone(), part.within(left)?)));
                Space::Dict(parts.collect::<Result<_>>()?)
            }
            Self::Tuple(parts) => {
                Space::Tuple(parts.iter().map(|part| part.within(left)).collect::<Result<_>>()?)
            }
        })
    }
}

fn texts(bounds: &[f32]) -> Vec<String> {
    match bounds {
        [first, rest @ ..] if rest.iter().all(|bound| bound == first) => vec![first.to_string()],
        all => all.iter().map(f32::to_string).collect(),
    }
}

fn numbers(texts: &[String], count: usize) -> Result<Vec<f32>> {
    let number = |text: &String| {
        text.parse::<f32>().map_err(|_| Error::format(format!("{text:.40?} is not a bound of a space")))
    };
    match texts {
        [only] => Ok(vec![number(only)?; count]),
        all => all.iter().map(number).collect(),
    }
}

/// Returns the product of sizes and subtracts it from `left`.
fn take(sizes: impl IntoIterator<Item = usize>, left: &mut usize) -> Result<usize> {
    let product = sizes.into_iter().try_fold(1usize, |product, size| product.checked_mul(size));
    let rest = product.and_then(|product| left.checked_sub(product));
    let (Some(product), Some(rest)) = (product, rest) else {
        return Err(Error::format(format!(
            "a space has more than {MOST_NUMBERS} numbers; the file is damaged"
        )));
    };
    *left = rest;
    Ok(product)
}
