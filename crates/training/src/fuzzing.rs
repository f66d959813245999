//! Entry point for the fuzzers: the parser may refuse its input, but must not panic.

use std::path::Path;

use crate::weights::WeightTable;

/// Parses weights. They are written to a temporary file, since PyTorch checkpoints are read from files.
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
