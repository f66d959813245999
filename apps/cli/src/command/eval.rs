//! `opendr eval`: evaluates a learner on a data set, or a policy in an environment.

mod active;

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::dataset::{DatasetIterator, DatasetRef};
use opendr::datasets::Problems;
use opendr::environment::EnvironmentSource as _;
use opendr::evaluation::{EvalOptions, Outcome as Evaluated, PredictedSample, SampleObserver, Subject};
use opendr::learner::Entry;
use opendr::metrics::{self, MetricEntry};
use opendr::params::ParamMap;
use opendr::rl::EvaluationProtocol;
use opendr::{Error, JsonFormat, Pipeline, Progress, Result};
use serde_json::json;

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::viewed_environment::ViewedSource;
use crate::{
    class_flags, cluster, dataset_flags, environment_flags, learner_flags, loading, named_value, report_file,
    stdout, then_flag, viewing,
};

const EXAMPLES: &str = "\
Examples:
  opendr eval LEARNER coco/ --split val2017 --out evaluated/   metrics, curves, contact sheets
  opendr eval LEARNER VOC2012/ --limit 500 --json              a JSON object
  opendr eval LEARNER/VARIANT labelled/ --format yolo --skip-broken
  opendr eval LEARNER coco/ --metric-param use_classes=false
  opendr eval nanodet MOT17/train/ --then byte_track           a pipeline, by its last learner's metric
  opendr eval LEARNER mine/ --classes lorry=truck,tram=train   classes whose names differ
  opendr eval ppo --env CartPole-v1 --episodes 500             a policy in an environment
  opendr eval ppo --env CartPole-v1 --view                     ... with its episodes on a web page
  opendr eval residual_ppo --model runs/mine/model             prior, policy and both on the same episodes
  opendr eval active_face_recognition --model MODEL --episodes 500   a moving camera, beside baselines
  opendr eval LEARNER coco/ --ray auto                         on the workers of a Ray cluster
  opendr eval td3/quad_track --env QuadTrack-v1 --online       ... adapted in flight, beside frozen and conventional

An interrupted evaluation with --out resumes when the same command runs again.";

/// Format of the statistics of a policy.
const POLICY_REPORT: JsonFormat = JsonFormat::new("evaluation of a policy", 1);

pub fn grammar() -> Command {
    Command::new("eval")
        .about("Evaluate a learner on a data set by the metric of its task")
        .arg(loading::learner())
        .arg(dataset_flags::dataset())
        .args(dataset_flags::flags())
        .args(metric_flags())
        .args(class_flags::flags())
        .arg(then_flag::flag())
        .arg(Arg::new("resamples").long("resamples").value_parser(value_parser!(usize)).value_name("N").help(
            "Bootstrap resamples for the confidence interval of the main metric; 0 omits it [default: 200]",
        ))
        .arg(
            Arg::new("limit")
                .long("limit")
                .value_parser(value_parser!(usize))
                .value_name("N")
                .help("Stop after the first N samples"),
        )
        .arg(viewing::flag())
        .arg(cluster::flag(&["view", "then", "online"]))
        .args(super::online::flags())
        .args(loading::flags())
        .after_help(EXAMPLES)
}

/// Adds the environment and the recogniser for learners of active perception.
pub fn add_for_active(command: Command) -> Command {
    active::add_recogniser(environment_flags::add_for_episodes(command))
}

/// Returns the flags of commands that compute a metric.
pub fn metric_flags() -> [Arg; 4] {
    let names: Vec<_> = metrics::metrics().iter().map(|entry| entry.name).collect();
    [
        Arg::new("metric")
            .long("metric")
            .value_name("NAME")
            .help(format!("Metric: {} (docs/metrics.md); eval uses the task's by default", names.join(", "))),
        Arg::new("metric-param")
            .long("metric-param")
            .action(ArgAction::Append)
            .value_name("NAME=VALUE")
            .help("Parameter of the metric (docs/metrics.md); may be repeated"),
        Arg::new("out")
            .long("out")
            .short('o')
            .value_parser(value_parser!(PathBuf))
            .value_name("DIR")
            .help("Write predictions, report.json, figures and contact sheets into this folder"),
        Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print a JSON object"),
    ]
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    if environment_flags::is_policy(entry) {
        return in_environment(spec, entry, matches, &bar);
    }
    if environment_flags::is_active(entry) {
        if cluster::address(matches).is_some() {
            return Err(Error::unsupported(format!(
                "{} is not evaluated on a cluster; leave out --ray",
                entry.spec.name
            )));
        }
        return active::run(spec, entry, matches, &bar);
    }
    if super::online::is_online(matches) {
        return Err(Error::invalid_param(format!(
            "--online adapts policies, and {} acts in no environment; leave it out",
            entry.spec.name
        )));
    }
    let mut options = EvalOptions {
        metric: matches.get_one("metric").cloned(),
        split: dataset_flags::split(matches),
        limit: matches.get_one("limit").copied(),
        out: matches.get_one("out").cloned(),
        skip_broken: dataset_flags::skip_broken(matches),
        classes: class_flags::pairs("classes", matches)?,
        by_number: matches.get_flag("by-number"),
        resamples: matches.get_one("resamples").copied(),
        ..EvalOptions::default()
    };
    let last = then_flag::last(entry, matches)?;
    options.metric_params = metric_params(options.metric_for(last)?, matches)?;
    if let Some(address) = cluster::address(matches) {
        let call = json!({
            "dataset": dataset_flags::described(matches),
            "options": {
                "metric": options.metric,
                "metric_params": options.metric_params,
                "split": options.split,
                "limit": options.limit,
                "out": options.out,
                "skip_broken": options.skip_broken,
                "classes": options.classes,
                "by_number": options.by_number,
                "resamples": options.resamples,
            },
            "learner": on_cluster(spec, entry, matches, &bar)?,
        });
        return cluster::run("eval", address, Evaluated::FORMAT, matches, call);
    }
    let external = dataset_flags::external(matches);
    let viewer = viewing::of_items(last.spec.class, matches, &bar)?;
    let observer = viewer.as_ref().map(|viewer| {
        |sample: PredictedSample<'_>| {
            let PredictedSample { index, name, input, outputs } = sample;
            viewer.show(viewing::shown(name.to_owned(), index as u64, input, outputs));
        }
    });
    let mut job = options.open(last, DatasetRef::External(&external))?;
    let params = learner_flags::params(entry, matches)?;
    let (learner, all_params) = then_flag::describe(spec, &params, matches)?;
    let model = matches.get_one::<PathBuf>("model").map(|path| path.display().to_string());
    let subject = Subject { learner, model, params: all_params };
    let count = loading::copies(matches, Some(job.dataset.len() as u64))?;
    let load = || loading::load(spec, &params, matches, &bar);
    job.observer = observer.as_ref().map(|observer| observer as &SampleObserver<'_>);
    let outcome = if then_flag::is_given(matches) {
        let pipeline = || then_flag::pipeline(entry, load()?.as_ref(), matches, &bar);
        let mut pipelines = loading::load_copies(count, pipeline)?;
        let ports = pipelines.first().map(|pipeline| pipeline.ports().to_vec()).unwrap_or_default();
        let classes = pipelines.first().map(Pipeline::classes).unwrap_or_default();
        job.run_pipelines(&mut pipelines, &ports, classes, subject, &bar)?
    } else {
        job.run(&mut loading::load_copies(count, load)?, entry, subject, &bar)?
    };
    print_outcome(&outcome, matches, &job.problems, &bar)
}

