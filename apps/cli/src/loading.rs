//! From what the user typed to a loaded learner.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use opendr::inference::SessionOptions;
use opendr::learner::{AnyLearner, Entry};
use opendr::zoo::{Zoo, ZooOptions};
use opendr::{Device, Progress, Result};

use crate::learner_flags;

/// The flags of every command that runs a learner.
pub fn flags() -> [Arg; 5] {
    [
        Arg::new("device").long("device").default_value("auto").value_name("DEVICE").help(format!(
            "Where to run: {}",
            Device::NAMES.join(", ")
        )),
        Arg::new("threads").long("threads").value_parser(value_parser!(usize)).value_name("N").help(
            "Threads that work on one picture; 0 takes all cores [env: OPENDR_THREADS]",
        ),
        Arg::new("model").long("model").value_parser(value_parser!(PathBuf)).value_name("PATH").help(
            "A model container of your own instead of the pretrained one",
        ),
        Arg::new("offline").long("offline").action(ArgAction::SetTrue).help("Never use the network"),
        Arg::new("quiet").long("quiet").short('q').action(ArgAction::SetTrue).help("Print results and errors only"),
    ]
}

/// The learner that the user named, by its registry or class name, with or without a variant.
pub fn entry(spec: &str) -> Result<&'static Entry> {
    opendr::registry().find(spec.split('/').next().unwrap_or(spec))
}

/// The zoo as environment and flags set it up.
pub fn zoo(matches: &ArgMatches) -> Result<Zoo> {
    let mut options = ZooOptions::from_env()?;
    options.offline |= matches.get_flag("offline");
    Zoo::new(options)
}

/// The device that the user named.
pub fn device(matches: &ArgMatches) -> Result<Device> {
    let name = matches.get_one::<String>("device").map_or("auto", String::as_str);
    name.parse::<Device>()?.or_environment()
}

/// Puts `--threads` where sessions look for it. Called before any thread is started.
pub fn set_threads(matches: &ArgMatches) {
    if let Some(threads) = matches.get_one::<usize>("threads") {
        // SAFETY: the command is still single-threaded here.
        unsafe { std::env::set_var("OPENDR_THREADS", threads.to_string()) };
    }
}

/// One line: which runtime runs on how many threads.
pub fn runtime(matches: &ArgMatches) -> Result<String> {
    opendr::inference::describe(SessionOptions::from(device(matches)?))
}

/// Makes and loads the learner, downloading its model where it is not cached.
pub fn load(
    spec: &str,
    entry: &'static Entry,
    matches: &ArgMatches,
    progress: &dyn Progress,
) -> Result<Box<dyn AnyLearner>> {
    let mut learner = entry.make(&learner_flags::params(entry, matches)?, device(matches)?)?;
    let path = match matches.get_one::<PathBuf>("model") {
        Some(path) => path.clone(),
        None => {
            let variant = spec.split_once('/').map_or(String::new(), |(_, variant)| format!("/{variant}"));
            zoo(matches)?.get(&format!("{}{variant}", entry.spec.name), progress)?
        }
    };
    learner.load(&path)?;
    Ok(learner)
}
