//! The tests in Rust; programs that have not changed since they passed are skipped.

use std::collections::BTreeSet;
use std::fs;
use std::path::PathBuf;
use std::process::Command;
use std::time::Instant;

use serde_json::Value;

use crate::checks::{Checks, Output};
use crate::inputs::{Tree, of_file};
use crate::junit::{self, Outcome};
use crate::pages;
use crate::shell::{Result, is_installed, output, root};

/// Name of the check.
const NAME: &str = "tests";

/// A test program of the workspace.
struct Program {
    id: String,
    path: PathBuf,
    /// Folder of its package, relative to the root.
    package: String,
}

/// Runs the tests of every crate with the arguments `build` of cargo. `programs` is the hash of the programs that the tests start.
/// Returns whether they passed.
pub fn run(
    checks: &Checks,
    tree: Option<&Tree>,
    programs: u64,
    cargo: &dyn Fn(&[&str]) -> Command,
    build: &[&str],
) -> Result<bool> {
    if !is_installed("cargo-nextest") {
        // Without nextest: all tests of a program in one process, with a less precise report.
        return checks.run(NAME, None, Output::Live, None, cargo(&["test", "--no-fail-fast"]).args(build));
    }
    let start = Instant::now();
    let found = list(cargo, build)?;
    let inputs = found
        .iter()
        .map(|program| tree.map(|tree| inputs_of(tree, program, programs)).transpose())
        .collect::<Result<Vec<_>>>()?;
    let part = |program: &Program| format!("tests of {}", program.id);
    let changed: Vec<_> = found
        .iter()
        .zip(&inputs)
        .filter(|(program, inputs)| !checks.has_passed(&part(program), **inputs))
        .collect();
    println!(
        "=== {NAME}: {} test programs, {} of them changed since they passed ({:.0} s to build and compare)",
        found.len(),
        changed.len(),
        start.elapsed().as_secs_f64()
    );
    // Nextest writes its reports into the workspace, independent of cargo's build folder.
    let report = root().join("target/nextest/default/junit.xml");
    let mut nextest = cargo(&["nextest", "run", "--no-tests", "pass"]);
    nextest.args(build);
    if changed.is_empty() {
        let all = Some(0);
        checks.keep(NAME, all)?;
        return Ok(checks.is_unchanged(NAME, all));
    }
    if changed.len() < found.len() {
        let wanted: Vec<_> =
            changed.iter().map(|(program, _)| format!("binary_id(={})", program.id)).collect();
        nextest.args(["--filterset", &wanted.join(" | ")]);
    }
    let passed = checks.run(NAME, None, Output::Live, Some(report.clone()), &mut nextest)?;
    let tests = if report.is_file() { junit::read(&report)? } else { Vec::new() };
    let [ran, failed] = [None, Some(Outcome::Failed)].map(|outcome| -> BTreeSet<String> {
        let of = tests.iter().filter(|test| outcome.is_none_or(|outcome| test.outcome == outcome));
        of.filter_map(|test| Some(test.name.split_once(' ')?.0.to_owned())).collect()
    });
    for (program, inputs) in changed {
        // A program without tests is not in the report.
        if !failed.contains(&program.id) && (passed || ran.contains(&program.id)) {
            checks.keep(&part(program), *inputs)?;
        }
    }
    fs::remove_file(report).ok();
    Ok(passed)
}

/// Builds the test programs and lists them.
fn list(cargo: &dyn Fn(&[&str]) -> Command, build: &[&str]) -> Result<Vec<Program>> {
    let mut list = cargo(&["nextest", "list", "--list-type", "binaries-only", "--message-format", "json"]);
    let listed = output(list.args(build))?;
    let listed: Value =
        serde_json::from_str(&listed).map_err(|error| format!("cargo nextest list: {error}"))?;
    let programs = listed["rust-binaries"].as_object().into_iter().flatten();
    programs
        .map(|(id, program)| {
            let text = |key: &str| {
                program[key].as_str().ok_or_else(|| format!("cargo nextest list: no {key} of {id}"))
            };
            let package = text("package-id")?;
            let folder = package.split_once("file://").map_or(package, |(_, folder)| folder);
            let folder = folder.split_once('#').map_or(folder, |(folder, _)| folder);
            let root = root().to_string_lossy().into_owned();
            let package = folder.strip_prefix(&root).unwrap_or(folder).trim_start_matches('/').to_owned();
            Ok(Program { id: id.clone(), path: PathBuf::from(text("binary-path")?), package })
        })
        .collect()
}

/// Returns the hash of the inputs of a program's tests: the program, the files of its package, files that any test may read, and
/// programs that it starts.
fn inputs_of(tree: &Tree, program: &Program, programs: u64) -> Result<u64> {
    let folder = format!("{}/", program.package);
    // The command's own tests start the command; those of the facade use all models.
    let starts = if program.package == "apps/cli" { programs } else { 0 };
    let is_of_pages = |file: &str| program.package == "xtask" && pages::is_input(file);
    Ok(tree.of(
        |file| {
            !file.ends_with(".rs") && (file.starts_with(&folder) || is_read_by_tests(file))
                || is_of_pages(file)
        },
        &[of_file(&program.path)?, starts],
    ))
}

/// Returns whether tests in Rust may read a file outside their package: cards, cases, pages, generated headers.
fn is_read_by_tests(file: &str) -> bool {
    let folders = ["models/", "tests/cases/", "docs/", "ros/", "bindings/c/", "crates/messages/", "fuzz/"];
    !file.contains('/') || folders.iter().any(|folder| file.starts_with(folder))
}
