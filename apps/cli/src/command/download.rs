//! `opendr download`: models into the cache, or into a folder.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::zoo::{Zoo, ZooOptions};
use opendr::{Error, Result};

use crate::exit::Outcome;
use crate::progress_bar::{Bar, interrupted};

pub fn grammar() -> Command {
    Command::new("download")
        .about("Get models into the cache, checked by sha256, resumed where they broke off")
        .arg(Arg::new("model").num_args(0..).value_name("LEARNER[/VARIANT]").required_unless_present("all"))
        .arg(Arg::new("all").long("all").action(ArgAction::SetTrue).help("Everything in the zoo"))
        .arg(
            Arg::new("to")
                .long("to")
                .value_parser(value_parser!(PathBuf))
                .value_name("DIR")
                .help("Also copy into this folder, which can then serve as OPENDR_MODEL_REPOSITORY"),
        )
        .arg(Arg::new("quiet").long("quiet").short('q').action(ArgAction::SetTrue).help("Print paths and errors only"))
        .after_help("Examples:\n  opendr download centernet\n  opendr download yunet/n_320 --to models/\n  opendr download --all")
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let zoo = Zoo::new(ZooOptions::from_env()?)?;
    let bar = Bar::new(matches.get_flag("quiet"));
    let specs: Vec<String> = if matches.get_flag("all") {
        zoo.items().map(|item| item.to_string()).collect()
    } else {
        matches.get_many::<String>("model").into_iter().flatten().cloned().collect()
    };
    let to = matches.get_one::<PathBuf>("to").map(PathBuf::as_path);
    let mut failures = Vec::<Error>::new();
    for spec in &specs {
        match zoo.download(spec, to, &bar) {
            Ok(path) => println!("{spec}: {}", path.display()),
            Err(error) if specs.len() == 1 => return Err(error),
            Err(error) => {
                eprintln!("error: {error}");
                failures.push(error);
            }
        }
        if interrupted() {
            break;
        }
    }
    Ok(if failures.is_empty() { Outcome::Done } else { Outcome::SomeFailed })
}
