//! Where the models and pictures for tests are.

use std::env;
use std::path::{Path, PathBuf};

/// The folder with models and data; `None`, said aloud, where there is none.
pub fn test_data() -> Option<PathBuf> {
    let root = env::var_os("OPENDR_TEST_DATA")
        .map_or_else(|| Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../shared"), PathBuf::from);
    if root.join("models").is_dir() {
        return Some(root);
    }
    eprintln!("skipped: no OPENDR_TEST_DATA");
    None
}
