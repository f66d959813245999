//! Location of the models and images for tests.

use std::env;
use std::path::PathBuf;

/// Returns the folder with models and data; `None`, with a message, where there is none.
pub fn test_data() -> Option<PathBuf> {
    let root = env::var_os("OPENDR_TEST_DATA").map(PathBuf::from);
    if root.is_none() {
        eprintln!("skipped: no OPENDR_TEST_DATA");
    }
    root
}
