//! Flags of recordings.

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgAction, ArgMatches, Command};
use opendr::bags::{BagFormat, Need, PortTopic, Recording};
use opendr::learner::{Entry, Port};
use opendr::{Error, Result};

const HEADING: &str = "Recordings";

/// Returns the flags of topics to read and of the written recording.
pub fn flags() -> [Arg; 4] {
    let flag = |name: &'static str| Arg::new(name).long(name).help_heading(HEADING);
    [
        flag("topic").action(ArgAction::Append).value_name("[PORT=]TOPIC").help(
            "Topic to read, where several have a fitting type; PORT=TOPIC for each further input, matched by stamps; may be repeated",
        ),
        flag("bag-format")
            .value_name("FORMAT")
            .requires("out")
            .value_parser(PossibleValuesParser::new(BagFormat::ALL.map(BagFormat::name)))
            .help("Record the predictions into --out in this format; by default from the extension .bag or .mcap"),
        flag("with-input")
            .action(ArgAction::SetTrue)
            .requires("out")
            .help("Record the inputs besides the predictions"),
        flag("overwrite")
            .action(ArgAction::SetTrue)
            .requires("out")
            .help("Replace an existing recording"),
    ]
}

/// Allows topics instead of files for the further inputs.
pub fn ports_by_topic(command: Command, entry: &'static Entry) -> Command {
    let needed = entry.ports.iter().skip(1).filter(|port| !port.optional || port.init);
    needed.fold(command, |command, port| {
        command.mut_arg(port.name, |flag| flag.required(false).required_unless_present("topic"))
    })
}

/// Returns the topics of the ports, the first port's first.
///
/// # Errors
/// `InvalidParam` for an unknown port or one that is named twice, else as [`Recording::topic_for`].
pub fn port_topics(
    entry: &'static Entry,
    recording: &Recording,
    matches: &ArgMatches,
) -> Result<Vec<(&'static str, PortTopic)>> {
    let words: Vec<&String> = matches.get_many("topic").into_iter().flatten().collect();
    let mut named: Vec<(&'static Port, &str)> = Vec::new();
    for word in words {
        let (port, topic) = match word.split_once('=') {
            Some((name, topic)) => (entry.ports.iter().find(|port| port.name == name), topic),
            None => (entry.ports.first(), word.as_str()),
        };
        let port = port.ok_or_else(|| {
            let names: Vec<_> = entry.ports.iter().map(|port| port.name).collect();
            Error::invalid_param(format!(
                "--topic {word} names an unknown input; the learner has {}",
                names.join(", ")
            ))
        })?;
        if named.iter().any(|(other, _)| other.name == port.name) {
            let name = port.name;
            return Err(Error::invalid_param(format!("--topic names {name:?} twice; name each input once")));
        }
        named.push((port, topic));
    }
    let mut topics = Vec::new();
    for (at, port) in entry.ports.iter().enumerate() {
        let topic = named.iter().find(|(other, _)| other.name == port.name).map(|(_, topic)| *topic);
        let has_file = at > 0 && matches.contains_id(port.name);
        if has_file || (at > 0 && topic.is_none() && (port.optional || port.init)) {
            continue;
        }
        let how = || match at {
            0 => "choose one with --topic TOPIC".to_owned(),
            _ => format!("choose one with --topic {}=TOPIC", port.name),
        };
        let chosen = recording.topic_for(port.value_type, topic).map_err(|error| error.context(how()))?;
        let need = match (at, port.init, port.optional) {
            (0, ..) => Need::Required,
            (_, true, _) => Need::Init,
            (_, _, true) => Need::Optional,
            _ => Need::Required,
        };
        topics.push((port.name, PortTopic { topic: chosen.name, value_type: port.value_type, need }));
    }
    Ok(topics)
}
