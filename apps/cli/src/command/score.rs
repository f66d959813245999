//! `opendr score`: evaluates a file of predictions against a data set.

use std::path::PathBuf;

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::evaluation::{self, ClassMatching, Evaluation, FilePredictions, Subject};
use opendr::{Error, Result, datasets, inference, metrics};

use crate::command::eval;
use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{class_flags, dataset_flags, loading};

const EXAMPLES: &str = "\
Examples:
  opendr score results.json coco/annotations/instances_val2017.json --metric coco_detection
  opendr score predictions.jsonl coco/ --metric coco_detection  lines of \"opendr infer --json\"
  opendr score tracker/ MOT17/train/ --metric hota              files in the data set's own format
  opendr score results/ KITTI/ --metric kitti --predictions-format kitti";

pub fn grammar() -> Command {
    Command::new("score")
        .about("Evaluate predictions that were written into files")
        .arg(
            Arg::new("predictions")
                .required(true)
                .value_name("PREDICTIONS")
                .value_parser(value_parser!(PathBuf))
                .help("COCO results, lines of JSON, or a data set whose annotations are the predictions"),
        )
        .arg(dataset_flags::dataset())
        .args(dataset_flags::flags())
        .arg(
            Arg::new("predictions-format")
                .long("predictions-format")
                .alias("answers-format")
                .value_name("FORMAT")
                .help("Format of the predictions [default: that of DATASET]"),
        )
        .args(eval::metric_flags())
        .args(class_flags::flags())
        .args([loading::threads(), loading::quiet()])
        .after_help(EXAMPLES)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let name = matches.get_one::<String>("metric").ok_or_else(|| {
        let names: Vec<_> = metrics::metrics().iter().map(|entry| entry.name).collect();
        Error::invalid_param(format!("name a metric with --metric; there are {}", names.join(", ")))
    })?;
    let metric = metrics::find(name)?;
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let problems = dataset_flags::problems(matches);
    let external = dataset_flags::external(matches);
    let path = matches.get_one::<PathBuf>("predictions").cloned().unwrap_or_default();
    let split = dataset_flags::split(matches);
    if evaluation::is_coco_results(&path)? {
        let params = eval::metric_params(metric, matches)?;
        let threads = inference::default_threads()?;
        let mut outcome = evaluation::score_coco_results(metric, &params, &path, &external, split, threads)?;
        if let Some(folder) = matches.get_one::<PathBuf>("out") {
            outcome.write_report(folder)?;
        }
        return eval::print_outcome(&outcome, matches, &problems, &bar);
    }
    let dataset = evaluation::open_for_metric(metric, &external, split, &problems)?;
    let format = match matches.get_one::<String>("predictions-format") {
        Some(format) => format,
        None => datasets::format_of(&external)?.name,
    };
    let predictions = FilePredictions::open(&path, format, metric, dataset.as_ref(), &problems)?;
    let subject = Subject { learner: path.display().to_string(), ..Subject::default() };
    let evaluation = Evaluation {
        dataset: external.path().display().to_string(),
        metric_params: eval::metric_params(metric, matches)?,
        classes: ClassMatching {
            pairs: class_flags::pairs("classes", matches)?,
            by_number: matches.get_flag("by-number"),
        },
        folder: matches.get_one::<PathBuf>("out").map(PathBuf::as_path),
        progress: &bar,
        ..Evaluation::new(subject, metric, &problems)
    };
    let outcome = evaluation.score(&predictions, dataset.as_ref())?;
    eval::print_outcome(&outcome, matches, &problems, &bar)
}
