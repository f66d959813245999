//! `opendr tune`: searches the hyperparameters of a training, or the parameters of inference.

use std::path::PathBuf;
use std::sync::{Mutex, PoisonError};
use std::time::Duration;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::params::ParamMap;
use opendr::rl::EvaluationProtocol;
use opendr::tuning::{StudyRecord, line_from_study, table_from_study};
use opendr::{Error, FitOptions, Progress, Result, STUDY_JOURNAL, Silent, TuneData, TuneOptions, Tuned};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{curves, dataset_flags, environment_flags, learner_flags, loading, stdout, viewing};

const EXAMPLES: &str = "\
Examples:
  opendr tune ppo --env CartPole-v1 --search learning_rate=1e-5..1e-2 --search n_steps=32,64,128,256 --length 50000
  opendr tune image_classifier digits/ --val-split test --search lr --search width=8,16,32 --length 500
  opendr tune ppo --env CartPole-v1 --search gamma --out runs/tuned --trials 100     resume in the same folder
  opendr tune byte_track MOT17/ --split train --search new_threshold --search track_buffer=10..60    no training
  opendr tune nanodet coco/ --split val2017 --inference --search iou_threshold

A trial pauses while others have better values, and may resume later from its checkpoint. OUTPUT/study.log is a journal that
Optuna reads. After Ctrl-C the same command resumes the study. Several processes may share one study.";

/// Number of trials in the live table.
const LIVE_ROWS: usize = 12;

pub fn grammar() -> Command {
    Command::new("tune")
        .about("Search the hyperparameters of a learner's training, or the parameters of its inference")
        .arg(loading::learner())
        .arg(dataset_flags::dataset())
        .args(dataset_flags::flags())
        .arg(
            Arg::new("val-split")
                .long("val-split")
                .value_name("NAME")
                .help("Split of DATASET on which each training is evaluated"),
        )
        .arg(Arg::new("inference").long("inference").alias("answers").action(ArgAction::SetTrue).conflicts_with("val-split").help(
            "Search the learner's own parameters, evaluated on DATASET, without training; the default for learners that do not train",
        ))
        .arg(
            Arg::new("metric")
                .long("metric")
                .value_name("NAME")
                .help("Metric of a search without training [default: the task's metric]"),
        )
        .args(search_flags())
        .args(loading::flags())
        .after_help(EXAMPLES)
}

fn number(name: &'static str, default: &'static str, help: &'static str) -> Arg {
    let parser = value_parser!(u64).range(1..=1_000_000_000);
    Arg::new(name).long(name).default_value(default).value_parser(parser).value_name("N").help(help)
}

