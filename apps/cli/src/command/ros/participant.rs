//! Flags of the ROS 2 middleware.

use std::net::IpAddr;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::Result;
use opendr::ros::{Middleware, Ros2, Ros2Options};

pub fn add_flags(command: Command) -> Command {
    command
        .arg(
            Arg::new("rmw")
                .long("rmw")
                .value_parser(str::parse::<Middleware>)
                .value_name("dds|zenoh")
                .help("Middleware of ROS 2 [env: RMW_IMPLEMENTATION] [default: dds]"),
        )
        .arg(
            Arg::new("domain-id")
                .long("domain-id")
                .value_parser(value_parser!(u16))
                .value_name("N")
                .help("Domain id of ROS 2 [env: ROS_DOMAIN_ID]"),
        )
        .arg(
            Arg::new("network")
                .long("network")
                .action(ArgAction::Append)
                .value_parser(value_parser!(IpAddr))
                .value_name("ADDRESS")
                .help("Address of a network interface that DDS uses; may be repeated [default: all]"),
        )
}

/// Joins ROS 2 with the options of the flags.
///
/// # Errors
/// As [`Ros2::new`].
pub fn start_ros2(matches: &ArgMatches) -> Result<Ros2> {
    Ros2::new(&Ros2Options {
        middleware: matches.get_one("rmw").copied(),
        domain_id: matches.get_one("domain-id").copied(),
        networks: matches.get_many("network").into_iter().flatten().copied().collect(),
    })
}
