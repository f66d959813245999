//! Commands on a Ray cluster, which the Python package carries out.

use std::sync::OnceLock;

use clap::{Arg, ArgMatches};
use opendr::{Error, JsonFormat, Result};
use serde_json::{Value as Json, json};

use crate::exit::Outcome;
use crate::stdout;

/// Carries out a command: takes its description as JSON, and returns the report as JSON and as text.
type Run = dyn Fn(&str) -> Result<(String, String)> + Send + Sync;

static CLUSTER: OnceLock<Box<Run>> = OnceLock::new();

const FLAG: &str = "ray";

/// Sets what carries out commands with `--ray`: `run` takes a description of the command as JSON, and returns the report as JSON and as
/// text. Later calls have no effect.
pub fn set_cluster(run: impl Fn(&str) -> Result<(String, String)> + Send + Sync + 'static) {
    // An earlier one stays.
    CLUSTER.set(Box::new(run)).ok();
}

/// Returns the flag of the cluster, which `others` exclude.
pub fn flag(others: &[&'static str]) -> Arg {
    Arg::new(FLAG)
        .long(FLAG)
        .value_name("ADDRESS")
        .conflicts_with_all(others)
        .help("Run on the workers of a Ray cluster: its address, \"auto\" for the running one, \"local\" for one of this machine (command of the Python package)")
}

/// Returns the address of the cluster, if the user named one.
pub fn address(matches: &ArgMatches) -> Option<&str> {
    matches.get_one::<String>(FLAG).map(String::as_str)
}

/// Carries out the command `name` on a cluster and prints its report, of `format` as JSON. `call` describes the learner, the data and the options.
///
/// # Errors
/// `Unsupported` outside of the Python package; the errors of the command.
pub fn run(
    name: &str,
    address: &str,
    format: JsonFormat,
    matches: &ArgMatches,
    mut call: Json,
) -> Result<Outcome> {
    let Some(run) = CLUSTER.get() else {
        return Err(Error::unsupported(
            "--ray needs the command of the Python package: pip install opendr-rs ray, then python -m opendr",
        ));
    };
    call["command"] = json!(name);
    call["ray"] = json!(address);
    call["threads"] = json!(matches.get_one::<u16>("threads"));
    call["device"] = json!(matches.get_one::<String>("device"));
    call["quiet"] = json!(matches.get_flag("quiet"));
    let (report, text) = run(&call.to_string())?;
    let fields: Json = serde_json::from_str(&report)
        .map_err(|error| Error::internal("the report of the cluster").with_source(error))?;
    match matches.get_flag("json") {
        true => stdout::print_json(format, &fields)?,
        false => stdout::print(text.trim_end())?,
    }
    let skipped = fields.get("skipped").and_then(Json::as_u64).unwrap_or(0);
    Ok(if skipped == 0 { Outcome::Done } else { Outcome::SomeFailed })
}
