//! `opendr ros2 env` and `opendr ros1 env`: runs an environment as a node.

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::environment::EnvironmentSource as _;
use opendr::rl::observation_from_numbers;
use opendr::ros::{EnvironmentNode, EnvironmentOptions, Graph, Names, Ros1Node, RosArgs};
use opendr::{Error, Result};

use super::participant::{self, start_ros2};
use super::version::{ROS_ARGS, Ros};
use crate::environment_flags;
use crate::exit::Outcome;
use crate::progress_bar::interrupted;

const EXAMPLES: &str = "\
Examples:
  opendr ros2 env CartPole-v1 --action /ppo/target                       step on each action
  opendr ros2 run ppo --observation /CartPole_v1/observation             ... which this policy publishes
  opendr ros2 env UavDepthCorridor-v1 --rate 10 --action /cmd_vel --action-message geometry_msgs/msg/Twist";

pub fn grammar() -> Command {
    let text = |id: &'static str, value: &'static str, help: &'static str| {
        Arg::new(id).long(id).value_name(value).help(help)
    };
    let command = Command::new("env")
        .about("Run an environment as a node: it subscribes to actions and publishes observation, reward and end of the episode")
        .arg(Arg::new("id").required(true).value_name("ID").help("Environment (see \"opendr sim list\")"))
        .arg(text("action", "TOPIC", "Topic of the actions [default: ~/action]"))
        .arg(text(
            "action-message",
            "TYPE",
            "Message type of the actions [default: opendr_msgs/msg/Float32MultiArrayStamped]",
        ))
        .arg(
            text(
                "rate",
                "HZ",
                "Steps per second, with the last received action [default: one step per action]",
            )
            .value_parser(value_parser!(f64)),
        )
        .arg(text("seed", "N", "Seed of the first episode").value_parser(value_parser!(u64)).default_value("0"))
        .arg(text("name", "NAME", "Name of the node [default: that of the environment]"))
        .arg(text("namespace", "NAMESPACE", "Namespace of the node").default_value("/"))
        .arg(environment_flags::param_flag())
        .arg(
            Arg::new(ROS_ARGS)
                .long("ros-args")
                .num_args(0..)
                .allow_hyphen_values(true)
                .value_name("WORDS")
                .help("ROS arguments: -r FROM:=TO"),
        );
    participant::add_flags(command).after_help(EXAMPLES)
}

pub fn run(ros: Ros, matches: &ArgMatches) -> Result<Outcome> {
    let text = |id: &str| matches.get_one::<String>(id).map(String::as_str);
    let id = text("id").unwrap_or_default();
    let source = opendr::environments::source(id, &environment_flags::params(id, matches)?)?;
    let words: Vec<&str> =
        matches.get_many::<String>(ROS_ARGS).into_iter().flatten().map(String::as_str).collect();
    // ROS names cannot contain dashes.
    let own = id.replace(|letter: char| !letter.is_ascii_alphanumeric(), "_");
    let (name, namespace) = (text("name").unwrap_or(&own), text("namespace").unwrap_or("/"));
    let args = RosArgs::parse(&words, namespace, name)?;
    let names = Names::new(namespace, name, &args.remappings)?;
    let mut options = EnvironmentOptions {
        seed: matches.get_one("seed").copied().unwrap_or(0),
        rate: matches.get_one("rate").copied(),
        ..EnvironmentOptions::default()
    };
    if options.rate.is_some_and(|rate| !(rate > 0.0 && rate.is_finite())) {
        return Err(Error::invalid_param("--rate is not above 0; give a number of steps per second"));
    }
    if let Some(topic) = text("action") {
        topic.clone_into(&mut options.action_topic);
    }
    if let Some(message) = text("action-message") {
        options.action_message = message.parse()?;
    }
    let environment = source.make()?;
    let space = environment.spec().observation.clone();
    let observe = Box::new(move |numbers: &[f32]| observation_from_numbers(&space, numbers));
    let log_ready = |graph: &dyn Graph| {
        graph.log()(opendr::ros::Severity::Info, &format!("{id} is ready as {}", graph.name()));
    };
    match ros {
        Ros::One => {
            let mut graph = Ros1Node::new(names)?;
            let node = EnvironmentNode::new(&mut graph, environment, observe, options)?;
            log_ready(&graph);
            node.run(&|| interrupted() || graph.is_over())?;
        }
        Ros::Two => {
            let ros2 = start_ros2(matches)?;
            let mut graph = ros2.node(names)?;
            let node = EnvironmentNode::new(&mut *graph, environment, observe, options)?;
            graph.start()?;
            log_ready(&*graph);
            node.run(&interrupted)?;
        }
    }
    Ok(Outcome::Done)
}
