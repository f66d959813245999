//! Command-line flags of a learner: one per parameter and one per further port.

use std::path::PathBuf;

use clap::builder::PossibleValuesParser;
use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::Result;
use opendr::learner::{Entry, Port};
use opendr::params::{Field, ParamKind, ParamMap};

use crate::port_file::PortFile;

/// Adds the learner's flags to a command that runs inference.
pub fn add(command: Command, entry: &'static Entry) -> Command {
    let ports = entry.ports.iter().skip(1).map(port_flag);
    with_params(command, entry).args(ports)
}

/// Adds the learner's flags to `bench`, where synthetic values replace inputs without a file.
pub fn add_for_bench(command: Command, entry: &'static Entry) -> Command {
    let ports = entry.ports.iter().skip(1).map(|port| port_flag(port).required(false));
    with_params(command, entry).args(ports)
}

/// Adds the learner's flags to a command that trains: parameters of the learner and of its training.
pub fn add_for_fit(command: Command, entry: &'static Entry) -> Command {
    let heading = format!("Training of {}", entry.spec.name);
    let of_fit = entry.fit_params.iter().filter(|field| !is_own(entry, field));
    let of_fit = of_fit.map(|field| param_flag(&heading, field));
    with_params(command, entry).args(of_fit)
}

/// Adds the learner's parameters.
pub fn with_params(command: Command, entry: &'static Entry) -> Command {
    let heading = format!("Parameters of {}", entry.spec.name);
    let params = entry.params.iter().map(|field| param_flag(&heading, field));
    let about = format!("{}: {}", entry.spec.class, entry.spec.about);
    command.args(params).before_help(about)
}

/// Returns whether a parameter of the training is also one of the learner; one flag then sets both.
fn is_own(entry: &Entry, field: &Field) -> bool {
    entry.params.iter().any(|own| own.name == field.name)
}

/// Returns the flag of a parameter.
pub fn param_flag(heading: &str, field: &'static Field) -> Arg {
    let mut help = format!("{} [default: {}]", field.doc.trim_end_matches('.'), field.default.value());
    if let Some(range) = field.range {
        let unit = if field.unit.is_empty() { String::new() } else { format!(" {}", field.unit) };
        help += &format!(" [range: {} to {}{unit}]", range.low, range.high);
    }
    let flag = Arg::new(field.name)
        .long(dashed(field.name))
        .aliases(field.former.iter().map(|name| dashed(name)))
        .help(help)
        .help_heading(heading.to_owned())
        .allow_negative_numbers(true)
        .value_name(value_name(field.kind));
    if field.choices.is_empty() { flag } else { flag.value_parser(PossibleValuesParser::new(field.choices)) }
}

fn port_flag(port: &'static Port) -> Arg {
    let name = port.value_type.name();
    let forms = match port.value_type.is_target() {
        true => format!("a {name} as JSON, or lines of \"opendr infer --json\""),
        false => format!("file of type {name}, or a folder with one for each frame"),
    };
    Arg::new(port.name)
        .long(dashed(port.name))
        .help(format!("{} [{forms}]", port.doc))
        .help_heading("Further inputs")
        .required(!port.optional || port.init)
        .value_parser(value_parser!(PathBuf))
        .value_name("FILE")
}

/// Converts `iou_threshold` into `iou-threshold`.
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

/// Returns the parameters that the user set.
///
/// # Errors
/// `InvalidParam` for a value of the wrong type; the learner checks ranges when it is made.
pub fn params(entry: &'static Entry, matches: &ArgMatches) -> Result<ParamMap> {
    values(entry.params, matches)
}

/// Returns the training parameters that the user set.
///
/// # Errors
/// As [`params`].
pub fn fit_params(entry: &'static Entry, matches: &ArgMatches) -> Result<ParamMap> {
    values(entry.fit_params, matches)
}

/// Returns the values of those `fields` that the user set.
///
/// # Errors
/// As [`params`].
pub fn values(fields: impl IntoIterator<Item = &'static Field>, matches: &ArgMatches) -> Result<ParamMap> {
    let given = fields.into_iter().filter_map(|field| Some((field, matches.get_one::<String>(field.name)?)));
    given.map(|(field, text)| Ok((field.name.to_owned(), field.parse(text)?))).collect()
}

/// Reads the files of the further ports.
///
/// # Errors
/// As [`PortFile::read`].
pub fn port_files(entry: &'static Entry, matches: &ArgMatches) -> Result<Vec<PortFile>> {
    let further = entry.ports.iter().skip(1);
    let given = further.filter_map(|port| Some((port, matches.get_one::<PathBuf>(port.name)?)));
    given.map(|(port, path)| PortFile::read(port, path)).collect()
}
