//! Images without annotations, e.g. for distillation, in which a teacher labels them.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::{Error, Result, Value};

use crate::folder::{PICTURES, files_in, folders_in, past_end};

/// Largest depth of nested folders.
const MAX_DEPTH: usize = 8;

/// The images in a folder and in the folders inside it, sorted by name, without targets.
#[derive(Debug, Clone)]
pub struct UnlabelledImages {
    root: PathBuf,
    /// File names relative to the root.
    names: Vec<String>,
}

impl UnlabelledImages {
    /// Returns whether `path` contains images.
    pub fn are_in(path: &Path) -> bool {
        path.is_dir() && Self::open(path).is_ok()
    }

    /// Opens the folder `path`.
    ///
    /// # Errors
    /// `NotFound` if it contains no images.
    pub fn open(path: &Path) -> Result<Self> {
        let mut names = Vec::new();
        collect(path, "", 0, &mut names);
        if names.is_empty() {
            let (path, kinds) = (path.display(), PICTURES.join(", "));
            return Err(Error::not_found(format!("no images ({kinds}) in {path}")));
        }
        Ok(Self { root: path.to_owned(), names })
    }
}

fn collect(folder: &Path, prefix: &str, depth: usize, names: &mut Vec<String>) {
    names.extend(files_in(folder, PICTURES).into_iter().map(|name| format!("{prefix}{name}")));
    // A symbolic link may form a cycle.
    if depth < MAX_DEPTH {
        for name in folders_in(folder) {
            collect(&folder.join(&name), &format!("{prefix}{name}/"), depth + 1, names);
        }
    }
}

impl Dataset for UnlabelledImages {}

impl DatasetIterator for UnlabelledImages {
    fn len(&self) -> usize {
        self.names.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let path = self.path(index).ok_or_else(|| past_end(index, self.len()))?;
        Ok(Sample { data: vec![Value::Image(opendr_vision::open(path)?)], target: None })
    }

    fn target(&self, _index: usize) -> Result<Option<Value>> {
        Ok(None)
    }

    fn name(&self, index: usize) -> String {
        self.names.get(index).cloned().unwrap_or_else(|| index.to_string())
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.names.get(index).map(|name| self.root.join(name))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::folder::TemporaryFolder;

    #[test]
    fn images_of_all_folders_are_in_order() {
        let folder = TemporaryFolder::new();
        assert!(!UnlabelledImages::are_in(folder.path()));
        for name in ["b.png", "a/2.png", "a/1.bmp"] {
            folder.picture(name, 3, 2);
        }
        std::fs::write(folder.path().join("notes.txt"), "").unwrap();
        let pictures = UnlabelledImages::open(folder.path()).unwrap();
        assert_eq!((0..3).map(|at| pictures.name(at)).collect::<Vec<_>>(), ["b.png", "a/1.bmp", "a/2.png"]);
        assert!(matches!(&pictures.get(2).unwrap().data[..], [Value::Image(image)] if image.width() == 3));
        assert!(pictures.get(3).is_err());
    }
}
