//! `opendr data`: checks, converts, summarises and draws data sets.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::dataset::{DatasetIterator, Subset};
use opendr::datasets::{self, DatasetStats, OpenOptions, Problems, WriteOptions};
use opendr::{JsonFormat, Progress, Result, inference};

use crate::exit::Outcome;
use crate::progress_bar::{ProgressBar, interrupted};
use crate::{dataset_flags, loading, stdout};

const EXAMPLES: &str = "\
Examples:
  opendr data formats                                    list the formats
  opendr data check coco/                                read every file and list the broken ones
  opendr data stats VOC2012/                             count classes and sizes
  opendr data view labelled/ --out sheet.png             draw a contact sheet
  opendr data convert coco/ yolo/ --to yolo --split val2017";

pub fn grammar() -> Command {
    let reads = |name: &'static str, about: &'static str| {
        Command::new(name)
            .about(about)
            .arg(dataset_flags::dataset())
            .args(dataset_flags::flags())
            .arg(loading::quiet())
    };
    let json = || Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print JSON");
    let path = |name: &'static str| Arg::new(name).value_parser(value_parser!(PathBuf));
    Command::new("data")
        .about("Check, convert, summarise and draw data sets")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands([
            Command::new("formats").about("List the formats and the files they consist of").arg(json()),
            reads("check", "Read every sample and list the broken ones").arg(json()),
            reads("stats", "Count classes and sizes").arg(json()),
            reads("view", "Draw a contact sheet of samples with their annotations").args([
                path("out")
                    .long("out")
                    .short('o')
                    .required(true)
                    .value_name("IMAGE")
                    .help("Image file to write"),
                Arg::new("count")
                    .long("count")
                    .default_value("24")
                    .value_parser(value_parser!(u64).range(1..=400))
                    .value_name("N")
                    .help("Number of samples, spread evenly over the data set"),
            ]),
            reads("convert", "Write a data set in another format").args([
                path("output").required(true).value_name("OUTPUT").help("Folder to write into"),
                Arg::new("to").long("to").required(true).value_name("FORMAT").help("Format to write"),
                Arg::new("as")
                    .long("as")
                    .value_name("NAME")
                    .help("Name of the written split: train, val2017, ..."),
                Arg::new("link")
                    .long("link")
                    .action(ArgAction::SetTrue)
                    .help("Link images instead of copying them, where the file system allows it"),
            ]),
        ])
        .after_help(EXAMPLES)
}

/// Format of the report of `data check`. Version 2 renamed `place` of a problem to `location`.
const CHECK: JsonFormat = JsonFormat::new("report of a check", 2);

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    match matches.subcommand() {
        Some(("formats", matches)) => formats(matches),
        Some(("check", matches)) => check(matches),
        Some(("stats", matches)) => stats(matches),
        Some(("view", matches)) => view(matches),
        Some(("convert", matches)) => convert(matches),
        _ => Ok(Outcome::Done),
    }
}

fn formats(matches: &ArgMatches) -> Result<Outcome> {
    if matches.get_flag("json") {
        let formats: Vec<_> = datasets::formats()
            .iter()
            .map(|format| {
                let targets: Vec<_> = format.targets.iter().map(|target| target.name()).collect();
                serde_json::json!({
                    "name": format.name, "aliases": format.aliases, "about": format.about,
                    "layout": format.layout, "targets": targets,
                })
            })
            .collect();
        stdout::print(serde_json::Value::from(formats))?;
        return Ok(Outcome::Done);
    }
    for format in datasets::formats() {
        let aliases = match format.aliases {
            [] => String::new(),
            names => format!(" (also {})", names.join(", ")),
        };
        stdout::print(format_args!("{}{aliases}: {}", format.name, format.about))?;
        format.layout.lines().try_for_each(|line| stdout::print(format_args!("    {line}")))?;
    }
    Ok(Outcome::Done)
}

fn open(matches: &ArgMatches, problems: &Problems) -> Result<Box<dyn DatasetIterator>> {
    let options = OpenOptions { split: dataset_flags::split(matches), target: None };
    datasets::open(&dataset_flags::external(matches), &options, problems)
}

fn outcome(problems: &Problems) -> Outcome {
    if problems.count() == 0 { Outcome::Done } else { Outcome::SomeFailed }
}

fn check(matches: &ArgMatches) -> Result<Outcome> {
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    // A check lists every problem instead of ending with the first.
    let problems = Problems::skipping();
    let dataset = open(matches, &problems)?;
    datasets::check(dataset.as_ref(), &problems, inference::default_threads()?, &bar)?;
    let (samples, count) = (dataset.len(), problems.count());
    if matches.get_flag("json") {
        let list = problems.list();
        let report = serde_json::json!({"samples": samples, "problems": count, "list": list});
        stdout::print_json(CHECK, &report)?;
    } else {
        dataset_flags::print_problems(&problems)?;
        let end = if interrupted() { " so far" } else { "" };
        stdout::print(format_args!("{samples} samples, {count} problems{end}"))?;
    }
    Ok(outcome(&problems))
}

fn stats(matches: &ArgMatches) -> Result<Outcome> {
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let problems = dataset_flags::problems(matches);
    let dataset = open(matches, &problems)?;
    let stats = DatasetStats::of(dataset.as_ref(), &problems, &bar)?;
    if matches.get_flag("json") {
        stdout::print_json(DatasetStats::FORMAT, &stats)?;
    } else {
        stdout::print(stats.to_string().trim_end())?;
        dataset_flags::print_problems(&problems)?;
    }
    Ok(outcome(&problems))
}

fn view(matches: &ArgMatches) -> Result<Outcome> {
    let problems = dataset_flags::problems(matches);
    let dataset = open(matches, &problems)?;
    let count = matches.get_one::<u64>("count").copied().unwrap_or(1) as usize;
    let count = count.min(dataset.len());
    let indices = (0..count).map(|at| at * dataset.len() / count).collect();
    let out = matches.get_one::<PathBuf>("out").cloned().unwrap_or_default();
    let sheet = datasets::contact_sheet(&Subset::new(dataset, indices)?, &problems)?;
    opendr::vision::save(&sheet, &out)?;
    dataset_flags::print_problems(&problems)?;
    stdout::print(out.display())?;
    Ok(outcome(&problems))
}

fn convert(matches: &ArgMatches) -> Result<Outcome> {
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let problems = dataset_flags::problems(matches);
    let to = datasets::find_format(matches.get_one::<String>("to").map_or("", String::as_str))?;
    let output = matches.get_one::<PathBuf>("output").cloned().unwrap_or_default();
    let external = dataset_flags::external(matches);
    let split = dataset_flags::split(matches);
    let dataset = datasets::open_for(
        &format!("{} has the annotations", to.name),
        to.targets,
        &external,
        split,
        &problems,
    )?;
    let options = WriteOptions { split: matches.get_one("as").cloned(), link: matches.get_flag("link") };
    (to.write)(dataset.as_ref(), &output, &options, &problems, &bar)?;
    dataset_flags::print_problems(&problems)?;
    bar.note(&format!("{} samples written into {}", dataset.len(), output.display()));
    Ok(outcome(&problems))
}
