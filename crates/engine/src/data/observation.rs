//! Observations of environments.

use std::fmt;
use std::sync::Arc;

use smallvec::SmallVec;

use crate::data::Data;
use crate::numpy_text::{Number, array_repr, array_str};
use crate::{Error, Header, Result};

/// An observation: a flat array, optionally divided into named parts with shapes (Gymnasium's `Dict` space). Clones share
/// the numbers.
#[derive(Debug, Clone, PartialEq)]
pub struct Observation {
    /// Time stamp and coordinate frame.
    pub header: Header,
    data: Arc<Vec<f32>>,
    parts: Arc<[Part]>,
}

#[derive(Debug, PartialEq)]
struct Part {
    name: Box<str>,
    shape: SmallVec<[usize; 4]>,
    start: usize,
}

impl Part {
    fn len(&self) -> usize {
        self.shape.iter().product()
    }
}

impl Observation {
    /// Creates an observation without parts.
    ///
    /// # Errors
    /// Returns `InvalidInput` if `data` is empty.
    pub fn from_data(data: impl Into<Arc<Vec<f32>>>) -> Result<Self> {
        let data = data.into();
        if data.is_empty() {
            return Err(Error::invalid_input("Observation is empty"));
        }
        Ok(Self { header: Header::default(), data, parts: Arc::default() })
    }

    /// Creates an observation of named arrays, stored one after the other.
    ///
    /// # Errors
    /// Returns `InvalidInput` if there are no numbers, a name occurs twice, or a shape does not fit its numbers.
    pub fn from_parts<'a>(
        parts: impl IntoIterator<Item = (&'a str, &'a [usize], &'a [f32])>,
    ) -> Result<Self> {
        let (mut data, mut layout) = (Vec::new(), Vec::<Part>::new());
        for (name, shape, numbers) in parts {
            let expected = shape.iter().try_fold(1usize, |count, side| count.checked_mul(*side));
            if expected != Some(numbers.len()) || layout.iter().any(|part| *part.name == *name) {
                let count = numbers.len();
                return Err(Error::invalid_input(format!(
                    "part {name:?} of shape {shape:?} has {count} numbers; give one per element, and each name once"
                )));
            }
            layout.push(Part { name: name.into(), shape: shape.into(), start: data.len() });
            data.extend_from_slice(numbers);
        }
        Ok(Self { parts: layout.into(), ..Self::from_data(data)? })
    }

    /// Sets the header.
    #[must_use]
    pub fn with_header(mut self, header: Header) -> Self {
        self.header = header;
        self
    }

    /// Returns all numbers, the input of a policy network.
    pub fn as_slice(&self) -> &[f32] {
        &self.data
    }

    /// Returns shape and numbers of the part `name`.
    pub fn part(&self, name: &str) -> Option<(&[usize], &[f32])> {
        self.parts().find_map(|(part, shape, numbers)| (part == name).then_some((shape, numbers)))
    }

    /// Returns name, shape and numbers of each part; nothing for an observation without parts.
    pub fn parts(&self) -> impl ExactSizeIterator<Item = (&str, &[usize], &[f32])> {
        self.parts.iter().map(|part| {
            let numbers = self.data.get(part.start..part.start + part.len()).unwrap_or_default();
            (&*part.name, &*part.shape, numbers)
        })
    }
}

impl Data for Observation {}

/// Writes the array, or the dictionary of arrays, as Python prints it; with `{:#}`, names and shapes.
impl fmt::Display for Observation {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        if f.alternate() {
            let parts: Vec<_> = self.parts().map(|(name, shape, _)| format!("{name} {shape:?}")).collect();
            return writeln!(f, "Observation of {} numbers {}", self.data.len(), parts.join(", "));
        }
        if self.parts.is_empty() {
            return f.write_str(&array_str(&[self.data.len()], &|at| Number::F32(self.data[at])));
        }
        for (index, (name, shape, numbers)) in self.parts().enumerate() {
            let array = array_repr(shape, &|at| Number::F32(numbers[at]));
            let array = array.strip_suffix(')').unwrap_or(&array);
            write!(f, "{}'{name}': {array}, dtype=float32)", if index == 0 { "{" } else { ", " })?;
        }
        f.write_str("}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_are_contiguous() {
        let observation = Observation::from_parts([
            ("lidar", &[2, 2][..], &[1.0, 2.0, 3.0, 4.0][..]),
            ("goal", &[1], &[0.5]),
        ]);
        let observation = observation.unwrap();
        assert_eq!(observation.as_slice(), [1.0, 2.0, 3.0, 4.0, 0.5]);
        assert_eq!(observation.part("goal"), Some((&[1][..], &[0.5][..])));
        assert_eq!(observation.part("other"), None);
        assert_eq!(
            observation.to_string(),
            "{'lidar': array([[1., 2.],\n       [3., 4.]], dtype=float32), 'goal': array([0.5], dtype=float32)}"
        );
        assert_eq!(Observation::from_data(vec![0.5, 1.0]).unwrap().to_string(), "[0.5 1. ]");
    }

    #[test]
    fn invalid_parts_are_rejected() {
        assert!(Observation::from_data(vec![]).is_err());
        assert!(Observation::from_parts([]).is_err());
        assert!(Observation::from_parts([("a", &[2][..], &[1.0][..])]).is_err());
        assert!(Observation::from_parts([("a", &[1][..], &[1.0][..]), ("a", &[1], &[1.0])]).is_err());
    }
}
