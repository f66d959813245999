//! Samples in a folder for each class.

use std::path::{Path, PathBuf};

use opendr_engine::target::{Category, Classes};
use opendr_engine::{Result, Value};

use crate::folder::{folders_in, past_end};

/// Names of parts; the first existing one is used.
pub(crate) const SPLITS: [&str; 4] = ["val", "validation", "test", "train"];

/// Samples with their class index.
#[derive(Debug)]
pub(crate) struct ClassFolders {
    pub root: PathBuf,
    pub classes: Classes,
    /// Class index and path within the root.
    pub samples: Vec<(u32, String)>,
}

impl ClassFolders {
    /// Lists the folders in `root` as classes, in the order of their names. `things_in` returns the files of a
    /// folder, and folders without any are skipped; `meaning` returns the class name of a folder.
    pub fn new(
        root: PathBuf,
        things_in: impl Fn(&Path) -> Vec<String>,
        meaning: impl Fn(String) -> String,
    ) -> Self {
        let (mut names, mut samples) = (Vec::new(), Vec::new());
        for folder in folders_in(&root) {
            let things = things_in(&root.join(&folder));
            if !things.is_empty() {
                let class = names.len() as u32;
                samples.extend(things.into_iter().map(|thing| (class, format!("{folder}/{thing}"))));
                names.push(meaning(folder));
            }
        }
        Self { root, classes: names.into(), samples }
    }

    /// Returns the path of a sample.
    ///
    /// # Errors
    /// `NotFound` past the end.
    pub fn file(&self, index: usize) -> Result<PathBuf> {
        Ok(self.root.join(&self.sample(index)?.1))
    }

    /// Returns the class of a sample.
    ///
    /// # Errors
    /// `NotFound` past the end.
    pub fn target(&self, index: usize) -> Result<Option<Value>> {
        let class = i64::from(self.sample(index)?.0);
        let description = self.classes.name(class).cloned();
        Ok(Some(Category { description, ..Category::new(class, None) }.into()))
    }

    /// Returns the path of a sample within the root, or its index past the end.
    pub fn name(&self, index: usize) -> String {
        self.sample(index).map_or_else(|_| index.to_string(), |(_, name)| name.clone())
    }

    fn sample(&self, index: usize) -> Result<&(u32, String)> {
        self.samples.get(index).ok_or_else(|| past_end(index, self.samples.len()))
    }
}
