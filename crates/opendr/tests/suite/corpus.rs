//! Parsers on the corpora of the fuzzers: no input makes them panic.

#[path = "../../../../fuzz/parsers.rs"]
mod parsers;

use std::fs;
use std::path::Path;

#[test]
fn corpora_are_refused_or_read() {
    let corpora = Path::new(&std::env::var("CARGO_MANIFEST_DIR").unwrap()).join("../../fuzz/corpus");
    for (name, parse) in parsers::PARSERS {
        let mut files = 0;
        for file in fs::read_dir(corpora.join(name)).unwrap() {
            parse(&fs::read(file.unwrap().path()).unwrap());
            files += 1;
        }
        assert!(files > 0, "{name} has an empty corpus");
    }
}
