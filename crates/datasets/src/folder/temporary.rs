//! A folder for one test, deleted afterwards.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU32, Ordering};

pub(crate) struct TemporaryFolder(PathBuf);

impl TemporaryFolder {
    pub(crate) fn new() -> Self {
        static NUMBER: AtomicU32 = AtomicU32::new(0);
        let number = NUMBER.fetch_add(1, Ordering::Relaxed);
        let path = std::env::temp_dir().join(format!("opendr-datasets-{}-{number}", std::process::id()));
        fs::create_dir_all(&path).unwrap();
        Self(path)
    }

    pub(crate) fn path(&self) -> &Path {
        &self.0
    }

    /// Writes a file and the folders above it.
    pub(crate) fn with(self, name: &str, bytes: impl AsRef<[u8]>) -> Self {
        super::write_file(&self.0.join(name), bytes.as_ref()).unwrap();
        self
    }

    /// Writes a file and the folders above it, and returns its path.
    pub(crate) fn write(&self, name: &str, bytes: impl AsRef<[u8]>) -> PathBuf {
        let path = self.0.join(name);
        super::write_file(&path, bytes.as_ref()).unwrap();
        path
    }

    /// Writes an image whose pixels depend on their position, and returns its path.
    pub(crate) fn picture(&self, name: &str, width: usize, height: usize) -> PathBuf {
        let path = self.write(name, "");
        let samples = (0..width * height * 3).map(|at| (at % 251) as u8).collect();
        let image = opendr_engine::data::Image::from_rgb8(samples, width, height).unwrap();
        opendr_vision::save(&image, &path).unwrap();
        path
    }

    /// Writes a small image.
    pub(crate) fn with_picture(self, name: &str) -> Self {
        let image = opendr_engine::data::Image::from_rgb8(vec![200; 4 * 3 * 3], 4, 3).unwrap();
        fs::create_dir_all(self.0.join(name).parent().unwrap()).unwrap();
        opendr_vision::save(&image, self.0.join(name)).unwrap();
        self
    }
}

impl Drop for TemporaryFolder {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).ok();
    }
}

/// Returns the folder of real test data, if it exists.
pub(crate) fn real_data(name: &str) -> Option<PathBuf> {
    let Some(root) = std::env::var_os("OPENDR_TEST_DATA") else {
        println!("skipped: no OPENDR_TEST_DATA");
        return None;
    };
    Some(PathBuf::from(root).join("data").join(name))
}
