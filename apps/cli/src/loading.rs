//! Loading of the learner that the command line names.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches, value_parser};
use opendr::learner::{AnyLearner, Entry};
use opendr::model::{MANIFEST_NAME, Model};
use opendr::params::ParamMap;
use opendr::zoo::{Zoo, ZooOptions};
use opendr::{Device, Error, Progress, Result, inference};

/// Maximum number of copies of a learner that run in parallel.
const MAX_WORKERS: usize = 4;
/// Minimum number of samples per copy of a learner; below it, loading a copy takes longer than it saves.
const SAMPLES_PER_WORKER: u64 = 8;

/// Id of the argument that names the learner.
pub const LEARNER: &str = "learner";

/// Returns the argument that names the learner.
pub fn learner() -> Arg {
    Arg::new(LEARNER)
        .required(true)
        .value_name("LEARNER[/VARIANT]|MODEL")
        .help("Learner to run (see \"opendr models\"), a model container, or an ONNX file of another tool")
}

/// Returns the flags of every command that runs a learner.
pub fn flags() -> [Arg; 5] {
    [
        device_flag(),
        threads(),
        Arg::new("model")
            .long("model")
            .value_parser(value_parser!(PathBuf))
            .value_name("PATH")
            .help("Model container to load instead of the pretrained model"),
        offline(),
        quiet(),
    ]
}

/// Returns the flag of the device.
pub fn device_flag() -> Arg {
    Arg::new("device")
        .long("device")
        .default_value("auto")
        .value_name("DEVICE")
        .help(format!("Device to run on: {}", Device::NAMES.join(", ")))
}

/// Returns the flag of the number of threads.
pub fn threads() -> Arg {
    Arg::new("threads")
        .long("threads")
        .value_parser(value_parser!(u16))
        .value_name("N")
        .help("Number of threads, 0 for all cores [env: OPENDR_THREADS]")
}

/// Returns the flag that disables the network.
pub fn offline() -> Arg {
    Arg::new("offline").long("offline").action(ArgAction::SetTrue).help("Never use the network")
}

/// Returns the flag that hides progress.
pub fn quiet() -> Arg {
    Arg::new("quiet")
        .long("quiet")
        .short('q')
        .action(ArgAction::SetTrue)
        .help("Print results and errors only")
}

/// Finds the learner by registry or class name, with or without a variant, or the learner of a model: a container, or an ONNX file
/// of another tool.
///
/// # Errors
/// `NotFound`, with the known names; the error of a model that cannot be opened.
pub fn entry(spec: &str) -> Result<&'static Entry> {
    match own_model(spec) {
        Some(path) => entry_of_model(path),
        None => named_entry(spec),
    }
}

fn named_entry(spec: &str) -> Result<&'static Entry> {
    opendr::registry().find(spec.split('/').next().unwrap_or(spec))
}

/// Returns the path of a model that is given in place of a learner; names of learners come first.
fn own_model(spec: &str) -> Option<&Path> {
    let path = Path::new(spec);
    let ends_with = |end: &str| path.extension().is_some_and(|found| found.eq_ignore_ascii_case(end));
    let is_model =
        ends_with("onnx") || (ends_with("zip") && path.is_file()) || path.join(MANIFEST_NAME).is_file();
    (is_model && named_entry(spec).is_err()).then_some(path)
}

fn entry_of_model(path: &Path) -> Result<&'static Entry> {
    let model = Model::open(path)?;
    let name = &model.manifest().learner;
    if !name.is_empty() {
        return opendr::registry().find(name);
    }
    let onnx = model.onnx()?;
    let recognises = |entry: &&'static Entry| entry.spec.recognises_network.is_some_and(|is| is(&onnx));
    let entries = opendr::registry().entries();
    entries.iter().copied().find(recognises).ok_or_else(|| {
        let takes_networks = entries.iter().filter(|entry| entry.spec.recognises_network.is_some());
        let names: Vec<_> = takes_networks.map(|entry| entry.spec.name).collect();
        Error::unsupported(format!(
            "{} names no learner, and nothing in it states which of {} its network is; write \"LEARNER --model {0}\"",
            path.display(),
            names.join(", ")
        ))
    })
}

