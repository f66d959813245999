//! Checks: steps that pass or fail, are skipped while their inputs have not changed, and are summarised at the end.

use std::fs::{self, File};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::time::Instant;

use serde_json::json;

use crate::junit::{self, Outcome, Test};
use crate::shell::{Result, line, target};

/// Number of slow tests in the summary.
const SLOWEST: usize = 10;

/// The checks of one run.
pub struct Checks {
    /// Whether checks run even if their inputs have not changed.
    all: bool,
    done: Mutex<Vec<Check>>,
}

/// A finished check.
struct Check {
    name: String,
    state: State,
    seconds: f64,
    tests: Vec<Test>,
}

#[derive(Clone, Copy, PartialEq)]
enum State {
    Passed,
    Failed,
    Unchanged,
}

/// Destination of a check's output.
#[derive(Clone, Copy, PartialEq)]
pub enum Output {
    /// To the terminal, immediately.
    Live,
    /// To a file first and, when the check has ended, to the terminal: for checks that run in parallel.
    Kept,
}

impl Checks {
    /// Begins a run; with `all`, checks that passed with the same inputs run again.
    pub fn begin(all: bool) -> Self {
        Self { all, done: Mutex::default() }
    }

    fn done(&self) -> MutexGuard<'_, Vec<Check>> {
        self.done.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Returns whether a check passed with these inputs in this build folder; if so, records it as skipped.
    pub fn is_unchanged(&self, name: &str, inputs: Option<u64>) -> bool {
        let unchanged = !self.all && inputs.is_some() && passed_with(name) == inputs;
        if unchanged {
            println!("\n=== {name}: unchanged since it passed, skipped (--all runs it)");
            self.end(name, State::Unchanged, 0.0, Vec::new());
        }
        unchanged
    }

    /// Returns whether a part of a check passed with these inputs ([`Checks::keep`]).
    pub fn has_passed(&self, part: &str, inputs: Option<u64>) -> bool {
        !self.all && inputs.is_some() && passed_with(part) == inputs
    }

    /// Stores the inputs with which a check, or a part of one, has passed.
    pub fn keep(&self, name: &str, inputs: Option<u64>) -> Result<()> {
        let path = record(name);
        let failed = |error: std::io::Error| format!("{}: {error}", path.display());
        match inputs {
            Some(inputs) => {
                fs::create_dir_all(path.parent().unwrap_or(&path)).map_err(failed)?;
                fs::write(&path, format!("{inputs:016x}\n")).map_err(failed)
            }
            None => Ok(()),
        }
    }

    /// Runs a check of one program unless its inputs have not changed. `report` is the program's JUnit report. Returns whether
    /// the check passed.
    pub fn run(
        &self,
        name: &str,
        inputs: Option<u64>,
        output: Output,
        report: Option<PathBuf>,
        command: &mut Command,
    ) -> Result<bool> {
        if self.is_unchanged(name, inputs) {
            return Ok(true);
        }
        if let Some(report) = &report {
            // A missing file is no error.
            fs::remove_file(report).ok();
        }
        let start = Instant::now();
        let succeeded = self.execute(name, output, command)?;
        let tests = match report {
            Some(report) if report.is_file() => junit::read(&report)?,
            _ => Vec::new(),
        };
        let passed = succeeded && tests.iter().all(|test| test.outcome != Outcome::Failed);
        if passed {
            self.keep(name, inputs)?;
        }
        let state = if passed { State::Passed } else { State::Failed };
        self.end(name, state, start.elapsed().as_secs_f64(), tests);
        Ok(passed)
    }

    /// Runs a program. Returns whether it succeeded.
    fn execute(&self, name: &str, output: Output, command: &mut Command) -> Result<bool> {
        let typed = line(command);
        let cannot = |error: std::io::Error| format!("{name}: cannot run {typed}: {error}");
        if output == Output::Live {
            println!("\n=== {name}: {typed}");
            return Ok(command.status().map_err(cannot)?.success());
        }
        println!("\n=== {name}: started in parallel: {typed}");
        let path = target().join(format!("xtask/logs/{}.log", file_name(name)));
        let failed = |error: std::io::Error| format!("{}: {error}", path.display());
        fs::create_dir_all(path.parent().unwrap_or(&path)).map_err(failed)?;
        let log = File::create(&path).map_err(failed)?;
        command.stdin(Stdio::null()).stdout(log.try_clone().map_err(failed)?).stderr(log);
        let status = command.status().map_err(cannot)?;
        let written = fs::read(&path).map_err(failed)?;
        println!("\n=== {name}: {typed}\n{}", String::from_utf8_lossy(&written).trim_end());
        Ok(status.success())
    }

    fn end(&self, name: &str, state: State, seconds: f64, tests: Vec<Test>) {
        if state != State::Unchanged {
            println!("=== {name}: {seconds:.0} s");
        }
        self.done().push(Check { name: name.to_owned(), state, seconds, tests });
    }

    /// Records a check that could not run.
    pub fn fail(&self, name: &str, error: &str) {
        println!("=== {name}: {error}");
        self.end(name, State::Failed, 0.0, Vec::new());
    }

    /// Prints a line of JSON for each check, the slowest tests, and the counts of tests. Fails if a check failed.
    pub fn finish(&self) -> Result<()> {
        let done = self.done();
        println!("\n=== summary");
        for check in done.iter() {
            println!("{}", check.line());
        }
        let mut tests: Vec<_> = done.iter().flat_map(|check| &check.tests).collect();
        tests.sort_by(|a, b| b.seconds.total_cmp(&a.seconds));
        for test in tests.iter().take(SLOWEST) {
            println!("{:7.1} s  {}", test.seconds, test.name);
        }
        let count = |outcome| tests.iter().filter(|test| test.outcome == outcome).count();
        println!(
            "{} passed, {} failed, {} skipped",
            count(Outcome::Passed),
            count(Outcome::Failed),
            count(Outcome::Skipped)
        );
        let failed: Vec<_> = done
            .iter()
            .filter(|check| check.state == State::Failed)
            .map(|check| check.name.as_str())
            .collect();
        if failed.is_empty() { Ok(()) } else { Err(format!("failed: {}", failed.join(", "))) }
    }
}

impl Check {
    /// Returns the line of JSON of the check.
    fn line(&self) -> String {
        let count = |outcome| self.tests.iter().filter(|test| test.outcome == outcome).count();
        let outcome = match self.state {
            State::Passed => "passed",
            State::Failed => "failed",
            State::Unchanged => "unchanged",
        };
        let mut line =
            json!({ "step": self.name, "outcome": outcome, "seconds": (self.seconds * 10.0).round() / 10.0 });
        if !self.tests.is_empty() {
            line["passed"] = count(Outcome::Passed).into();
            line["skipped"] = count(Outcome::Skipped).into();
            let failed = self.tests.iter().filter(|test| test.outcome == Outcome::Failed);
            line["failed"] = failed.map(|test| test.name.as_str()).collect();
        }
        line.to_string()
    }
}

/// Returns the file with the inputs with which a check passed.
fn record(name: &str) -> PathBuf {
    target().join(format!("xtask/passed/{}", file_name(name)))
}

/// Returns the inputs with which a check passed last.
fn passed_with(name: &str) -> Option<u64> {
    let text = fs::read_to_string(record(name)).ok()?;
    u64::from_str_radix(text.trim(), 16).ok()
}

fn file_name(name: &str) -> String {
    name.chars().map(|letter| if letter.is_alphanumeric() { letter } else { '-' }).collect()
}
