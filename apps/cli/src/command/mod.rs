//! The commands, one file each.

mod bench;
mod demo;
mod download;
mod infer;
mod models;
mod runtime;

use std::ffi::OsString;

use clap::{ArgMatches, Command};
use opendr::Result;
use opendr::learner::Entry;

use crate::exit::Outcome;
use crate::{learner_flags, loading};

const EXAMPLES: &str = "\
Examples:
  opendr demo                                   find people in a photograph
  opendr infer centernet street.jpg --out seen.png
  opendr infer yunet 'photos/*.jpg' --json
  opendr infer movenet/multipose dance.mp4 --out dance-poses.mp4
  opendr models --commercial

Exit codes: 0 done; 1 some inputs failed, the rest is done; 2 wrong usage; 11 InvalidInput, 12 InvalidParam,
13 NotFound, 14 Io, 15 Network, 16 Integrity, 17 Format, 18 Unsupported, 19 Device, 20 Internal; 130 Ctrl-C.";

/// The grammar. A command that runs a learner gets the flags of the one that `arguments` name.
pub fn grammar(arguments: &[OsString]) -> Command {
    let named = named_learner(arguments);
    let with_flags = |command: Command| match named {
        Some(entry) => learner_flags::add(command, entry),
        None => command,
    };
    Command::new("opendr")
        .about("OpenDR in Rust: the open deep-learning toolkit for robotics")
        .version(env!("CARGO_PKG_VERSION"))
        .after_help(EXAMPLES)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(with_flags(infer::grammar()))
        .subcommand(models::grammar())
        .subcommand(download::grammar())
        .subcommand(with_flags(bench::grammar()))
        .subcommand(runtime::grammar())
        .subcommand(demo::grammar())
}

/// Runs the command.
pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    match matches.subcommand() {
        Some(("infer", matches)) => infer::run(matches),
        Some(("models", matches)) => models::run(matches),
        Some(("download", matches)) => download::run(matches),
        Some(("bench", matches)) => bench::run(matches),
        Some(("runtime", matches)) => runtime::run(matches),
        Some(("demo", matches)) => demo::run(matches),
        _ => Ok(Outcome::Done),
    }
}

/// The learner that is named after `infer` or `bench`.
fn named_learner(arguments: &[OsString]) -> Option<&'static Entry> {
    let words: Vec<&str> = arguments.iter().skip(1).filter_map(|argument| argument.to_str()).collect();
    let (command, rest) = words.split_first()?;
    if !["infer", "bench"].contains(command) {
        return None;
    }
    rest.iter().find_map(|word| loading::entry(word).ok())
}
