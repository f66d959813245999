//! The flags of DDS.

use std::net::IpAddr;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::Result;
use opendr::ros::{Ros2, Ros2Options};

pub fn add_flags(command: Command) -> Command {
    command
        .arg(
            Arg::new("domain-id")
                .long("domain-id")
                .value_parser(value_parser!(u16))
                .value_name("N")
                .help("The DDS domain, of ROS 2 [env: ROS_DOMAIN_ID]"),
        )
        .arg(
            Arg::new("network")
                .long("network")
                .action(ArgAction::Append)
                .value_parser(value_parser!(IpAddr))
                .value_name("ADDRESS")
                .help("An address of this machine whose network is used by ROS 2; all of them otherwise"),
        )
}

/// Joins DDS as the flags have it.
///
/// # Errors
/// As [`Ros2::new`].
pub fn start_ros2(matches: &ArgMatches) -> Result<Ros2> {
    Ros2::new(&Ros2Options {
        domain_id: matches.get_one("domain-id").copied(),
        networks: matches.get_many("network").into_iter().flatten().copied().collect(),
    })
}
