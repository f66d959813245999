//! `opendr sim export`: writes the world of an episode for Webots.

use std::path::PathBuf;

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::Result;

use crate::exit::Outcome;
use crate::{environment_flags, stdout};

pub fn grammar() -> Command {
    Command::new("export")
        .about("Write the world of an episode as a world file of Webots (.wbt), textures beside it")
        .args([
            Arg::new("id").required(true).value_name("ID").help("Environment (see \"opendr sim list\")"),
            Arg::new("world")
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .value_name("FILE")
                .help("World file to write"),
            Arg::new("seed")
                .long("seed")
                .default_value("0")
                .value_parser(value_parser!(u64))
                .value_name("N")
                .help("Seed of the episode"),
            environment_flags::param_flag(),
        ])
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let id = matches.get_one::<String>("id").map_or("", String::as_str);
    let seed = matches.get_one::<u64>("seed").copied().unwrap_or(0);
    let Some(path) = matches.get_one::<PathBuf>("world") else { return Ok(Outcome::Done) };
    let files = opendr::webots::export(id, &environment_flags::params(id, matches)?, seed)?;
    for file in files.save(path)? {
        stdout::print(format_args!("written: {}", file.display()))?;
    }
    Ok(Outcome::Done)
}
