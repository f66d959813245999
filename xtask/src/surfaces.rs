//! The programs that tests start, in one build.

use std::path::PathBuf;

use crate::shell::{Result, command, step, target};

/// Feature of the test learner, which every build for tests has.
pub const TEST_LEARNER: &str = "--features=opendr/test-learner";

/// The examples that tests start.
pub const EXAMPLES: [&str; 23] = [
    "bag_copy",
    "bag_dump",
    "coco_files",
    "compute",
    "data",
    "episodes",
    "export_all",
    "follow",
    "infer_json",
    "log",
    "message_echo",
    "message_types",
    "mfcc",
    "own_module",
    "ros1_probe",
    "run_onnx",
    "serve_environments",
    "shrink",
    "signals",
    "slow_node",
    "tfjs_to_onnx",
    "tflite_to_onnx",
    "trajectory_errors",
];

/// Returns the arguments of `cargo build` for the command, the C library, `examples/rust` and [`EXAMPLES`], with the test learner. Packages
/// and features are those of the tests, so that nothing is compiled twice; only the wheel's module is compiled again, for Python.
pub fn arguments() -> Vec<&'static str> {
    let words = ["build", "--workspace", "--lib", "--bins", TEST_LEARNER];
    words.into_iter().chain(EXAMPLES.into_iter().flat_map(|name| ["--example", name])).collect()
}

/// Builds the command, the C library and the examples.
pub fn build() -> Result<()> {
    step("command, C library and examples", command("cargo").args(arguments()))
}

/// Returns the path of an example.
pub fn example(name: &str) -> PathBuf {
    target().join("debug/examples").join(name)
}

/// Returns the path of the command.
pub fn opendr() -> PathBuf {
    target().join("debug/opendr")
}

/// Returns the built programs that exist, for their hashes.
pub fn programs() -> impl Iterator<Item = PathBuf> {
    let others = ["libopendr_c.so", "libopendr_c.a", "opendr-examples"];
    let others = others.map(|name| target().join("debug").join(name));
    let examples = EXAMPLES.iter().map(|name| example(name));
    std::iter::once(opendr()).chain(others).chain(examples).filter(|path| path.is_file())
}
