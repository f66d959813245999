//! Running other programs.

use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::time::Instant;

/// An error is a line for the person at the terminal.
pub type Result<T, E = String> = std::result::Result<T, E>;

/// The root of the repository.
pub fn root() -> PathBuf {
    // Asked at run time: a build folder that several checkouts share keeps this program.
    let here = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from("xtask"), PathBuf::from);
    here.parent().unwrap_or(&here).to_owned()
}

/// Where cargo builds.
pub fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// A program in the root of the repository.
pub fn command(program: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root());
    command
}

/// Runs a step, says what it is and how long it took.
pub fn step(name: &str, command: &mut Command) -> Result<()> {
    println!("\n=== {name}: {}", line(command));
    let start = Instant::now();
    let status =
        command.status().map_err(|error| format!("{name}: cannot run {}: {error}", line(command)))?;
    println!("=== {name}: {:.0} s", start.elapsed().as_secs_f64());
    if status.success() { Ok(()) } else { Err(format!("{name} failed ({status}): {}", line(command))) }
}

/// What a program prints on standard output.
pub fn output(command: &mut Command) -> Result<String> {
    let done = command.stdin(Stdio::null()).stderr(Stdio::inherit()).output();
    let done = done.map_err(|error| format!("cannot run {}: {error}", line(command)))?;
    if !done.status.success() {
        return Err(format!("{} failed ({})", line(command), done.status));
    }
    String::from_utf8(done.stdout).map_err(|error| format!("{}: {error}", line(command)))
}

/// Whether a program is installed.
pub fn is_installed(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// A command as one would type it.
pub fn line(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}
