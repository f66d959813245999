//! Execution of other programs.

use std::io;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::sync::OnceLock;
use std::time::Instant;

/// A result whose error is a message for the terminal.
pub type Result<T, E = String> = std::result::Result<T, E>;

/// Returns the root of the repository.
pub fn root() -> PathBuf {
    // Read at run time: checkouts that share a build folder share this program.
    let here = std::env::var_os("CARGO_MANIFEST_DIR").map_or_else(|| PathBuf::from("xtask"), PathBuf::from);
    here.parent().unwrap_or(&here).to_owned()
}

/// Returns cargo's build folder.
pub fn target() -> PathBuf {
    std::env::var_os("CARGO_TARGET_DIR").map_or_else(|| root().join("target"), PathBuf::from)
}

/// Returns a command that runs in the root of the repository.
pub fn command(program: impl AsRef<std::ffi::OsStr>) -> Command {
    let mut command = Command::new(program);
    command.current_dir(root());
    command
}

/// Returns the command of another task of this program.
pub fn task(name: &str) -> Result<Command> {
    // A build replaces the file of this program, which then has another path for the system.
    static PROGRAM: OnceLock<io::Result<PathBuf>> = OnceLock::new();
    let program = PROGRAM.get_or_init(std::env::current_exe);
    let program = program.as_ref().map_err(|error| format!("path of this program: {error}"))?;
    let mut task = command(program);
    task.arg(name);
    Ok(task)
}

/// Runs a step and prints its command and duration.
pub fn step(name: &str, command: &mut Command) -> Result<()> {
    println!("\n=== {name}: {}", line(command));
    let start = Instant::now();
    let status =
        command.status().map_err(|error| format!("{name}: cannot run {}: {error}", line(command)))?;
    println!("=== {name}: {:.0} s", start.elapsed().as_secs_f64());
    if status.success() { Ok(()) } else { Err(format!("{name} failed ({status}): {}", line(command))) }
}

/// Runs a program and returns its standard output.
pub fn output(command: &mut Command) -> Result<String> {
    let done = command.stdin(Stdio::null()).stderr(Stdio::inherit()).output();
    let done = done.map_err(|error| format!("cannot run {}: {error}", line(command)))?;
    if !done.status.success() {
        return Err(format!("{} failed ({})", line(command), done.status));
    }
    String::from_utf8(done.stdout).map_err(|error| format!("{}: {error}", line(command)))
}

/// Returns whether a program is installed.
pub fn is_installed(program: &str) -> bool {
    let path = std::env::var_os("PATH").unwrap_or_default();
    std::env::split_paths(&path).any(|folder| folder.join(program).is_file())
}

/// Returns a command as a line of a shell.
pub fn line(command: &Command) -> String {
    let words = std::iter::once(command.get_program()).chain(command.get_args());
    words.map(|word| word.to_string_lossy().into_owned()).collect::<Vec<_>>().join(" ")
}