/// Returns the description of a learner for a cluster.
fn on_cluster(
    spec: &str,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<serde_json::Value> {
    let model = loading::model(spec, matches, bar)?;
    Ok(json!({ "name": entry.spec.name, "model": model, "params": learner_flags::params(entry, matches)? }))
}

/// Evaluates a policy in the named environment, or in the one it was trained in.
fn in_environment(
    spec: &str,
    entry: &'static Entry,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<Outcome> {
    let learner = loading::load(spec, &learner_flags::params(entry, matches)?, matches, bar)?;
    let source = environment_flags::source(matches, Some(learner.as_ref()))?;
    let mut protocol = EvaluationProtocol::default();
    if let Some(episodes) = matches.get_one::<u64>("episodes") {
        protocol.episodes = *episodes;
    }
    if let Some(seed) = matches.get_one::<u64>("first-seed") {
        protocol.first_seed = *seed;
    }
    if let Some(address) = cluster::address(matches) {
        let call = json!({
            "environment": [source.id(), source.params()],
            "episodes": protocol.episodes,
            "first_seed": protocol.first_seed,
            "learner": on_cluster(spec, entry, matches, bar)?,
        });
        return cluster::run("eval", address, POLICY_REPORT, matches, call);
    }
    let viewer = viewing::of_items(entry.spec.class, matches, bar)?;
    let mut environment = ViewedSource::new(&source, viewer).make()?;
    if super::online::is_online(matches) {
        let environment = environment.as_mut();
        return super::online::evaluate(learner.as_ref(), &source, environment, &protocol, matches, bar);
    }
    let report = opendr::evaluate_learner(learner.as_ref(), entry, environment.as_mut(), &protocol, bar)?;
    if matches.get_flag("json") {
        stdout::print_json(POLICY_REPORT, &report)?;
    } else {
        stdout::print(format_args!("{spec} in {}", source.id()))?;
        stdout::print(report.to_string().trim_end())?;
    }
    if let Some(folder) = matches.get_one::<PathBuf>("out") {
        bar.note(&format!("written: {}", report_file::write(POLICY_REPORT, &report, folder)?.display()));
    }
    Ok(Outcome::Done)
}

/// Returns the metric's parameters that the user set.
///
/// # Errors
/// `InvalidParam` for an unknown parameter or a wrong value.
pub fn metric_params(metric: &MetricEntry, matches: &ArgMatches) -> Result<ParamMap> {
    let given = matches.get_many::<String>("metric-param").into_iter().flatten();
    given.map(|text| named_value::parse("metric-param", text, metric.name, metric.params)).collect()
}

/// Prints an outcome, the skipped samples and the written files.
///
/// # Errors
/// `Io` when standard output cannot be written.
pub fn print_outcome(
    outcome: &Evaluated,
    matches: &ArgMatches,
    problems: &Problems,
    bar: &ProgressBar,
) -> Result<Outcome> {
    if matches.get_flag("json") {
        stdout::print_json(Evaluated::FORMAT, outcome)?;
    } else {
        stdout::print(outcome.to_string().trim_end())?;
        dataset_flags::print_problems(problems)?;
    }
    if !outcome.written.is_empty() {
        let written: Vec<_> = outcome.written.iter().map(|path| path.display().to_string()).collect();
        bar.note(&format!("written: {}", written.join(", ")));
    }
    Ok(if outcome.skipped == 0 { Outcome::Done } else { Outcome::SomeFailed })
}
