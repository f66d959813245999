//! The parser of this crate, for the fuzzers: it may refuse what it is given, it may not panic.

use std::path::Path;

use crate::weights::WeightTable;

/// Files of weights. They go through a file in the folder of temporary ones, since checkpoints are read from there.
pub fn weights(bytes: &[u8]) {
    let path = std::env::temp_dir().join(format!("opendr-fuzz-weights-{}", std::process::id()));
    if std::fs::write(&path, bytes).is_ok() {
        weights_file(&path);
        std::fs::remove_file(&path).ok();
    }
}

fn weights_file(path: &Path) {
    if let Ok(table) = WeightTable::from_file(path) {
        for weight in table.weights() {
            assert_eq!(weight.shape().iter().product::<usize>(), weight.values().len());
        }
    }
}
