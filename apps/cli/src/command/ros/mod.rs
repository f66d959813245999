//! `opendr ros2` and `opendr ros1`: learners as nodes.

mod environment;
mod node;
mod participant;
mod run;
mod version;

use clap::{ArgMatches, Command};
use opendr::Result;

use crate::exit::Outcome;
use version::Ros;

pub fn ros2() -> Command {
    grammar(Ros::Two, "Learners as nodes of ROS 2; no ROS is needed where they run")
}

pub fn ros1() -> Command {
    grammar(Ros::One, "Learners as nodes of ROS 1; no ROS is needed where they run, a roscore somewhere")
}

fn grammar(ros: Ros, about: &'static str) -> Command {
    Command::new(ros.name())
        .about(about)
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommand(run::grammar(ros))
        .subcommand(environment::grammar())
}

pub fn run_ros2(matches: &ArgMatches) -> Result<Outcome> {
    run_either(Ros::Two, matches)
}

pub fn run_ros1(matches: &ArgMatches) -> Result<Outcome> {
    run_either(Ros::One, matches)
}

fn run_either(ros: Ros, matches: &ArgMatches) -> Result<Outcome> {
    match matches.subcommand() {
        Some(("run", matches)) => run::run(ros, matches),
        Some(("env", matches)) => environment::run(ros, matches),
        _ => Ok(Outcome::Done),
    }
}
