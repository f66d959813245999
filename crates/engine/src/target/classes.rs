//! Class names of a model.

use std::fmt;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use crate::target::Name;

/// The class names of a model, shared by all its predictions; clones allocate nothing.
#[derive(Debug, Clone, Default, PartialEq, Eq, Serialize, Deserialize)]
#[serde(from = "Vec<String>", into = "Vec<String>")]
pub struct Classes(Option<Arc<[Arc<str>]>>);

impl Classes {
    /// Returns the name of class `index`, if there is one.
    pub fn name(&self, index: i64) -> Option<&Arc<str>> {
        self.0.as_deref()?.get(usize::try_from(index).ok()?)
    }

    /// Returns the index of the class `name`.
    pub fn index(&self, name: &str) -> Option<i64> {
        self.iter().position(|class| class == name).map(|index| index as i64)
    }

    /// Returns the label of a class: the label itself, or the name of the class index.
    pub fn label<'a>(&'a self, name: &'a Name) -> Option<&'a str> {
        match name {
            Name::Label(label) => Some(label),
            Name::Index(index) => self.name(*index).map(AsRef::as_ref),
        }
    }

    /// Writes the label, or `class 3` if there is no name.
    pub(super) fn write_label(&self, name: &Name, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self.label(name) {
            Some(label) => f.write_str(label),
            None => write!(f, "class {name}"),
        }
    }

    /// Returns the number of class names.
    pub fn len(&self) -> usize {
        self.0.as_deref().map_or(0, <[_]>::len)
    }

    /// Returns whether there are no class names.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns the names, in order.
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
