//! Command-line flags out of a learner's tables: one per parameter, one per further port.

use std::fs;
use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::learner::{Entry, Port};
use opendr::params::{Field, ParamKind, ParamMap};
use opendr::{Error, Result, ResultExt, Value};

/// Adds the learner's flags to a command.
pub fn add(command: Command, entry: &'static Entry) -> Command {
    let params = entry.params.iter().map(param_flag);
    let ports = entry.ports.iter().skip(1).map(port_flag);
    command.args(params.chain(ports)).after_help(format!("{}: {}", entry.spec.class, entry.spec.about))
}

fn param_flag(field: &'static Field) -> Arg {
    let mut help = field.doc.to_owned();
    if let Some(range) = field.range {
        help += &format!(" [range: {range}{}{}]", if field.unit.is_empty() { "" } else { " " }, field.unit);
    }
    help += &format!(" [default: {}]", (field.default)());
    let flag = Arg::new(field.name)
        .long(dashed(field.name))
        .help(help)
        .help_heading("Parameters")
        .allow_negative_numbers(true)
        .value_name(value_name(field.kind));
    if field.choices.is_empty() { flag } else { flag.value_parser(PossibleValuesParser::new(field.choices)) }
}

fn port_flag(port: &'static Port) -> Arg {
    Arg::new(port.name)
        .long(dashed(port.name))
        .help(format!("{} (a {} in a JSON file)", port.doc, port.value_type.name()))
        .help_heading("Inputs")
        .required(!port.optional || port.init)
        .value_parser(value_parser!(PathBuf))
        .value_name("FILE")
}

/// `iou_threshold` is written `--iou-threshold`.
fn dashed(name: &'static str) -> String {
    name.replace('_', "-")
}

fn value_name(kind: ParamKind) -> &'static str {
    match kind {
        ParamKind::Float => "NUMBER",
        ParamKind::Int => "N",
        ParamKind::Bool => "BOOL",
        ParamKind::Text => "WORD",
        ParamKind::List => "LIST",
    }
}

/// The parameters that the user set.
pub fn params(entry: &'static Entry, matches: &ArgMatches) -> Result<ParamMap> {
    let mut params = ParamMap::new();
    for field in entry.params {
        if let Some(text) = matches.get_one::<String>(field.name) {
            params.insert(field.name.to_owned(), field.parse(text)?);
        }
    }
    Ok(params)
}

/// The values of the further ports, read from their JSON files.
pub fn ports(entry: &'static Entry, matches: &ArgMatches) -> Result<Vec<(&'static str, Value)>> {
    let given = entry.ports.iter().skip(1).filter_map(|port| Some((port, matches.get_one::<PathBuf>(port.name)?)));
    let read = |(port, path): (&'static Port, &PathBuf)| {
        let text = fs::read(path).context(|| format!("reading {}", path.display()))?;
        let value: Value = serde_json::from_slice(&text)
            .map_err(|error| Error::format(format!("{}: {error}", path.display())))?;
        Ok((port.name, value))
    };
    given.map(read).collect()
}
