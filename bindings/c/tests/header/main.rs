//! `include/opendr.h` is made here: what the library exports, and what follows from the types and the registry.
//! `cargo xtask generate` writes it anew.
//!
//! A program of its own, so that to write it anew links no other test of the workspace.

#![allow(clippy::unwrap_used)]

mod declarations;
mod learner_functions;
mod value_functions;

use std::path::{Path, PathBuf};
use std::{env, fs};

const GUARD: (&str, &str) = ("#ifndef OPENDR_H\n#define OPENDR_H\n", "#endif /* OPENDR_H */\n");

/// The learner made for tests has a header of its own.
const TEST_LEARNER: &str = "counter";

fn package() -> PathBuf {
    PathBuf::from(env::var_os("CARGO_MANIFEST_DIR").unwrap())
}

fn check(path: &Path, rendered: &str) {
    if env::var_os("OPENDR_UPDATE").is_some() {
        fs::write(path, rendered).unwrap();
    }
    let found = fs::read_to_string(path).unwrap_or_default();
    let stale = found.lines().zip(rendered.lines()).find(|(found, rendered)| found != rendered);
    assert!(found == rendered, "{} is stale ({stale:?}); run cargo xtask generate", path.display());
}

#[test]
fn header_is_what_the_library_has() {
    let entries = opendr::registry().entries();
    let learners = entries.iter().filter(|entry| entry.spec.name != TEST_LEARNER);
    let learners: Vec<_> = learners.map(|entry| learner_functions::of_entry(entry)).collect();
    let parts = [
        GUARD.0.to_owned(),
        declarations::render(&package().join("src")),
        value_functions::render(),
        learner_functions::INTRODUCTION.to_owned(),
        learners.join("\n"),
        GUARD.1.to_owned(),
    ];
    check(&package().join("include/opendr.h"), &parts.join("\n"));
}

#[test]
fn header_of_the_test_learner() {
    let Ok(entry) = opendr::registry().find(TEST_LEARNER) else {
        println!("skipped: built without the feature test-learner of opendr");
        return;
    };
    let header = format!("#include <opendr.h>\n\n{}", learner_functions::of_entry(entry));
    check(&package().join("tests/opendr_counter.h"), &header);
}
