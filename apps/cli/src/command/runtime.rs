//! `opendr runtime`: the runtimes that execute networks on this machine.

use clap::{ArgMatches, Command};
use opendr::Result;
use opendr::inference::{OnnxRuntime, SessionOptions, describe, runtimes};
use opendr::zoo::{ZooOptions, install_onnx_runtime};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{loading, stdout};

pub fn grammar() -> Command {
    Command::new("runtime")
        .about("Show which runtime executes networks and why, or install ONNX Runtime")
        .subcommand(
            Command::new("list").about("List the available runtimes with their devices (the default)"),
        )
        .subcommand(
            Command::new("install")
                .about("Download ONNX Runtime's library with pip into the cache")
                .args([loading::offline(), loading::quiet()]),
        )
        .disable_help_subcommand(true)
        .after_help("Examples:\n  opendr runtime\n  opendr runtime install")
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    match matches.subcommand() {
        Some(("install", matches)) => install(matches)?,
        _ => list()?,
    }
    Ok(Outcome::Done)
}

fn list() -> Result<()> {
    stdout::print(format_args!("in use: {}", describe(SessionOptions::default())?))?;
    for runtime in runtimes() {
        let devices: Vec<_> = runtime.devices().iter().map(ToString::to_string).collect();
        stdout::print(format_args!("found: {} on {}", runtime.describe(), devices.join(", ")))?;
    }
    for skipped in OnnxRuntime::skipped() {
        stdout::print(format_args!("skipped: {skipped}"))?;
    }
    Ok(())
}

fn install(matches: &ArgMatches) -> Result<()> {
    let mut options = ZooOptions::from_env()?;
    options.offline |= matches.get_flag("offline");
    let installed = install_onnx_runtime(&options, &ProgressBar::new(matches.get_flag("quiet")))?;
    stdout::print(&installed)?;
    stdout::print(format_args!("in use: {}", describe(SessionOptions::default())?))
}
