//! `opendr ros2 run`: one node a learner, several in one process.

use std::ffi::OsString;
use std::net::IpAddr;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::{AnyLearner, Entry};
use opendr::params::{Field, ParamMap, Params as _};
use opendr::ros::{
    Feeds, Graph as _, LearnerNode, Names, NodeOptions, NodeParams, Ros2, Ros2Node, Ros2Options, RosArgs,
    default_topics,
};
use opendr::{Error, Result, ResultExt};

use crate::exit::Outcome;
use crate::progress_bar::{Bar, interrupted};
use crate::{learner_flags, loading};

const EXAMPLES: &str = "\
Examples:
  opendr ros2 run nanodet --image /camera/image_raw
  opendr ros2 run nanodet --image /camera/image_raw/compressed --image-message sensor_msgs/msg/CompressedImage
  opendr ros2 run nanodet --threshold 0.5 + yunet --image image_raw      two nodes; the picture is decoded once
  opendr ros2 run nanodet --ros-args -r __ns:=/robot -r image_raw:=/camera/image_raw -p threshold:=0.5
  opendr ros2 run LEARNER --help                                        its topics and parameters";

/// The id of the argument that holds everything after `run`.
const WORDS: &str = "words";
/// What stands between the nodes of one process.
const NEXT: &str = "+";

pub fn grammar() -> Command {
    Command::new("run")
        .about(
            "Run learners as nodes: topics by type, parameters with ranges, diagnostics, newest input first",
        )
        .disable_help_flag(true)
        .arg(
            Arg::new(WORDS)
                .num_args(0..)
                .trailing_var_arg(true)
                .allow_hyphen_values(true)
                .value_parser(value_parser!(OsString))
                .value_name("LEARNER [FLAGS] [+ LEARNER [FLAGS]]... [--ros-args ...]"),
        )
}

/// The grammar of one node; with a learner its topics and parameters are flags.
fn node_grammar(entry: Option<&'static Entry>) -> Command {
    let command = Command::new("opendr ros2 run")
        .about("Run a learner as a node of ROS 2")
        .arg(loading::learner())
        .args(loading::flags())
        .arg(
            Arg::new("name").long("name").value_name("NAME").help("The node's name; the learner's otherwise"),
        )
        .arg(
            Arg::new("namespace")
                .long("namespace")
                .default_value("/")
                .value_name("NAMESPACE")
                .help("Where its relative names lie"),
        )
        .arg(
            Arg::new("reliable")
                .long("reliable")
                .action(ArgAction::SetTrue)
                .help("Ask publishers of pictures and clouds to send what was lost again"),
        )
        .arg(
            Arg::new("depth")
                .long("depth")
                .value_parser(value_parser!(u16).range(1..))
                .value_name("N")
                .help("Messages that are kept for a slow peer"),
        )
        .arg(
            Arg::new("domain-id")
                .long("domain-id")
                .value_parser(value_parser!(u16))
                .value_name("N")
                .help("The DDS domain [env: ROS_DOMAIN_ID]"),
        )
        .arg(
            Arg::new("network")
                .long("network")
                .action(ArgAction::Append)
                .value_parser(value_parser!(IpAddr))
                .value_name("ADDRESS")
                .help("An address of this machine whose network is used; all of them otherwise"),
        )
        .after_help(EXAMPLES);
    let Some(entry) = entry else { return command };
    let mut command = learner_flags::with_params(command, entry);
    let usual = default_topics(entry);
    for topic in &usual.inputs {
        let doc = entry.ports.iter().find(|port| port.name == topic.name).map_or("", |port| port.doc);
        command =
            with_topic(command, "Inputs", &topic.name, "", doc, &topic.topic, topic.message_type.ros2_name());
    }
    for topic in &usual.outputs {
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
                .help(format!("Its message [default: {message}]")),
        )
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let words: Vec<OsString> = matches.get_many::<OsString>(WORDS).into_iter().flatten().cloned().collect();
    let (words, ros_words) = match words.iter().position(|word| word == "--ros-args") {
        Some(at) => (words[..at].to_vec(), words[at..].to_vec()),
        None => (words, Vec::new()),
    };
    let ros_words: Vec<String> = ros_words.iter().map(|word| word.to_string_lossy().into_owned()).collect();
    let mut nodes = Vec::new();
    for group in words.split(|word| word == NEXT) {
        match parse(group)? {
            Ok(matches) => nodes.push(matches),
            Err(outcome) => return Ok(outcome),
        }
    }
    let Some(first) = nodes.first() else { return Ok(Outcome::Done) };
    let ros2 = Ros2::new(&Ros2Options {
        domain_id: first.get_one("domain-id").copied(),
        networks: first.get_many("network").into_iter().flatten().copied().collect(),
    })?;
    let mut feeds = Feeds::default();
    let mut running = Vec::new();
    for matches in &nodes {
        running.push(start(&ros2, matches, &ros_words, &mut feeds)?);
    }
    std::thread::scope(|scope| {
        for (_graph, node) in running.iter_mut() {
            let Some(node) = node.take() else { continue };
            scope.spawn(move || node.run(&interrupted));
        }
    });
    Ok(Outcome::Done)
}

