//! `opendr ros2` and `opendr ros1`: run learners and environments as nodes.

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
    grammar(Ros::Two, "Run learners as ROS 2 nodes, without a ROS installation")
}

pub fn ros1() -> Command {
    grammar(
        Ros::One,
        "Run learners as ROS 1 nodes, without a ROS installation; needs a roscore on the network",
    )
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
