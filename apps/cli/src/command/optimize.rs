//! `opendr optimize`: quantises a model to INT8 or converts it to FP16.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgGroup, ArgMatches, Command, value_parser};
use opendr::dataset::ExternalDataset;
use opendr::evaluation::DatasetOpener;
use opendr::model::Model;
use opendr::optimize::{OptimizeJob, OptimizeOptions, Report};
use opendr::params::{Field, ParamValue, Params};
use opendr::{Progress, Result};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{dataset_flags, learner_flags, loading, stdout};

const EXAMPLES: &str = "\
Examples:
  opendr optimize nanodet --fp16 --out half                          FP16, half the size
  opendr optimize nanodet --int8 --calibration photos/ --out small   INT8, a quarter of the size
  opendr optimize runs/mine/model --int8 --calibration coco/ --calibration-split train2017 \\
    --validation coco/ --validation-split val2017 --out small        ... with the metric before and after

The output is an ordinary model container: opendr infer LEARNER --model small street.jpg";

/// Parameter that `--int8` and `--fp16` set.
const PRECISION: &str = "precision";
/// Parameter whose flag is `--calibration-method`, since `--calibration` names the data set.
const METHOD: &str = "calibration";

pub fn grammar() -> Command {
    let rules = rules().map(|field| {
        let flag = learner_flags::param_flag("Options of --int8", field);
        if field.name == METHOD { flag.long("calibration-method") } else { flag }
    });
    Command::new("optimize")
        .about("Quantise a model to INT8, or convert it to FP16")
        .arg(
            Arg::new("source")
                .required(true)
                .value_name("LEARNER[/VARIANT]|CONTAINER")
                .help("Pretrained model, or path of a container"),
        )
        .args(["int8", "fp16"].map(|name| {
            let help = format!(
                "Convert to {}",
                if name == "int8" { "8-bit weights and activations" } else { "16-bit weights" }
            );
            Arg::new(name).long(name).action(ArgAction::SetTrue).help(help)
        }))
        .group(ArgGroup::new(PRECISION).args(["int8", "fp16"]).required(true))
        .args(data_flags(
            "calibration",
            "Images from which --int8 measures the ranges of activations; a folder is enough",
        ))
        .args(data_flags("validation", "Evaluate on this data set before and after"))
        .arg(
            Arg::new("out")
                .long("out")
                .alias("output")
                .short('o')
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .value_name("DIR")
                .help("Folder to write the model into"),
        )
        .arg(Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print a JSON object"))
        .arg(dataset_flags::skip_broken_flag())
        .args(rules)
        .args([loading::device_flag(), loading::threads(), loading::offline(), loading::quiet()])
        .after_help(EXAMPLES)
}

/// Returns the flags of a data set: path, format and split.
fn data_flags(name: &'static str, help: &'static str) -> [Arg; 3] {
    let [data, format, split] = data_ids(name);
    [
        Arg::new(data).long(name).value_parser(value_parser!(PathBuf)).value_name("DATASET").help(help),
        Arg::new(format)
            .long(format)
            .default_value("auto")
            .value_name("FORMAT")
            .help(format!("Format of --{name}; by default detected")),
        Arg::new(split).long(split).value_name("NAME").help(format!("Split of --{name}")),
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
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let path = loading::container(source, matches, &bar)?;
    let entry = loading::entry(&Model::open(&path)?.manifest().learner)?;
    let options = options(matches)?;
    let problems = dataset_flags::problems(matches);
    let opening = |annotated| DatasetOpener::new(entry, annotated, &problems, &bar);
    let [images, dataset] = ["calibration", "validation"].map(|name| external(name, matches));
    let split = |name| matches.get_one::<String>(data_ids(name)[2]).map(String::as_str);
    let calibration =
        images.as_ref().map(|data| opening(false).open_training(data.into(), split("calibration")));
    let validation =
        dataset.as_ref().map(|data| opening(true).open_validation(data.into(), split("validation")));
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
        stdout::print_json(Report::FORMAT, &report)?;
    } else {
        stdout::print(report.to_string().trim_end())?;
    }
    bar.note(&format!("written: {}", output.display()));
    Ok(Outcome::Done)
}

/// Returns the parameters that have their own flags.
fn rules() -> impl Iterator<Item = &'static Field> {
    OptimizeOptions::FIELDS.iter().filter(|field| field.name != PRECISION)
}

fn options(matches: &ArgMatches) -> Result<OptimizeOptions> {
    let mut params = learner_flags::values(rules(), matches)?;
    let precision = if matches.get_flag("int8") { "int8" } else { "fp16" };
    params.insert(PRECISION.to_owned(), ParamValue::Text(precision.to_owned()));
    OptimizeOptions::from_map(&params)
}

/// Returns the data set of `--calibration` or `--validation`.
fn external(name: &str, matches: &ArgMatches) -> Option<ExternalDataset> {
    let [data, format, _] = data_ids(name);
    let path = matches.get_one::<PathBuf>(data)?;
    Some(ExternalDataset::new(path, matches.get_one::<String>(format).cloned().unwrap_or_default()))
}
