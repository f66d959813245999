//! The chores of this repository: `cargo xtask test`, `cargo xtask test-c`, `cargo xtask ros`, `cargo xtask realtime`, `cargo xtask install-c PREFIX`.

mod checks;
mod generate;
mod inputs;
mod install_c;
mod junit;
mod parity;
mod realtime;
mod ros;
mod rust_tests;
mod shell;
mod ship;
mod speed;
mod surfaces;
mod test;
mod tools;
mod wheel;

use std::process::ExitCode;

const USAGE: &str = "\
usage: cargo xtask VERB

  test       everything that CI checks; installs what it needs (Debian packages, Python environments in target/);
             what has passed in this build folder and has not changed since is left out
  test --all
             that, with nothing left out
  ship       the wheels that users get, in the profile dist, and the tests of what they are
  test-extended
             the tests that need PyTorch, with the interpreter OPENDR_TORCH_PYTHON
  test-c     the part of it that tests the C library
  ros        the part of it that tests messages and nodes beside real ROS peers
  ros --zenoh
             the command with the feature zenoh beside a Zenoh router and peer; no part of the test command
  generate   write stubs, C headers and docs/learners.md, which are made of the registry
  realtime   fail when a task has no learner at 25 frames a second in 1 GB on 2 cores
  realtime --write
             that, and write what was measured into the cards; on a machine with nothing else to do
  install-c PREFIX
             the C library with its headers, pkg-config file and CMake package under PREFIX

environment:
  OPENDR_TEST_DATA   folder with models/ and data/; tests that need it are skipped without";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let done = match words.iter().map(String::as_str).collect::<Vec<_>>()[..] {
        ["test"] => test::run(false),
        ["test", "--all"] => test::run(true),
        ["ship"] => ship::run(),
        ["test-extended"] => test::run_extended(),
        ["test-c"] => test::run_c(),
        ["ros"] => ros::run_alone(),
        ["ros", "--zenoh"] => ros::run_zenoh(),
        ["generate"] => generate::run(),
        ["realtime"] => realtime::run(),
        ["realtime", "--write"] => realtime::run_and_write(),
        ["install-c", prefix] => install_c::run(prefix.as_ref()),
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