/// Returns the zoo with the options of environment and flags.
///
/// # Errors
/// `NotFound` without a folder for the cache.
pub fn zoo(matches: &ArgMatches) -> Result<Zoo> {
    let mut options = ZooOptions::from_env()?;
    options.offline |= matches.get_flag("offline");
    Zoo::new(options)
}

/// Returns the device that flags or environment name.
///
/// # Errors
/// `InvalidParam` for an unknown device.
pub fn device(matches: &ArgMatches) -> Result<Device> {
    let device: Device = matches.get_one::<String>("device").map_or("auto", String::as_str).parse()?;
    device.or_environment()
}

/// Calls `work` with sessions of `--threads` threads, if the command has that flag.
pub fn with_threads<R>(matches: &ArgMatches, work: impl FnOnce() -> R) -> R {
    match matches.try_get_one::<u16>("threads") {
        Ok(Some(&threads)) => inference::with_threads(threads.into(), work),
        _ => work(),
    }
}

/// Creates and loads the learner; downloads its model if it is not cached.
///
/// # Errors
/// `InvalidParam` for a wrong parameter; the error of the download or of loading.
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

/// As [`load`], but ignores `--model`.
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

/// Returns the path of the pretrained model's container, which is downloaded if it is not cached, or of the given model.
///
/// # Errors
/// The error of the download.
pub fn pretrained(spec: &str, matches: &ArgMatches, progress: &dyn Progress) -> Result<PathBuf> {
    if let Some(path) = own_model(spec) {
        return Ok(path.to_owned());
    }
    let entry = entry(spec)?;
    let variant = spec.split_once('/').map_or(String::new(), |(_, variant)| format!("/{variant}"));
    zoo(matches)?.get(&format!("{}{variant}", entry.spec.name), progress)
}

/// Returns the path of the model: that of `--model`, or the pretrained one.
///
/// # Errors
/// As [`pretrained`].
pub fn model(spec: &str, matches: &ArgMatches, progress: &dyn Progress) -> Result<PathBuf> {
    match matches.get_one::<PathBuf>("model") {
        Some(path) => Ok(path.clone()),
        None => pretrained(spec, matches, progress),
    }
}

/// Returns the path of the container `source`: an existing path, or a pretrained model.
///
/// # Errors
/// As [`pretrained`].
pub fn container(source: &str, matches: &ArgMatches, progress: &dyn Progress) -> Result<PathBuf> {
    match Path::new(source).exists() {
        true => Ok(PathBuf::from(source)),
        false => pretrained(source, matches, progress),
    }
}

/// Returns the number of copies of a learner for `samples` independent samples. On a CPU, several single-threaded copies use the
/// cores better than several threads per sample; on other devices it is 1.
///
/// # Errors
/// `InvalidParam` for an unknown device or an invalid number of threads.
pub fn copies(matches: &ArgMatches, samples: Option<u64>) -> Result<usize> {
    if inference::device(device(matches)?)? != Device::Cpu {
        return Ok(1);
    }
    let worth = samples.unwrap_or(0) / SAMPLES_PER_WORKER;
    let most = inference::default_threads()?.min(MAX_WORKERS);
    Ok(usize::try_from(worth).unwrap_or(most).clamp(1, most))
}

/// Loads `count` learners or pipelines, among which the threads are divided.
///
/// # Errors
/// As `load`.
pub fn load_copies<T>(count: usize, load: impl Fn() -> Result<T>) -> Result<Vec<T>> {
    let threads = (inference::default_threads()? / count).max(1);
    (0..count).map(|_| inference::with_threads(threads, &load)).collect()
}
