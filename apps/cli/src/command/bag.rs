//! `opendr bag`: lists the content of ROS recordings and converts them.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::bags::{
    Bag, BagFormat, Compression, Conversion, Recording, RecordingWriter, Topic, WriteOptions,
};
use opendr::{Error, JsonFormat, Progress, Result, ValueType};
use serde_json::json;

use crate::exit::Outcome;
use crate::progress_bar::{ProgressBar, interrupted};
use crate::{loading, stdout};

const EXAMPLES: &str = "\
Examples:
  opendr bag info drive.bag                              list topics, types, counts and data types
  opendr bag convert drive.bag drive.mcap                write the messages in another format
  opendr bag convert drive.bag drive/ --to bag2_sqlite   convert ROS 1 messages to ROS 2
  opendr bag convert drive/ front.mcap --topic /front/image_raw --lz4";

pub fn grammar() -> Command {
    let path = |name: &'static str| Arg::new(name).required(true).value_parser(value_parser!(PathBuf));
    let switch = |name: &'static str| Arg::new(name).long(name).action(ArgAction::SetTrue);
    Command::new("bag")
        .about("List the content of ROS recordings (rosbag 1, rosbag 2, MCAP) and convert them")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands([
            Command::new("info")
                .about("List topics, types, message counts and duration")
                .arg(path("recording").value_name("RECORDING").help("A .bag or .mcap file, or a rosbag 2 folder"))
                .arg(switch("json").help("Print a JSON object")),
            Command::new("convert")
                .about("Write a recording in another format; known message types are converted between ROS 1 and ROS 2")
                .args([
                    path("recording").value_name("RECORDING").help("Recording to read"),
                    path("output").value_name("OUTPUT").help("Recording to write: .bag, .mcap, or a folder with --to"),
                    Arg::new("to")
                        .long("to")
                        .value_name("FORMAT")
                        .value_parser(PossibleValuesParser::new(BagFormat::ALL.map(BagFormat::name)))
                        .help("Format to write; by default from the extension .bag or .mcap"),
                    Arg::new("topic")
                        .long("topic")
                        .action(ArgAction::Append)
                        .value_name("TOPIC")
                        .help("Write only this topic; may be repeated"),
                    switch("ros2").help("Write ROS 2 messages into .mcap even if the recording has ROS 1 messages"),
                    switch("lz4").help("Compress with LZ4"),
                    switch("overwrite").help("Replace an existing recording"),
                    loading::quiet(),
                ]),
        ])
        .after_help(EXAMPLES)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    match matches.subcommand() {
        Some(("info", matches)) => info(matches),
        Some(("convert", matches)) => convert(matches),
        _ => Ok(Outcome::Done),
    }
}

fn open(matches: &ArgMatches) -> Result<Recording> {
    Recording::open(matches.get_one::<PathBuf>("recording").cloned().unwrap_or_default())
}

fn seconds(bag: &Bag) -> f64 {
    let span = bag.start_ns().zip(bag.end_ns());
    span.map_or(0.0, |(start, end)| end.saturating_sub(start) as f64 * 1e-9)
}

/// Returns the names of the data and target types that the messages of a topic convert to.
fn types(topic: &Topic) -> Vec<&'static str> {
    let fitting = ValueType::ALL.iter().filter(|value_type| topic.fits(**value_type));
    fitting.map(|value_type| value_type.name()).collect()
}

/// Format of `bag info --json`.
const INFO: JsonFormat = JsonFormat::new("description of a recording", 1);

fn info(matches: &ArgMatches) -> Result<Outcome> {
    let recording = open(matches)?;
    let (bag, topics) = (recording.bag(), recording.topics());
    if matches.get_flag("json") {
        let topics: Vec<_> = topics
            .iter()
            .map(|topic| {
                json!({
                    "name": topic.name, "type": topic.type_name, "messages": topic.messages, "read_as": types(topic),
                })
            })
            .collect();
        let report = json!({
            "recording": recording.path().to_string_lossy(), "format": bag.format().name(),
            "complete": bag.is_complete(), "messages": bag.message_count(), "start_ns": bag.start_ns(),
            "end_ns": bag.end_ns(), "duration_s": seconds(bag), "topics": topics,
        });
        stdout::print_json(INFO, &report)?;
        return Ok(Outcome::Done);
    }
    let cut = if bag.is_complete() { "" } else { "; truncated or damaged, listed up to the damage" };
    let (path, format, count) = (recording.path().display(), bag.format(), bag.message_count());
    stdout::print(format_args!("{path}: {format}, {count} messages, {:.1} s{cut}", seconds(bag)))?;
    let width = |text: fn(&Topic) -> usize| topics.iter().map(text).max().unwrap_or(0);
    let (names, kinds) = (width(|topic| topic.name.len()), width(|topic| topic.type_name.len()));
    for topic in &topics {
        let read_as = match (types(topic).join(", "), topic.is_other_version) {
            (types, false) => types,
            (_, true) => "another version of this message than OpenDR supports".to_owned(),
        };
        let Topic { name, type_name, messages, .. } = topic;
        let line = format!("  {name:names$}  {type_name:kinds$}  {messages:8}  {read_as}");
        stdout::print(line.trim_end())?;
    }
    Ok(Outcome::Done)
}

fn convert(matches: &ArgMatches) -> Result<Outcome> {
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let recording = open(matches)?;
    let output = matches.get_one::<PathBuf>("output").cloned().unwrap_or_default();
    let named = matches.get_one::<String>("to").map(|name| name.parse::<BagFormat>()).transpose()?;
    let format = named.or_else(|| RecordingWriter::format_of(&output)).ok_or_else(|| {
        let output = output.display();
        Error::invalid_param(format!(
            "{output} has no known format: name it .bag or .mcap, or choose a format by --to"
        ))
    })?;
    let (overwrite, same) = (matches.get_flag("overwrite"), output.canonicalize().ok());
    if same.is_some() && same == recording.path().canonicalize().ok() {
        let output = output.display();
        return Err(Error::invalid_param(format!("{output} is the input itself; write to another file")));
    }
    if output.exists() && !overwrite {
        let output = output.display();
        return Err(Error::invalid_param(format!(
            "{output} already exists; choose another name, or replace it with --overwrite"
        )));
    }
    let compression = if matches.get_flag("lz4") { Compression::Lz4 } else { Compression::None };
    let options = WriteOptions { overwrite, compression, ..WriteOptions::new(format) };
    let topics: Option<Vec<String>> = matches.get_many("topic").map(|topics| topics.cloned().collect());
    let there = recording.topics();
    if let Some(unknown) = topics.iter().flatten().find(|name| there.iter().all(|topic| topic.name != **name))
    {
        let names: Vec<_> = there.iter().map(|topic| topic.name.as_str()).collect();
        return Err(Error::not_found(format!("no topic {unknown:?}; there are {}", names.join(", "))));
    }
    let mut failures = u64::from(!recording.bag().is_complete());
    if failures > 0 {
        let path = recording.path().display();
        eprintln!("error: {path} is truncated or damaged; it is read up to the damage");
    }
    let mut skip = |error: Error| {
        failures += 1;
        bar.suspend(|| eprintln!("error: skipped: {error}"));
        Ok(())
    };
    let conversion = Conversion { topics, is_ros2: matches.get_flag("ros2"), ..Conversion::from(options) };
    let written = conversion.run(&recording, &output, &mut skip, &bar)?;
    let end = if interrupted() { " so far" } else { "" };
    bar.note(&format!("{written} messages written to {}{end}", output.display()));
    Ok(if failures == 0 { Outcome::Done } else { Outcome::SomeFailed })
}