/// One node's words as flags; what was printed instead of that ends the command.
fn parse(words: &[OsString]) -> Result<Result<ArgMatches, Outcome>> {
    let entry = super::super::named_learner(&node_grammar(None), words)?;
    let words = std::iter::once(OsString::from("opendr ros2 run")).chain(words.iter().cloned());
    match node_grammar(entry).try_get_matches_from(words) {
        Ok(matches) => Ok(Ok(matches)),
        Err(error) => {
            // Printing fails only when nobody reads.
            error.print().ok();
            let failed = error.use_stderr();
            Ok(Err(if failed { Outcome::WrongUsage } else { Outcome::Done }))
        }
    }
}

fn start(
    ros2: &Ros2,
    matches: &ArgMatches,
    ros_words: &[String],
    feeds: &mut Feeds,
) -> Result<(Ros2Node, Option<LearnerNode>)> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let text = |id: &str| matches.get_one::<String>(id).map(String::as_str);
    let name = text("name").unwrap_or(entry.spec.name);
    let namespace = text("namespace").unwrap_or("/");
    let args = RosArgs::parse(ros_words, namespace, name)?;
    let names = Names::new(namespace, name, &args.remappings)?;
    let mut params = learner_flags::params(entry, matches)?;
    let mut own = learner_flags::values(NodeParams::FIELDS, matches)?;
    set_parameters(entry, &args.parameters, &mut params, &mut own)?;
    let bar = Bar::new(matches.get_flag("quiet"));
    let learner: Box<dyn AnyLearner> = loading::load(spec, &params, matches, &bar)?;
    let mut graph = ros2.node(names)?;
    let options = options(entry, matches, NodeParams::from_map(&own)?)?;
    let node = LearnerNode::new(&mut graph, entry, learner, options, feeds)?;
    graph.start()?;
    let log = graph.log();
    log(opendr::ros::Severity::Info, &format!("{} is ready as {}", entry.spec.class, graph.name()));
    Ok((graph, Some(node)))
}

/// The parameters after `--ros-args`, each for the learner or for the node.
fn set_parameters(
    entry: &Entry,
    parameters: &[(String, String)],
    of_learner: &mut ParamMap,
    of_node: &mut ParamMap,
) -> Result<()> {
    for (name, text) in parameters {
        let find = |fields: &'static [Field]| fields.iter().find(|field| field.name == name);
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

fn options(entry: &Entry, matches: &ArgMatches, params: NodeParams) -> Result<NodeOptions> {
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
            if let Some(depth) = matches.get_one::<u16>("depth") {
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
    fn every_learner_has_a_sound_grammar() {
        for entry in opendr::registry().entries() {
            node_grammar(Some(entry)).debug_assert();
            let matches = node_grammar(Some(entry)).try_get_matches_from(["run", entry.spec.name]).unwrap();
            options(entry, &matches, NodeParams::default()).unwrap();
        }
    }

    #[test]
    fn topics_and_parameters_come_from_the_words() {
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
            "--depth",
            "3",
        ];
        let matches = node_grammar(Some(entry)).try_get_matches_from(words).unwrap();
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
