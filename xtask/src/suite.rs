//! Suites of tests in Python.

use std::process::Command;

/// A suite of tests in Python.
pub struct Suite {
    /// Name of the check.
    pub name: &'static str,
    /// Folders of the tests, and files that they share.
    pub folders: &'static [&'static str],
    /// The program with its arguments and environment, without the report.
    pub command: Command,
    /// Hash of its other inputs.
    pub inputs: Vec<u64>,
}
