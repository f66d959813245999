//! `opendr ros2 run` and `opendr ros1 run`: run learners as nodes, one or several per process.

use std::ffi::OsString;

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::Result;
use opendr::learner::AnyLearner;
use opendr::params::Params as _;
use opendr::ros::{
    Graph, LearnerNode, Names, NodeParams, Ros1Node, Ros2, RosArgs, Severity, SharedSubscriptions,
    ros_args_from_ros1,
};
use opendr::viewer::Shown;

use super::node::{node_grammar, options, set_parameters};
use super::participant;
use super::version::{ROS_ARGS, Ros};
use crate::exit::Outcome;
use crate::progress_bar::{ProgressBar, interrupted};
use crate::{learner_flags, loading, viewing};

/// Id of the argument that holds everything after `run`.
const WORDS: &str = "words";
/// Separator between the nodes of one process.
const NEXT: &str = "+";

pub fn grammar(ros: Ros) -> Command {
    Command::new("run")
        .about("Run learners as nodes: topics by type, live parameters, diagnostics, newest input first")
        .disable_help_flag(true)
        .arg(
            Arg::new(WORDS)
                .num_args(0..)
                .trailing_var_arg(true)
                .allow_hyphen_values(true)
                .value_parser(value_parser!(OsString))
                .value_name("LEARNER [FLAGS] [+ LEARNER [FLAGS]]... [--ros-args ...]"),
        )
        .after_help(ros.examples())
}

pub fn run(ros: Ros, matches: &ArgMatches) -> Result<Outcome> {
    let words: Vec<OsString> = matches.get_many::<OsString>(WORDS).into_iter().flatten().cloned().collect();
    let at = words.iter().position(|word| word == ROS_ARGS).unwrap_or(words.len());
    let (words, rest) = words.split_at(at);
    let mut ros_words: Vec<String> = rest.iter().map(|word| word.to_string_lossy().into_owned()).collect();
    let mut own_words = Vec::new();
    for word in words {
        match ros_args_from_ros1(&word.to_string_lossy())? {
            Some(of_ros) => ros_words.extend(of_ros),
            None => own_words.push(word.clone()),
        }
    }
    let mut nodes = Vec::new();
    for group in own_words.split(|word| word == NEXT) {
        match parse(ros, group)? {
            Ok(matches) => nodes.push(matches),
            Err(outcome) => return Ok(outcome),
        }
    }
    let Some(first) = nodes.first() else { return Ok(Outcome::Done) };
    let mut feeds = SharedSubscriptions::default();
    let mut running = Vec::new();
    // The participant outlives its nodes.
    let mut joined = None;
    for matches in &nodes {
        running.push(match ros {
            Ros::One => start_ros1(matches, &ros_words, &mut feeds)?,
            Ros::Two => {
                let ros2 = match &mut joined {
                    Some(ros2) => ros2,
                    none => none.insert(participant::start_ros2(first)?),
                };
                start_ros2(ros2, matches, &ros_words, &mut feeds)?
            }
        });
    }
    serve(running);
    Ok(Outcome::Done)
}

type Running = (Box<dyn Graph>, LearnerNode);

/// Runs all nodes until Ctrl-C or until they end; all are dropped together, since they share subscriptions.
fn serve(running: Vec<Running>) {
    std::thread::scope(|scope| {
        let work = |(graph, node): Running| {
            node.run(&|| interrupted() || graph.is_over());
            graph
        };
        let threads: Vec<_> = running.into_iter().map(|one| scope.spawn(move || work(one))).collect();
        drop(threads.into_iter().map(std::thread::ScopedJoinHandle::join).collect::<Vec<_>>());
    });
}

/// Parses the words of one node; the inner error is the outcome after help or a usage error was printed.
fn parse(ros: Ros, words: &[OsString]) -> Result<Result<ArgMatches, Outcome>> {
    let entry = super::super::named_learner(&node_grammar(ros, None), words)?;
    let words = std::iter::once(OsString::from("run")).chain(words.iter().cloned());
    Ok(node_grammar(ros, entry).try_get_matches_from(words).map_err(|error| {
        // Printing fails only when the output is closed.
        error.print().ok();
        if error.use_stderr() { Outcome::WrongUsage } else { Outcome::Done }
    }))
}

fn start_ros2(
    ros2: &Ros2,
    matches: &ArgMatches,
    ros_words: &[String],
    feeds: &mut SharedSubscriptions,
) -> Result<Running> {
    let (names, args) = names(matches, ros_words)?;
    let mut graph = ros2.node(names)?;
    let node = learner_node(&mut *graph, matches, &args.parameters, feeds)?;
    if matches.get_flag("lifecycle") {
        graph.manage(node.active())?;
    }
    graph.start()?;
    Ok((graph, node))
}

fn start_ros1(
    matches: &ArgMatches,
    ros_words: &[String],
    feeds: &mut SharedSubscriptions,
) -> Result<Running> {
    let (names, args) = names(matches, ros_words)?;
    let mut graph = Ros1Node::new(names)?;
    // Parameters of the command line override those of a launch file.
    let mut parameters = graph.private_parameters()?;
    parameters.extend(args.parameters);
    let node = learner_node(&mut graph, matches, &parameters, feeds)?;
    Ok((Box::new(graph), node))
}

/// Returns the node's names and the parsed words after `--ros-args`.
fn names(matches: &ArgMatches, ros_words: &[String]) -> Result<(Names, RosArgs)> {
    let text = |id: &str| matches.get_one::<String>(id).map(String::as_str);
    let entry = loading::entry(text(loading::LEARNER).unwrap_or_default())?;
    let name = text("name").unwrap_or(entry.spec.name);
    let namespace = text("namespace").unwrap_or("/");
    let args = RosArgs::parse(ros_words, namespace, name)?;
    Ok((Names::new(namespace, name, &args.remappings)?, args))
}

fn learner_node(
    graph: &mut dyn Graph,
    matches: &ArgMatches,
    parameters: &[(String, String)],
    feeds: &mut SharedSubscriptions,
) -> Result<LearnerNode> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let (mut of_learner, mut of_node) =
        (learner_flags::params(entry, matches)?, learner_flags::values(NodeParams::FIELDS, matches)?);
    set_parameters(entry, parameters, &mut of_learner, &mut of_node)?;
    let options = options(entry, matches, NodeParams::from_map(&of_node)?)?;
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let learner: Box<dyn AnyLearner> = loading::load(spec, &of_learner, matches, &bar)?;
    let input = options.inputs.first().map(|topic| topic.topic.clone()).unwrap_or_default();
    let viewer = viewing::of_items(entry.spec.class, matches, &bar)?;
    let mut node = LearnerNode::new(graph, entry, learner, options, feeds)?;
    if let Some(viewer) = viewer {
        let mut index = 0;
        node.observe(Box::new(move |value, outputs, processing_ms| {
            let shown = viewing::shown(input.clone(), index, value, outputs);
            viewer.show(Shown { stages: vec![("inference", processing_ms)], ..shown });
            index += 1;
        }));
    }
    graph.log()(Severity::Info, &format!("{} is ready as {}", entry.spec.class, graph.name()));
    Ok(node)
}
