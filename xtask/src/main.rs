//! The chores of this repository: `cargo xtask test`, `cargo xtask realtime`.

mod realtime;
mod shell;
mod test;
mod tools;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask VERB

  test       everything that CI checks; installs what it needs (Debian packages, a Python environment in target/)
  realtime   fail when a task has no learner at 25 frames a second in 1 GB on 2 cores

environment:
  OPENDR_TEST_DATA   folder with models/ and data/; tests that need it are skipped without";

fn main() -> ExitCode {
    let verb = std::env::args().nth(1);
    let done = match verb.as_deref() {
        Some("test") => test::run(),
        Some("realtime") => realtime::run(),
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("xtask: {error}");
            ExitCode::FAILURE
        }
    }
}