fn search_flags() -> [Arg; 11] {
    [
        Arg::new("search")
            .long("search")
            .action(ArgAction::Append)
            .value_name("NAME[=LOW..HIGH|=A,B]")
            .help("Parameter of the training (or of the learner) to search: over its own range, a given range, or listed values; may be repeated"),
        number("trials", "30", "Total number of configurations, including those of earlier calls"),
        number("tuning-seeds", "3", "Seeds of each configuration that completes"),
        number("length", "100000", "Steps of a complete training"),
        number("evaluations", "9", "Evaluations during a training"),
        number("jobs", "1", "Trials that run at the same time"),
        Arg::new("pruner")
            .long("pruner")
            .default_value("asha")
            .value_parser(["asha", "median", "hyperband", "none"])
            .help("Pruner that stops or pauses trials"),
        Arg::new("timeout")
            .long("timeout")
            .value_parser(value_parser!(f64))
            .value_name("SECONDS")
            .help("Start no new work after this time"),
        Arg::new("out")
            .long("out").alias("output")
            .short('o')
            .value_parser(value_parser!(PathBuf))
            .value_name("DIR")
            .help("Folder of the study [default: runs/tune-LEARNER-DATE]"),
        Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print a JSON object"),
        viewing::flag(),
    ]
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let options = options(entry, matches)?;
    let output = match matches.get_one::<PathBuf>("out") {
        Some(output) => output.clone(),
        None => FitOptions::default().output_folder(&format!("tune-{}", entry.spec.name))?,
    };
    bar.note(&format!("output: {}", output.display()));
    let curves = curves::of_study(output.join(STUDY_JOURNAL));
    let _viewer = viewing::of_curves(entry.spec.class, curves, matches, &bar)?;
    let last_line = Mutex::new(String::new());
    let watch = |study: &StudyRecord, number: usize| {
        if bar.is_live() {
            return bar.status(&format!("\n{}", table_from_study(study, LIVE_ROWS)));
        }
        // A trial that continues with another seed yields the same line.
        let (line, mut last_line) =
            (line_from_study(study, number), last_line.lock().unwrap_or_else(PoisonError::into_inner));
        if line != *last_line {
            bar.note(&line);
            *last_line = line;
        }
    };
    let tuned = if environment_flags::is_policy(entry) {
        let env = environment_flags::source(matches, None)?;
        let episodes = matches.get_one::<u64>("episodes").copied().unwrap_or(20);
        let protocol = EvaluationProtocol { episodes, ..EvaluationProtocol::default() };
        let data = TuneData::Environment { env: &env, protocol: &protocol };
        opendr::tune(entry, data, &options, &output, &watch, &bar)?
    } else if matches.get_flag("inference") || !entry.capabilities.fit {
        let external = dataset_flags::external(matches);
        let split = dataset_flags::split(matches);
        let metric = matches.get_one::<String>("metric").map(String::as_str);
        // The first load downloads the model with a progress bar; later loads use the cache.
        loading::load(spec, &options.params, matches, &bar)?;
        let make = |params: &ParamMap| loading::load(spec, params, matches, &Silent);
        let dataset = DatasetRef::External(&external);
        let data = TuneData::Inference { make: &make, dataset, split: split.as_deref(), metric };
        opendr::tune(entry, data, &options, &output, &watch, &bar)?
    } else {
        let external = dataset_flags::external(matches);
        let (split, val_split) = (dataset_flags::split(matches), matches.get_one::<String>("val-split"));
        let data = dataset(&external, split.as_deref(), val_split.map(String::as_str))?;
        opendr::tune(entry, data, &options, &output, &watch, &bar)?
    };
    print_tuned(&tuned, matches, &bar)
}

fn dataset<'a>(
    external: &'a ExternalDataset,
    split: Option<&'a str>,
    val_split: Option<&'a str>,
) -> Result<TuneData<'a>> {
    let val_split = val_split.ok_or_else(|| {
        Error::invalid_param("no split to evaluate on; name one other than the training split by --val-split")
    })?;
    let dataset = DatasetRef::External(external);
    Ok(TuneData::Dataset { dataset, val_dataset: dataset, split, val_split: Some(val_split) })
}

fn options(entry: &'static opendr::learner::Entry, matches: &ArgMatches) -> Result<TuneOptions> {
    let number = |name: &str| matches.get_one::<u64>(name).copied().unwrap_or(1);
    let small = |name: &str| usize::try_from(number(name)).unwrap_or(usize::MAX);
    let fit_params = learner_flags::fit_params(entry, matches)?;
    let seed = fit_params.get("seed").and_then(|seed| seed.as_float()).unwrap_or(0.0);
    let length = number("length");
    Ok(TuneOptions {
        search: matches.get_many::<String>("search").into_iter().flatten().cloned().collect(),
        fit_params,
        params: learner_flags::params(entry, matches)?,
        trials: small("trials"),
        seeds: small("tuning-seeds"),
        steps: length,
        interval: length.div_ceil(number("evaluations")),
        pruner: matches.get_one::<String>("pruner").cloned().unwrap_or_default(),
        jobs: small("jobs"),
        timeout: matches.get_one::<f64>("timeout").map(|seconds| Duration::from_secs_f64(seconds.max(0.0))),
        seed: seed as u64,
        device: loading::device(matches)?,
    })
}

fn print_tuned(tuned: &Tuned, matches: &ArgMatches, bar: &ProgressBar) -> Result<Outcome> {
    if matches.get_flag("json") {
        stdout::print_json(Tuned::FORMAT, tuned)?;
    } else {
        stdout::print(tuned.to_string().trim_end())?;
    }
    if !tuned.complete {
        bar.note("stopped; the same command resumes");
    }
    Ok(Outcome::Done)
}
