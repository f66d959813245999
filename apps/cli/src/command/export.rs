//! `opendr export`: writes a model as a folder, a zip or ONNX.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::Result;
use opendr::model::Model;

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{loading, stdout};

const EXAMPLES: &str = "\
Examples:
  opendr export runs/mine/model --out detector.onnx    the network alone
  opendr export runs/mine/model --out detector.zip     the container as one file
  opendr export LEARNER/VARIANT --out detector         a pretrained model as a folder";

pub fn grammar() -> Command {
    Command::new("export")
        .about("Write a model as a folder, a zip, or an ONNX file")
        .arg(
            Arg::new("source")
                .required(true)
                .value_name("LEARNER[/VARIANT]|CONTAINER")
                .help("Pretrained model, or path of a container"),
        )
        .arg(
            Arg::new("out")
                .long("out")
                .alias("output")
                .short('o')
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .value_name("FILE")
                .help("Path to write: NAME.onnx, NAME.zip, or a folder"),
        )
        .arg(
            Arg::new("zip")
                .long("zip")
                .action(ArgAction::SetTrue)
                .help("Write a zip; .zip is appended to the name where it is missing"),
        )
        .args([loading::offline(), loading::quiet()])
        .after_help(EXAMPLES)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let source = matches.get_one::<String>("source").map_or("", String::as_str);
    let mut output = matches.get_one::<PathBuf>("out").cloned().unwrap_or_default();
    if matches.get_flag("zip") && output.extension().is_none_or(|extension| extension != "zip") {
        output.as_mut_os_string().push(".zip");
    }
    let path = loading::container(source, matches, &ProgressBar::new(matches.get_flag("quiet")))?;
    opendr::export(&Model::open(path)?, &output)?;
    stdout::print(output.display())?;
    Ok(Outcome::Done)
}
