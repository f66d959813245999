//! Keys of classes.

use std::fmt;
use std::sync::Arc;

use opendr_engine::target::{Classes, Name};

/// A class: its index in the data set, or its label if the data set has no index for it.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord, Hash)]
pub(crate) enum ClassKey {
    /// All classes together.
    Any,
    /// Index.
    Number(i64),
    /// Label.
    Label(Arc<str>),
}

impl ClassKey {
    /// Creates the key of `name` with the class names `own`, as an index into the classes `known` of the data set.
    pub(crate) fn new(name: &Name, own: &Classes, known: &Classes) -> Self {
        let label = match name {
            Name::Label(label) => Some(label),
            Name::Index(index) if !known.is_empty() && own != known => own.name(*index),
            Name::Index(_) => None,
        };
        match (label, name) {
            (Some(label), _) => known.index(label).map_or_else(|| Self::Label(label.clone()), Self::Number),
            (None, Name::Index(index)) => Self::Number(*index),
            (None, Name::Label(label)) => Self::Label(label.clone()),
        }
    }

    /// Returns the name of the class, from the classes `known` of the data set.
    pub(crate) fn label(&self, known: &Classes) -> String {
        match self {
            Self::Number(index) => {
                known.name(*index).map_or_else(|| self.to_string(), |name| name.to_string())
            }
            _ => self.to_string(),
        }
    }
}

impl fmt::Display for ClassKey {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Any => f.write_str("any"),
            Self::Number(index) => write!(f, "{index}"),
            Self::Label(label) => f.write_str(label),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn keys_are_indices_of_the_data_set() {
        let known: Classes = ["cat", "dog"].into_iter().collect();
        let own: Classes = ["dog", "kite"].into_iter().collect();
        let key = |name: Name, own: &Classes| ClassKey::new(&name, own, &known);
        assert_eq!(key(Name::Index(1), &known), ClassKey::Number(1));
        assert_eq!(key(Name::Index(0), &own), ClassKey::Number(1));
        assert_eq!(key(Name::Index(1), &own), ClassKey::Label("kite".into()));
        assert_eq!(key("cat".into(), &Classes::default()), ClassKey::Number(0));
        assert_eq!(key(Name::Index(7), &Classes::default()), ClassKey::Number(7));
        assert_eq!(ClassKey::Number(1).label(&known), "dog");
    }
}
