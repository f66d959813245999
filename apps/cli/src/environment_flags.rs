//! The flags of every command in which a policy acts.

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::{AnyLearner, Entry};
use opendr::params::ParamMap;
use opendr::simulation::{RegisteredSource, Registry};
use opendr::{Error, Result, ValueType};

use crate::dataset_flags;

const ENV: &str = "env";
const ENV_PARAM: &str = "env-param";

/// Whether a learner acts on observations.
pub fn is_policy(entry: &Entry) -> bool {
    entry.ports.iter().any(|port| port.value_type == ValueType::Observation)
}

/// Makes a command that takes a data set one that measures in an environment.
pub fn add_for_episodes(command: Command) -> Command {
    add(command)
        .mut_arg(dataset_flags::DATASET, |dataset| dataset.required(false).hide(true))
        .arg(episodes_flag())
}

/// Adds the flags of the environment.
pub fn add(command: Command) -> Command {
    let words = "The environment to act in, e.g. CartPole-v1 (\"opendr sim list\")";
    command.arg(Arg::new(ENV).long(ENV).value_name("ID").help(words)).arg(param_flag())
}

/// The flag of the environment's own parameters.
pub fn param_flag() -> Arg {
    Arg::new(ENV_PARAM)
        .long(ENV_PARAM)
        .action(ArgAction::Append)
        .value_name("NAME=VALUE")
        .help("A parameter of the environment (\"opendr sim list ID\" names them)")
}

fn episodes_flag() -> Arg {
    Arg::new("episodes")
        .long("episodes")
        .value_parser(value_parser!(u64).range(1..=1_000_000))
        .value_name("N")
        .help("How many episodes to measure, each with a seed of its own")
}

/// The environment that the user named, else the one that the model was trained in.
///
/// # Errors
/// `InvalidParam` where none is named, or a parameter does not fit; `NotFound` for an unknown one.
pub fn source(matches: &ArgMatches, learner: Option<&dyn AnyLearner>) -> Result<RegisteredSource> {
    if matches.try_get_one::<std::path::PathBuf>(dataset_flags::DATASET).ok().flatten().is_some() {
        return Err(Error::invalid_param(
            "a policy acts in an environment, not on a data set; give --env ID",
        ));
    }
    let trained_in = learner.and_then(opendr::trained_in).map(str::to_owned);
    let id = matches.get_one::<String>(ENV).cloned().or(trained_in).ok_or_else(|| {
        Error::invalid_param(
            "no environment; name one by --env, e.g. --env CartPole-v1 (\"opendr sim list\")",
        )
    })?;
    RegisteredSource::new(&id, &params(&id, matches)?)
}

/// The environment's parameters that the user set.
///
/// # Errors
/// `InvalidParam` for one that it has not, or a value of another type.
pub fn params(id: &str, matches: &ArgMatches) -> Result<ParamMap> {
    let registration = Registry::builtin().get(id)?;
    let given = matches.get_many::<String>(ENV_PARAM).into_iter().flatten();
    given
        .map(|text| crate::named_value::parse(ENV_PARAM, text, registration.id(), registration.fields()))
        .collect()
}
