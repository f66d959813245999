//! Runs the fuzzing corpus of the C API: no entry may crash it.

#[path = "../../../../fuzz/c_calls.rs"]
mod c_calls;

use std::fs;
use std::path::Path;

#[test]
fn calls_are_refused_or_answered() {
    let corpus = Path::new(&std::env::var("CARGO_MANIFEST_DIR").unwrap()).join("../../fuzz/corpus/c_calls");
    let mut files = 0;
    for file in fs::read_dir(corpus).unwrap() {
        c_calls::run(&fs::read(file.unwrap().path()).unwrap());
        files += 1;
    }
    assert!(files > 0, "the corpus is empty");
}
