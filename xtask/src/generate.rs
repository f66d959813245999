//! `cargo xtask generate`: writes the generated files that are checked in.

use crate::pages;
use crate::shell::{Result, command, root, step, target};
use crate::surfaces::TEST_LEARNER;
use crate::wheel;

/// Writes the ROS messages, the type stubs of Python, `docs/{learners,metrics,datasets}.md`, OpenDR's names in `docs/python.md`, the
/// tables of the crates, the models and OpenDR's classes, the diagram of the layers and the C headers. Tests fail if they are not up to
/// date.
pub fn run() -> Result<()> {
    let mut messages = command("cargo");
    messages.args(["test", "-p", "opendr-message-generator", "--test", "messages"]).env("OPENDR_UPDATE", "1");
    step("ROS messages", &mut messages)?;
    let mut topics = command("cargo");
    topics.args(["test", "-p", "opendr-cli", "--test", "suite", "topics::"]).env("OPENDR_UPDATE", "1");
    step("topics of nodes", &mut topics)?;
    let folder = target().join("generate");
    wheel::package(&folder)?;
    let mut stubs = command("python3");
    stubs.arg(root().join("bindings/python/stubs.py")).env("PYTHONPATH", &folder);
    step("stubs and pages", &mut stubs)?;
    // OpenDR's table is made from files that the step before writes.
    pages::write()?;
    let mut headers = command("cargo");
    headers.args(["test", "--workspace", TEST_LEARNER, "--test", "header"]).env("OPENDR_UPDATE", "1");
    step("C headers", &mut headers)
}
