//! Python's pickles of data: numbers, texts, lists, dictionaries and NumPy arrays.
//!
//! Nothing is executed: a pickle that refers to any other function or class is an error. Skeleton data sets come as
//! pickles.

use std::cell::Cell;
use std::collections::HashMap;

use opendr_engine::Result;

mod item;
mod machine;

use item::{Id, Item};
use machine::Machine;

/// The values of a pickle.
#[derive(Debug)]
pub(crate) struct Pickle {
    items: Vec<Item>,
    root: Id,
}

/// A value within a [`Pickle`].
#[derive(Debug, Clone, Copy)]
pub(crate) struct Pickled<'a> {
    pickle: &'a Pickle,
    id: Id,
}

impl Pickle {
    /// Parses a pickle of protocol 2 to 5.
    ///
    /// # Errors
    /// `Format` with the byte offset for an invalid or truncated pickle; `Unsupported` for code.
    pub(crate) fn parse(bytes: &[u8]) -> Result<Self> {
        let mut machine = Machine {
            bytes,
            at: 0,
            items: Vec::new(),
            stack: Vec::new(),
            marks: Vec::new(),
            memo: HashMap::new(),
            copied: Cell::new(0),
        };
        let root = machine.run()?;
        Ok(Self { items: machine.items, root })
    }

    /// Returns the outermost value.
    pub(crate) fn root(&self) -> Pickled<'_> {
        Pickled { pickle: self, id: self.root }
    }
}

impl<'a> Pickled<'a> {
    fn item(self) -> &'a Item {
        self.pickle.items.get(self.id).unwrap_or(&Item::None)
    }

    fn of(self, id: Id) -> Self {
        Self { id, ..self }
    }

    /// Returns the value of `key`.
    pub(crate) fn get(self, key: &str) -> Option<Self> {
        let Item::Dictionary(entries) = self.item() else { return None };
        let found = entries.iter().rev().find(|(name, _)| self.of(*name).text() == Some(key));
        found.map(|(_, value)| self.of(*value))
    }

    /// Returns the values of a list or tuple.
    pub(crate) fn list(self) -> Option<Vec<Self>> {
        let Item::List(values) = self.item() else { return None };
        Some(values.iter().map(|id| self.of(*id)).collect())
    }

    /// Returns a text.
    pub(crate) fn text(self) -> Option<&'a str> {
        match self.item() {
            Item::Text(text) => Some(text),
            Item::Bytes(bytes) => std::str::from_utf8(bytes).ok(),
            _ => None,
        }
    }

    /// Returns an integer.
    pub(crate) fn whole(self) -> Option<i64> {
        match self.item() {
            Item::Whole(number) => Some(*number),
            Item::Float(number) => Some(*number as i64),
            Item::Array(shape, ..) if shape.iter().all(|side| *side == 1) => {
                self.array()?.1.first().map(|number| *number as i64)
            }
            _ => None,
        }
    }

    /// Returns shape and values of an array; the last axis varies fastest.
    pub(crate) fn array(self) -> Option<(Vec<usize>, Vec<f64>)> {
        let Item::Array(shape, number, fortran_order, bytes) = self.item() else { return None };
        let numbers = number.numbers(bytes);
        let numbers = if *fortran_order { crate::npy::c_from_fortran(&numbers, shape) } else { numbers };
        Some((shape.clone(), numbers))
    }
}

#[cfg(test)]
mod tests;
