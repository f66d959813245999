//! The `opendr` command.

use std::process::ExitCode;

fn main() -> ExitCode {
    ExitCode::from(opendr_cli::run(std::env::args_os()))
}
