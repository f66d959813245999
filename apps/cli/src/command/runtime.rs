//! `opendr runtime`: what runs networks here.

use clap::{ArgMatches, Command};
use opendr::Result;
use opendr::inference::{SessionOptions, describe, runtimes};

use crate::exit::Outcome;

pub fn grammar() -> Command {
    Command::new("runtime")
        .about("Show which runtime runs networks, or install ONNX Runtime")
        .subcommand(Command::new("list").about("Every runtime that was found, with its devices"))
        .subcommand(Command::new("install").about("Get ONNX Runtime's library through pip into the cache"))
        .after_help("Examples:\n  opendr runtime\n  opendr runtime install")
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    match matches.subcommand_name() {
        _ => {
            println!("in use: {}", describe(SessionOptions::default())?);
            for runtime in runtimes() {
                let devices: Vec<_> = runtime.devices().iter().map(ToString::to_string).collect();
                println!("found: {} on {}", runtime.describe(), devices.join(", "));
            }
        }
    }
    Ok(Outcome::Done)
}
