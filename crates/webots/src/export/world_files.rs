//! The files of a world.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use opendr_engine::data::Image;
use opendr_engine::{Error, Result};

/// A world and its textures.
#[derive(Debug, Clone, PartialEq)]
pub struct WorldFiles {
    /// The world file (`.wbt`).
    pub world: String,
    /// Images by their paths (`.png`), which are relative to the world file.
    pub textures: BTreeMap<String, Image>,
}

impl WorldFiles {
    /// Writes the world to `path`, and textures into a folder beside it. Returns the written files.
    ///
    /// # Errors
    /// `Io` when a file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<Vec<PathBuf>> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        let mut written = Vec::new();
        for (name, image) in &self.textures {
            let texture = folder.join(name);
            if let Some(parent) = texture.parent() {
                std::fs::create_dir_all(parent).map_err(|error| unwritable(parent, error))?;
            }
            opendr_vision::save(image, &texture)?;
            written.push(texture);
        }
        // The world last: where it is, its textures are.
        std::fs::write(path, &self.world).map_err(|error| unwritable(path, error))?;
        written.push(path.to_owned());
        Ok(written)
    }
}

fn unwritable(path: &Path, error: std::io::Error) -> Error {
    Error::io(format!("cannot write {}", path.display())).with_source(error)
}
