//! From what the user typed to a loaded learner.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use opendr::learner::{AnyLearner, Entry};
use opendr::params::ParamMap;
use opendr::zoo::{Zoo, ZooOptions};
use opendr::{Device, Progress, Result, inference};

/// Learners that work at once; each holds a model.
const MAX_WORKERS: usize = 4;
/// With fewer samples for each, loading one more learner takes longer than it spares.
const SAMPLES_A_WORKER: u64 = 8;

/// The id of the argument that names the learner.
pub const LEARNER: &str = "learner";

/// The argument that names the learner.
pub fn learner() -> Arg {
    Arg::new(LEARNER)
        .required(true)
        .value_name("LEARNER[/VARIANT]")
        .help("What to run (see \"opendr models\")")
}

/// The flags of every command that runs a learner.
pub fn flags() -> [Arg; 5] {
    [
        device_flag(),
        threads(),
        Arg::new("model")
            .long("model")
            .value_parser(value_parser!(PathBuf))
            .value_name("PATH")
            .help("A model container of your own instead of the pretrained one"),
        offline(),
        quiet(),
    ]
}

/// The flag that says where to run.
pub fn device_flag() -> Arg {
    Arg::new("device")
        .long("device")
        .default_value("auto")
        .value_name("DEVICE")
        .help(format!("Where to run: {}", Device::NAMES.join(", ")))
}

/// The flag that says how many cores may be used.
pub fn threads() -> Arg {
    Arg::new("threads")
        .long("threads")
        .value_parser(value_parser!(u16))
        .value_name("N")
        .help("Threads that work, 0 for all cores [env: OPENDR_THREADS]")
}

/// The flag that keeps off the network.
pub fn offline() -> Arg {
    Arg::new("offline").long("offline").action(ArgAction::SetTrue).help("Never use the network")
}

/// The flag that hides progress.
pub fn quiet() -> Arg {
    Arg::new("quiet")
        .long("quiet")
        .short('q')
        .action(ArgAction::SetTrue)
        .help("Print results and errors only")
}

/// The learner that the user named, by its registry or class name, with or without a variant.
///
/// # Errors
/// `NotFound`, with the names that there are.
pub fn entry(spec: &str) -> Result<&'static Entry> {
    opendr::registry().find(spec.split('/').next().unwrap_or(spec))
}

/// The zoo as environment and flags set it up.
///
/// # Errors
/// `NotFound` when there is no folder for the cache.
pub fn zoo(matches: &ArgMatches) -> Result<Zoo> {
    let mut options = ZooOptions::from_env()?;
    options.offline |= matches.get_flag("offline");
    Zoo::new(options)
}

/// The device that environment and flags name.
///
/// # Errors
/// `InvalidParam` for what is no device.
pub fn device(matches: &ArgMatches) -> Result<Device> {
    let device: Device = matches.get_one::<String>("device").map_or("auto", String::as_str).parse()?;
    device.or_environment()
}

/// Calls `work` with sessions that take as many threads as `--threads` says, where a command has that.
pub fn with_threads<R>(matches: &ArgMatches, work: impl FnOnce() -> R) -> R {
    match matches.try_get_one::<u16>("threads") {
        Ok(Some(&threads)) => inference::with_threads(threads.into(), work),
        _ => work(),
    }
}

/// Makes and loads the learner, downloading its model where it is not cached.
///
/// # Errors
/// `InvalidParam` for a parameter that does not fit, else what kept the model from being got or loaded.
pub fn load(
    spec: &str,
    params: &ParamMap,
    matches: &ArgMatches,
    progress: &dyn Progress,
) -> Result<Box<dyn AnyLearner>> {
    let Some(path) = matches.get_one::<PathBuf>("model") else {
        return load_pretrained(spec, params, matches, progress);
    };
    let mut learner = entry(spec)?.make(params, device(matches)?)?;
    learner.load(path)?;
    Ok(learner)
}

/// As [`load`], never a model of the user's own.
///
/// # Errors
/// As [`load`].
pub fn load_pretrained(
    spec: &str,
    params: &ParamMap,
    matches: &ArgMatches,
    progress: &dyn Progress,
) -> Result<Box<dyn AnyLearner>> {
    let mut learner = entry(spec)?.make(params, device(matches)?)?;
    learner.load(&pretrained(spec, matches, progress)?)?;
    Ok(learner)
}

/// The container of the pretrained model, downloaded where it is not cached.
///
/// # Errors
/// What kept it from being got.
pub fn pretrained(spec: &str, matches: &ArgMatches, progress: &dyn Progress) -> Result<PathBuf> {
    let entry = entry(spec)?;
    let variant = spec.split_once('/').map_or(String::new(), |(_, variant)| format!("/{variant}"));
    zoo(matches)?.get(&format!("{}{variant}", entry.spec.name), progress)
}

/// The container that `source` is: one of the user's own, or a pretrained model.
///
/// # Errors
/// As [`pretrained`].
pub fn container(source: &str, matches: &ArgMatches, progress: &dyn Progress) -> Result<PathBuf> {
    match Path::new(source).exists() {
        true => Ok(PathBuf::from(source)),
        false => pretrained(source, matches, progress),
    }
}

/// How many learners work on `samples` that have nothing to do with each other. On a processor, side by side uses the
/// cores better than several threads on one sample do.
///
/// # Errors
/// `InvalidParam` for a device or a number of threads that there is none of.
pub fn how_many(matches: &ArgMatches, samples: Option<u64>) -> Result<usize> {
    if inference::device(device(matches)?)? != Device::Cpu {
        return Ok(1);
    }
    let worth = samples.unwrap_or(0) / SAMPLES_A_WORKER;
    let most = inference::default_threads()?.min(MAX_WORKERS);
    Ok(usize::try_from(worth).unwrap_or(most).clamp(1, most))
}

/// `count` loaded learners, or pipelines of some, that share the threads.
///
/// # Errors
/// As `load`.
pub fn side_by_side<T>(count: usize, load: impl Fn() -> Result<T>) -> Result<Vec<T>> {
    let threads = (inference::default_threads()? / count).max(1);
    (0..count).map(|_| inference::with_threads(threads, &load)).collect()
}
