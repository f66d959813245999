//! What the class numbers of a model mean.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::target::Name;

/// The class names of a model, shared by every target that it answers; cloning allocates nothing.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<String>", into = "Vec<String>")]
pub struct Classes(Option<Arc<[Arc<str>]>>);

impl Classes {
    /// The name of class `index`, where there is one.
    pub fn name(&self, index: i64) -> Option<&Arc<str>> {
        self.0.as_deref()?.get(usize::try_from(index).ok()?)
    }

    /// The number of the class called `name`.
    pub fn index(&self, name: &str) -> Option<i64> {
        self.iter().position(|class| class == name).map(|index| index as i64)
    }

    /// What a box calls its class: its own label, or the class name under its number.
    pub fn label<'a>(&'a self, name: &'a Name) -> Option<&'a str> {
        match name {
            Name::Label(label) => Some(label),
            Name::Index(index) => self.name(*index).map(AsRef::as_ref),
        }
    }

    /// The label, or `class 3`.
    pub(super) fn write_label(&self, name: &Name, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.label(name) {
            Some(label) => f.write_str(label),
            None => write!(f, "class {name}"),
        }
    }

    /// How many classes are named.
    pub fn len(&self) -> usize {
        self.0.as_deref().map_or(0, <[_]>::len)
    }

    /// Whether no class is named.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// The names in order.
    pub fn iter(&self) -> impl Iterator<Item = &str> {
        self.0.as_deref().unwrap_or_default().iter().map(AsRef::as_ref)
    }
}

impl<S: Into<Arc<str>>> FromIterator<S> for Classes {
    fn from_iter<I: IntoIterator<Item = S>>(names: I) -> Self {
        let names: Arc<[Arc<str>]> = names.into_iter().map(Into::into).collect();
        Self((!names.is_empty()).then_some(names))
    }
}

impl From<Vec<String>> for Classes {
    fn from(names: Vec<String>) -> Self {
        names.into_iter().collect()
    }
}

impl From<Classes> for Vec<String> {
    fn from(classes: Classes) -> Self {
        classes.iter().map(str::to_owned).collect()
    }
}
