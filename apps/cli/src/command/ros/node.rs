//! Command line of one node: topics and parameters as flags, from the learner's ports, outputs and parameters.

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::Entry;
use opendr::params::{Field, ParamMap, Params as _};
use opendr::ros::{NodeOptions, NodeParams, default_topics};
use opendr::{Error, Result, ResultExt};

use super::participant;
use super::version::Ros;
use crate::{learner_flags, loading, viewing};

/// Builds the grammar of one node; with `entry`, the learner's topics and parameters are flags.
pub fn node_grammar(ros: Ros, entry: Option<&'static Entry>) -> Command {
    let command = Command::new(format!("opendr {} run", ros.name()))
        .about("Run a learner as a node")
        .arg(loading::learner())
        .args(loading::flags())
        .arg(
            Arg::new("name")
                .long("name")
                .value_name("NAME")
                .help("Name of the node [default: that of the learner]"),
        )
        .arg(
            Arg::new("namespace")
                .long("namespace")
                .default_value("/")
                .value_name("NAMESPACE")
                .help("Namespace of the node"),
        )
        .arg(
            Arg::new("reliable")
                .long("reliable")
                .action(ArgAction::SetTrue)
                .help("Use reliable QoS for images and point clouds: lost messages are sent again"),
        )
        .arg(
            Arg::new("qos-depth")
                .long("qos-depth")
                .value_parser(value_parser!(u16).range(1..))
                .value_name("N")
                .help("QoS history depth: messages kept for a slow peer"),
        )
        .arg(viewing::flag())
        .after_help(ros.examples());
    let lifecycle = || {
        Arg::new("lifecycle")
            .long("lifecycle")
            .action(ArgAction::SetTrue)
            .help("Run as a lifecycle node, which waits to be configured and activated")
    };
    let command = if ros == Ros::Two { participant::add_flags(command).arg(lifecycle()) } else { command };
    let Some(entry) = entry else { return command };
    let mut command = learner_flags::with_params(command, entry);
    let defaults = default_topics(entry);
    for topic in &defaults.inputs {
        let doc = entry.ports.iter().find(|port| port.name == topic.name).map_or("", |port| port.doc);
        command =
            with_topic(command, "Inputs", &topic.name, "", doc, &topic.topic, topic.message_type.ros2_name());
    }
    for topic in &defaults.outputs {
        let doc =
            entry.outputs.iter().find(|output| output.name == topic.name).map_or("", |output| output.doc);
        let message = topic.message_type.ros2_name();
        command = with_topic(command, "Outputs", &topic.name, "out-", doc, &topic.topic, message);
    }
    let own =
        NodeParams::FIELDS.iter().map(|field| learner_flags::param_flag("Parameters of the node", field));
    command.args(own)
}

fn with_topic(
    command: Command,
    heading: &'static str,
    name: &str,
    prefix: &str,
    doc: &str,
    topic: &str,
    message: &str,
) -> Command {
    let flag = format!("{prefix}{}", name.replace('_', "-"));
    let (topic_id, message_id) = (format!("{heading} {name}"), format!("{heading} {name} message"));
    command
        .arg(
            Arg::new(topic_id)
                .long(flag.clone())
                .value_name("TOPIC")
                .help_heading(heading)
                .help(format!("{doc} [default: {topic}]").trim().to_owned()),
        )
        .arg(
            Arg::new(message_id)
                .long(format!("{flag}-message"))
                .value_name("TYPE")
                .help_heading(heading)
                .help(format!("Message type [default: {message}]")),
        )
}

/// Sorts the parameters after `--ros-args` into those of the learner and those of the node.
///
/// # Errors
/// `InvalidParam` for an unknown parameter or a wrong value.
pub fn set_parameters(
    entry: &Entry,
    parameters: &[(String, String)],
    of_learner: &mut ParamMap,
    of_node: &mut ParamMap,
) -> Result<()> {
    for (name, text) in parameters {
        let find = |fields: &'static [Field]| fields.iter().find(|field| field.is_called(name));
        let (field, map) = match (find(entry.params), find(NodeParams::FIELDS)) {
            (Some(field), _) => (field, &mut *of_learner),
            (None, Some(field)) => (field, &mut *of_node),
            (None, None) => {
                return Err(Error::invalid_param(format!("{} has no parameter {name}", entry.spec.name)));
            }
        };
        map.insert(name.clone(), field.parse(text).context(|| format!("-p {name}:={text}"))?);
    }
    Ok(())
}

/// Returns the node's options as the flags set them.
///
/// # Errors
/// `NotFound` for an unknown message type.
pub fn options(entry: &Entry, matches: &ArgMatches, params: NodeParams) -> Result<NodeOptions> {
    let mut options = NodeOptions { params, ..default_topics(entry) };
    let NodeOptions { inputs, outputs, .. } = &mut options;
    for (heading, topics) in [("Inputs", inputs), ("Outputs", outputs)] {
        for topic in topics {
            let given = |what: &str| matches.get_one::<String>(&format!("{heading} {}{what}", topic.name));
            let message = given(" message").map(|text| text.parse()).transpose()?;
            if let Some(text) = given("") {
                topic.topic.clone_from(text);
            }
            topic.message_type = message.unwrap_or(topic.message_type);
            if let Some(depth) = matches.get_one::<u16>("qos-depth") {
                topic.qos.depth = usize::from(*depth);
            }
            topic.qos.reliable |= matches.get_flag("reliable");
        }
    }
    Ok(options)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_learner_has_a_valid_grammar() {
        for entry in opendr::registry().entries() {
            node_grammar(Ros::One, Some(entry)).debug_assert();
            node_grammar(Ros::Two, Some(entry)).debug_assert();
            let matches =
                node_grammar(Ros::Two, Some(entry)).try_get_matches_from(["run", entry.spec.name]).unwrap();
            options(entry, &matches, NodeParams::default()).unwrap();
        }
    }

    #[test]
    fn topics_and_parameters_come_from_flags() {
        let entry = opendr::registry().find("nanodet").unwrap();
        let words = [
            "run",
            "nanodet",
            "--image",
            "/cam",
            "--image-message",
            "sensor_msgs/msg/CompressedImage",
            "--out-boxes",
            "found",
            "--qos-depth",
            "3",
        ];
        let matches = node_grammar(Ros::Two, Some(entry)).try_get_matches_from(words).unwrap();
        let options = options(entry, &matches, NodeParams::default()).unwrap();
        assert_eq!((options.inputs[0].topic.as_str(), options.inputs[0].qos.depth), ("/cam", 3));
        assert_eq!(options.inputs[0].message_type.ros2_name(), "sensor_msgs/msg/CompressedImage");
        assert_eq!(options.outputs[0].topic, "found");
        let (mut of_learner, mut of_node) = (ParamMap::default(), ParamMap::default());
        let given = [("threshold".to_owned(), "0.5".to_owned()), ("annotate".to_owned(), "false".to_owned())];
        set_parameters(entry, &given, &mut of_learner, &mut of_node).unwrap();
        assert_eq!((of_learner.len(), of_node.len()), (1, 1));
        assert!(
            set_parameters(entry, &[("x".to_owned(), "1".to_owned())], &mut of_learner, &mut of_node)
                .is_err()
        );
    }
}
