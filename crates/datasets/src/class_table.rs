//! Classes of a data set that is written, collected from its targets.

use std::collections::HashMap;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::DatasetIterator;
use opendr_engine::target::{Classes, Name};
use opendr_engine::{Error, Result, Value};

use crate::folder::path_inside;

/// Largest number of classes; a larger class index is an error in the data.
const MAX_CLASSES: usize = 1 << 16;

/// Class names by index; unknown labels get the next index.
#[derive(Debug, Default)]
pub(crate) struct ClassTable {
    names: Vec<String>,
    numbers: HashMap<String, usize>,
    /// Whether the data set names its classes, so that other indices are errors.
    named: bool,
}

impl ClassTable {
    /// Starts with the classes of a data set.
    pub fn new(classes: &Classes) -> Self {
        let mut table = Self { named: !classes.is_empty(), ..Self::default() };
        classes.iter().for_each(|name| table.push(name));
        table
    }

    /// Returns the index of a class; `own` are the class names of its target, used if the data set has none.
    ///
    /// # Errors
    /// `InvalidInput` for an index that is not a class.
    pub fn number(&mut self, name: &Name, own: &Classes) -> Result<usize> {
        match (name, own.label(name)) {
            (Name::Label(_), Some(label)) => Ok(self.labelled(label)),
            (Name::Index(_), Some(label)) if !self.named => Ok(self.labelled(label)),
            (Name::Label(label), None) => Ok(self.labelled(label)),
            (Name::Index(index), _) => {
                let most = if self.named { self.names.len() } else { MAX_CLASSES };
                let number = usize::try_from(*index).ok().filter(|number| *number < most);
                let number = number.ok_or_else(|| {
                    Error::invalid_input(format!(
                        "class {index} is not one of the {most} classes, numbered from 0"
                    ))
                })?;
                while self.names.len() <= number {
                    self.push(&self.names.len().to_string());
                }
                Ok(number)
            }
        }
    }

    /// Returns the class index of sample `index`, and the folder of its class in `root`.
    ///
    /// # Errors
    /// `InvalidInput` if its target is not a category or the name is not valid for a folder; errors of reading the
    /// target.
    pub fn folder(
        &mut self,
        dataset: &dyn DatasetIterator,
        index: usize,
        root: &Path,
    ) -> Result<(usize, PathBuf)> {
        let Some(Value::Category(category)) = dataset.target(index)? else {
            return Err(Error::invalid_input("class folders support categories only, no other targets"));
        };
        let own = match &category.description {
            Some(description) if dataset.classes().is_empty() => description.as_ref().into(),
            _ => category.class.into(),
        };
        let class = self.number(&own, &Classes::default())?;
        let folder = self.names[class].replace(['/', '\\', ':'], "_");
        Ok((class, path_inside(root, &folder).map_err(Error::invalid_input)?))
    }

    /// Returns the names in the order of their indices.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    fn labelled(&mut self, label: &str) -> usize {
        if let Some(number) = self.numbers.get(label) {
            return *number;
        }
        self.push(label);
        self.names.len() - 1
    }

    fn push(&mut self, name: &str) {
        self.numbers.entry(name.to_owned()).or_insert(self.names.len());
        self.names.push(name.to_owned());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn labels_are_added_and_wrong_indices_are_errors() {
        let classes: Classes = ["cat", "dog"].into_iter().collect();
        let mut table = ClassTable::new(&classes);
        let number = |table: &mut ClassTable, name: Name| table.number(&name, &Classes::default());
        assert_eq!(number(&mut table, "dog".into()).unwrap(), 1);
        assert_eq!(number(&mut table, "cow".into()).unwrap(), 2);
        assert_eq!(number(&mut table, 0.into()).unwrap(), 0);
        assert!(number(&mut table, 3.into()).is_err() && number(&mut table, (-1).into()).is_err());
        let mut nameless = ClassTable::new(&Classes::default());
        assert_eq!(number(&mut nameless, 2.into()).unwrap(), 2);
        assert_eq!(nameless.names(), ["0", "1", "2"]);
        assert_eq!(nameless.number(&1.into(), &classes).unwrap(), 3);
        assert_eq!(nameless.names()[3], "dog");
    }
}
