//! Elements as inputs of a network: discrete choices are one-hot.

use super::Space;
use crate::{Error, Result};

impl Space {
    /// Returns the length of a flattened element (Gymnasium's `flatdim`).
    pub fn flat_len(&self) -> usize {
        match self {
            Self::Box { .. } | Self::MultiBinary(_) => self.len(),
            Self::Discrete { n, .. } => *n as usize,
            Self::MultiDiscrete(counts) => counts.iter().map(|count| *count as usize).sum(),
            Self::Dict(parts) => parts.values().map(Self::flat_len).sum(),
            Self::Tuple(parts) => parts.iter().map(Self::flat_len).sum(),
        }
    }

    /// Writes `element` in flattened form (Gymnasium's `flatten`).
    ///
    /// # Errors
    /// Returns `InvalidInput` if `element` is not in this space or `flat` does not have the length [`Self::flat_len`].
    pub fn flatten_into(&self, element: &[f32], flat: &mut [f32]) -> Result<()> {
        self.check(element)?;
        self.check_flat(flat.len())?;
        self.flatten_checked(element, flat);
        Ok(())
    }

    /// Writes the element of the flattened form `flat` (Gymnasium's `unflatten`); the largest number determines a choice.
    ///
    /// # Errors
    /// Returns `InvalidInput` if a length does not fit.
    pub fn unflatten_into(&self, flat: &[f32], element: &mut [f32]) -> Result<()> {
        self.check_flat(flat.len())?;
        if element.len() != self.len() {
            let (expected, count) = (self.len(), element.len());
            return Err(Error::invalid_input(format!(
                "an element of {self} has {expected} numbers, not {count}"
            )));
        }
        self.unflatten_checked(flat, element);
        Ok(())
    }

    fn check_flat(&self, count: usize) -> Result<()> {
        if count == self.flat_len() {
            return Ok(());
        }
        let expected = self.flat_len();
        Err(Error::invalid_input(format!(
            "a flattened element of {self} has {expected} numbers, not {count}"
        )))
    }

    fn flatten_checked(&self, element: &[f32], flat: &mut [f32]) {
        match self {
            Self::Box { .. } | Self::MultiBinary(_) => flat.copy_from_slice(element),
            Self::Discrete { start, .. } => {
                flat.fill(0.0);
                flat[(f64::from(element[0]) - f64::from(*start)) as usize] = 1.0;
            }
            Self::MultiDiscrete(counts) => {
                flat.fill(0.0);
                let mut begin = 0;
                for (choice, count) in element.iter().zip(counts) {
                    flat[begin + *choice as usize] = 1.0;
                    begin += *count as usize;
                }
            }
            Self::Dict(parts) => flatten_parts(parts.values(), element, flat),
            Self::Tuple(parts) => flatten_parts(parts.iter(), element, flat),
        }
    }

    fn unflatten_checked(&self, flat: &[f32], element: &mut [f32]) {
        match self {
            Self::Box { .. } | Self::MultiBinary(_) => element.copy_from_slice(flat),
            Self::Discrete { start, .. } => element[0] = (largest(flat) as f64 + f64::from(*start)) as f32,
            Self::MultiDiscrete(counts) => {
                let mut rest = flat;
                for (choice, count) in element.iter_mut().zip(counts) {
                    let (own, behind) = rest.split_at(*count as usize);
                    *choice = largest(own) as f32;
                    rest = behind;
                }
            }
            Self::Dict(parts) => unflatten_parts(parts.values(), flat, element),
            Self::Tuple(parts) => unflatten_parts(parts.iter(), flat, element),
        }
    }
}

/// Returns the index of the largest number, the first of equal ones.
fn largest(numbers: &[f32]) -> usize {
    numbers.iter().enumerate().fold(0, |best, (at, number)| if *number > numbers[best] { at } else { best })
}

fn flatten_parts<'a>(parts: impl Iterator<Item = &'a Space>, mut element: &[f32], mut flat: &mut [f32]) {
    for part in parts {
        let (own, behind) = element.split_at(part.len());
        let (own_flat, flat_behind) = flat.split_at_mut(part.flat_len());
        part.flatten_checked(own, own_flat);
        (element, flat) = (behind, flat_behind);
    }
}

fn unflatten_parts<'a>(parts: impl Iterator<Item = &'a Space>, mut flat: &[f32], mut element: &mut [f32]) {
    for part in parts {
        let (own_flat, flat_behind) = flat.split_at(part.flat_len());
        let (own, behind) = element.split_at_mut(part.len());
        part.unflatten_checked(own_flat, own);
        (flat, element) = (flat_behind, behind);
    }
}
