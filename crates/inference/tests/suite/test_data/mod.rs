//! Where the models and pictures for tests are.

use std::env;
use std::path::PathBuf;

/// The folder with models and data; `None`, said aloud, where there is none.
pub fn test_data() -> Option<PathBuf> {
    let root = env::var_os("OPENDR_TEST_DATA").map(PathBuf::from);
    if root.is_none() {
        eprintln!("skipped: no OPENDR_TEST_DATA");
    }
    root
}
