//! `opendr download`: downloads models into the cache or a folder.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::Result;

use crate::exit::Outcome;
use crate::progress_bar::{ProgressBar, interrupted};
use crate::{loading, stdout};

pub fn grammar() -> Command {
    Command::new("download")
        .about("Download models into the cache; interrupted downloads resume, and files are checked by SHA-256")
        .arg(
            Arg::new("model")
                .num_args(1..)
                .value_name("LEARNER[/VARIANT]")
                .help("Model to download (see \"opendr models\")")
                .required_unless_present("all")
                .conflicts_with("all"),
        )
        .arg(Arg::new("all").long("all").action(ArgAction::SetTrue).help("Download everything in the zoo"))
        .arg(
            Arg::new("to")
                .long("to")
                .value_parser(value_parser!(PathBuf))
                .value_name("DIR")
                .help("Also copy into this folder, for use as OPENDR_MODEL_REPOSITORY"),
        )
        .args([loading::offline(), loading::quiet()])
        .after_help(
            "Examples:\n  opendr download LEARNER\n  opendr download LEARNER/VARIANT --to models/\n  opendr download --all",
        )
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let zoo = loading::zoo(matches)?;
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let specs: Vec<String> = if matches.get_flag("all") {
        zoo.items().map(|item| item.to_string()).collect()
    } else {
        matches.get_many::<String>("model").into_iter().flatten().cloned().collect()
    };
    let to = matches.get_one::<PathBuf>("to").map(PathBuf::as_path);
    let mut outcome = Outcome::Done;
    for spec in &specs {
        match zoo.download(spec, to, &bar) {
            Ok(path) => stdout::print(format_args!("{spec}: {}", path.display()))?,
            Err(error) if specs.len() == 1 => return Err(error),
            Err(_) if interrupted() => {}
            Err(error) => {
                eprintln!("error: {error}");
                outcome = Outcome::SomeFailed;
            }
        }
        if interrupted() {
            break;
        }
    }
    Ok(outcome)
}
