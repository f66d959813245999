//! Evaluation of a moving camera beside baselines.

use std::path::PathBuf;

use clap::ArgMatches;
use opendr::active::{
    ActiveContainer, AnyRecogniser, EnvironmentScene, EpisodeStrip, FIRST_EVALUATION_SEED, ViewRecogniser,
    calibrated, compare,
};
use opendr::learner::Entry;
use opendr::{JsonFormat, Progress as _, Result, Unit};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::viewed_environment::ViewedSource;
use crate::{environment_flags, learner_flags, loading, report_file, stdout, viewing};

const COMPARISON: JsonFormat = JsonFormat::new("comparison of camera policies", 1);
/// Number of episodes by default, and of those that calibrate the belief for another recogniser.
const EPISODES: u64 = 500;
const CALIBRATION_EPISODES: u64 = 1000;
/// Number of camera policies that are compared, and of episodes in the strip.
const CAMERA_POLICIES: u64 = 6;
const STRIP_ROWS: usize = 6;

/// Evaluates the camera policy and the baselines on the same episodes; with `--out`, writes a strip of episodes and the figures.
pub fn run(spec: &str, entry: &'static Entry, matches: &ArgMatches, bar: &ProgressBar) -> Result<Outcome> {
    let learner = loading::load(spec, &learner_flags::params(entry, matches)?, matches, bar)?;
    let source = environment_flags::source(matches, Some(learner.as_ref()))?;
    let mut container = ActiveContainer::of(learner.as_ref())?;
    let other = matches.get_one::<String>(RECOGNISER);
    let make = || -> Result<Box<dyn ViewRecogniser>> {
        let Some(name) = other else { return Ok(Box::new(container.recogniser.clone())) };
        let entry = loading::entry(name)?;
        let mut recogniser = entry.make(&Default::default(), loading::device(matches)?)?;
        match matches.get_one::<PathBuf>(RECOGNISER_MODEL) {
            Some(path) => recogniser.load(path)?,
            None => recogniser.load(&loading::pretrained(name, matches, bar)?)?,
        }
        Ok(Box::new(AnyRecogniser::new(recogniser.as_ref(), entry, container.recogniser.config().classes)?))
    };
    let scene = || EnvironmentScene::new(&source, make()?);
    if other.is_some() {
        bar.begin("calibrating the belief", None, Unit::Items);
        let model = calibrated(&container.model, &scene, CALIBRATION_EPISODES, bar);
        bar.end();
        container.model = model?;
    }
    let episodes = matches.get_one("episodes").copied().unwrap_or(EPISODES);
    let first_seed = matches.get_one("first-seed").copied().unwrap_or(FIRST_EVALUATION_SEED);
    let viewed = ViewedSource::new(&source, viewing::of_items(entry.spec.class, matches, bar)?);
    let viewed = EnvironmentScene::new(&viewed, make()?)?;
    bar.begin("episodes", Some(CAMERA_POLICIES * episodes), Unit::Items);
    let comparison = compare(viewed, &container.model, first_seed, episodes, bar);
    bar.end();
    let comparison = comparison?;
    if let Some(folder) = matches.get_one::<PathBuf>("out") {
        std::fs::create_dir_all(folder)?;
        let strip = EpisodeStrip::run(scene()?, &container.model, first_seed, STRIP_ROWS)?;
        ["episodes.png", "episodes.gif"].into_iter().try_for_each(|name| strip.save(&folder.join(name)))?;
        report_file::write(COMPARISON, &comparison, folder)?;
        bar.note(&format!("written: episodes.png, episodes.gif and report.json in {}", folder.display()));
    }
    if matches.get_flag("json") {
        stdout::print_json(COMPARISON, &comparison)?;
    } else {
        stdout::print(format_args!("{spec} in {}, {episodes} episodes\n", source.id()))?;
        stdout::print(comparison.to_string().trim_end())?;
    }
    Ok(Outcome::Done)
}

/// Learner in place of the model's recogniser, and its container.
const RECOGNISER: &str = "recogniser";
const RECOGNISER_MODEL: &str = "recogniser-model";

/// Adds the flags of the recogniser.
pub fn add_recogniser(command: clap::Command) -> clap::Command {
    let recogniser = clap::Arg::new(RECOGNISER).long(RECOGNISER).value_name("LEARNER").help(
        "Learner of images with classes, in place of the model's recogniser; the belief is calibrated for it",
    );
    let model = clap::Arg::new(RECOGNISER_MODEL)
        .long(RECOGNISER_MODEL)
        .requires(RECOGNISER)
        .value_parser(clap::value_parser!(PathBuf))
        .value_name("PATH")
        .help("Model container of --recogniser, instead of its pretrained model");
    command.args([recogniser, model])
}
