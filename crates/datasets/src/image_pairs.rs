//! Images, each with one annotation file.

use std::path::{Path, PathBuf};

use opendr_engine::Result;

use crate::folder::{PICTURES, files_in, past_end};
use crate::{Problem, Problems};

/// The paths of images and of their annotations.
#[derive(Debug)]
pub(crate) struct ImagePairs(Vec<[PathBuf; 2]>);

impl ImagePairs {
    /// Returns the images of a folder whose annotation `annotation_of` the image's name exists; the others are problems, of which `what`
    /// names the annotation.
    pub fn find(
        images: &Path,
        what: &str,
        annotation_of: impl Fn(&str) -> PathBuf,
        problems: &Problems,
    ) -> Result<Self> {
        let mut pairs = Vec::new();
        for name in files_in(images, PICTURES) {
            let (image, annotation) = (images.join(&name), annotation_of(&name));
            if annotation.is_file() {
                pairs.push([image, annotation]);
            } else {
                let message = format!("its {what} {} is missing", annotation.display());
                problems.report(Problem::new(image, message))?;
            }
        }
        Ok(Self(pairs))
    }

    /// Returns the number of images.
    pub fn len(&self) -> usize {
        self.0.len()
    }

    /// Returns the paths of an image and of its annotation.
    pub fn get(&self, index: usize) -> Result<&[PathBuf; 2]> {
        self.0.get(index).ok_or_else(|| past_end(index, self.len()))
    }

    /// Returns the file name of an image.
    pub fn name(&self, index: usize) -> String {
        let name = self.get(index).ok().and_then(|[image, _]| image.file_name()?.to_str());
        name.map_or_else(|| index.to_string(), str::to_owned)
    }

    /// Returns the path of an image.
    pub fn image(&self, index: usize) -> Option<PathBuf> {
        self.get(index).ok().map(|[image, _]| image.clone())
    }
}
