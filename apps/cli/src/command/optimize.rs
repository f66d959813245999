//! `opendr optimize`: a smaller and faster model.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgGroup, ArgMatches, Command, value_parser};
use opendr::dataset::ExternalDataset;
use opendr::model::Model;
use opendr::optimize::{OptimizeJob, OptimizeOptions};
use opendr::params::{Field, ParamValue, Params};
use opendr::{Opening, Progress, Result};

use crate::exit::Outcome;
use crate::progress_bar::Bar;
use crate::{dataset_flags, learner_flags, loading, stdout};

const EXAMPLES: &str = "\
Examples:
  opendr optimize nanodet --fp16 --out half                          half the size
  opendr optimize nanodet --int8 --calibration photos/ --out small   a quarter of the size, and faster
  opendr optimize runs/mine/model --int8 --calibration coco/ --calibration-split train2017 \\
    --validation coco/ --validation-split val2017 --out small        ... with the accuracy before and after

What is written is a model as any other: opendr infer LEARNER --model small street.jpg";

/// The parameter that `--int8` and `--fp16` stand for, and one whose name the flag of the data set has.
const PRECISION: &str = "precision";
const METHOD: &str = "calibration";

pub fn grammar() -> Command {
    let rules = rules().map(|field| {
        let flag = learner_flags::param_flag("Rules of --int8", field);
        if field.name == METHOD { flag.long("calibration-method") } else { flag }
    });
    Command::new("optimize")
        .about("Make a model smaller and faster: weights in 8 or 16 bits")
        .arg(
            Arg::new("source")
                .required(true)
                .value_name("LEARNER[/VARIANT]|CONTAINER")
                .help("A pretrained model, or a container of your own"),
        )
        .args(["int8", "fp16"].map(|name| {
            let help =
                format!("Weights {}", if name == "int8" { "and values in 8 bits" } else { "in 16 bits" });
            Arg::new(name).long(name).action(ArgAction::SetTrue).help(help)
        }))
        .group(ArgGroup::new(PRECISION).args(["int8", "fp16"]).required(true))
        .args(data_flags(
            "calibration",
            "Pictures that --int8 takes the ranges of values from; a folder will do",
        ))
        .args(data_flags("validation", "Measure on this data set before and after"))
        .arg(
            Arg::new("out")
                .long("out")
                .alias("output")
                .short('o')
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .value_name("DIR")
                .help("Where to write the model"),
        )
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print one object of JSON"))
        .arg(dataset_flags::skip_broken_flag())
        .args(rules)
        .args([loading::device_flag(), loading::threads(), loading::offline(), loading::quiet()])
        .after_help(EXAMPLES)
}

/// A data set, its format and its part.
fn data_flags(name: &'static str, help: &'static str) -> [Arg; 3] {
    let [data, format, split] = data_ids(name);
    [
        Arg::new(data).long(name).value_parser(value_parser!(PathBuf)).value_name("DATASET").help(help),
        Arg::new(format)
            .long(format)
            .default_value("auto")
            .value_name("FORMAT")
            .help(format!("What --{name} is; by default recognised")),
        Arg::new(split).long(split).value_name("NAME").help(format!("The part of --{name}")),
    ]
}

fn data_ids(name: &str) -> [&'static str; 3] {
    match name {
        "calibration" => ["calibration-data", "calibration-format", "calibration-split"],
        _ => ["validation-data", "validation-format", "validation-split"],
    }
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let source = matches.get_one::<String>("source").map_or("", String::as_str);
    let bar = Bar::new(matches.get_flag("quiet"));
    let path = loading::container(source, matches, &bar)?;
    let entry = loading::entry(&Model::open(&path)?.manifest().learner)?;
    let options = options(matches)?;
    let problems = dataset_flags::problems(matches);
    let opening = |annotated| Opening { entry, annotated, problems: &problems, progress: &bar };
    let [seen, measured] = ["calibration", "validation"].map(|name| external(name, matches));
    let part = |name| matches.get_one::<String>(data_ids(name)[2]).map(String::as_str);
    let calibration = seen.as_ref().map(|seen| opening(false).to_train(seen.into(), part("calibration")));
    let validation = measured.as_ref().map(|data| opening(true).to_measure(data.into(), part("validation")));
    let (calibration, validation) = (calibration.transpose()?, validation.transpose()?);
    let output = matches.get_one::<PathBuf>("out").map_or(Path::new(""), PathBuf::as_path);
    let report = OptimizeJob {
        entry,
        model: &path,
        options: &options,
        calibration: calibration.as_deref(),
        validation: validation.as_deref(),
        output,
        device: loading::device(matches)?,
        progress: &bar,
    }
    .run()?;
    if matches.get_flag("json") {
        stdout::print_json(&report)?;
    } else {
        stdout::print(report.to_string().trim_end())?;
    }
    bar.note(&format!("written: {}", output.display()));
    Ok(Outcome::Done)
}

/// The parameters that have flags of their own.
fn rules() -> impl Iterator<Item = &'static Field> {
    OptimizeOptions::FIELDS.iter().filter(|field| field.name != PRECISION)
}

fn options(matches: &ArgMatches) -> Result<OptimizeOptions> {
    let mut params = learner_flags::values(rules(), matches)?;
    let precision = if matches.get_flag("int8") { "int8" } else { "fp16" };
    params.insert(PRECISION.to_owned(), ParamValue::Text(precision.to_owned()));
    OptimizeOptions::from_map(&params)
}

/// The data set of `--calibration` or `--validation`.
fn external(name: &str, matches: &ArgMatches) -> Option<ExternalDataset> {
    let [data, format, _] = data_ids(name);
    let path = matches.get_one::<PathBuf>(data)?;
    Some(ExternalDataset::new(path, matches.get_one::<String>(format).cloned().unwrap_or_default()))
}
