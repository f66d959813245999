//! `opendr ros2`: learners as nodes.

mod node;

use clap::{ArgMatches, Command};
use opendr::Result;

use crate::exit::Outcome;

pub fn ros2() -> Command {
    Command::new("ros2")
        .about("Learners as nodes of ROS 2; no ROS is needed where they run")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(node::grammar())
}

pub fn run_ros2(matches: &ArgMatches) -> Result<Outcome> {
    match matches.subcommand() {
        Some(("run", matches)) => node::run(matches),
        _ => Ok(Outcome::Done),
    }
}
