//! The files of a world.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use opendr_engine::Result;
use opendr_engine::atomic_file::{replace_file, write_error};
use opendr_engine::data::Image;

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
    /// `NotFound` when the folder of `path` does not exist, `Io` when a file cannot be written.
    pub fn save(&self, path: impl AsRef<Path>) -> Result<Vec<PathBuf>> {
        let path = path.as_ref();
        let folder = path.parent().unwrap_or(Path::new(""));
        if !folder.as_os_str().is_empty() && !folder.is_dir() {
            return Err(write_error(path, std::io::ErrorKind::NotFound.into()));
        }
        let mut written = Vec::new();
        for (name, image) in &self.textures {
            let texture = folder.join(name);
            if let Some(parent) = texture.parent() {
                std::fs::create_dir_all(parent).map_err(|error| write_error(parent, error))?;
            }
            opendr_vision::save(image, &texture)?;
            written.push(texture);
        }
        // The world last: where it is, its textures are.
        replace_file(path, self.world.as_bytes())?;
        written.push(path.to_owned());
        Ok(written)
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::ErrorKind;

    use super::*;

    #[test]
    fn a_missing_folder_is_not_created() {
        let folder = std::env::temp_dir().join(format!("opendr-missing-world-{}", std::process::id()));
        for textures in [
            BTreeMap::new(),
            BTreeMap::from([("t/a.png".to_owned(), Image::from_rgb8(vec![0; 3], 1, 1).unwrap())]),
        ] {
            let files = WorldFiles { world: "#VRML_SIM R2025a utf8".to_owned(), textures };
            let error = files.save(folder.join("world.wbt")).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::NotFound, "{error}");
            assert!(!folder.exists() && error.to_string().contains("folder does not exist"), "{error}");
        }
    }
}
