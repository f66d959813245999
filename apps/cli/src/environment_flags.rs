//! Flags of the commands in which a policy acts.

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::{AnyLearner, Entry};
use opendr::params::ParamMap;
use opendr::simulation::RegisteredSource;
use opendr::{Error, Result, ValueType};

use crate::dataset_flags;

const ENV: &str = "env";
const ENV_PARAM: &str = "env-param";

/// Returns whether a learner is a policy: it has an observation port.
pub fn is_policy(entry: &Entry) -> bool {
    entry.ports.iter().any(|port| port.value_type == ValueType::Observation)
}

/// Replaces the data set of a command by the environment, and adds the number of episodes.
pub fn add_for_episodes(command: Command) -> Command {
    add(command)
        .mut_arg(dataset_flags::DATASET, |dataset| dataset.required(false).hide(true))
        .arg(episodes_flag())
}

/// Adds the flags of the environment.
pub fn add(command: Command) -> Command {
    let words = "Environment to act in, such as CartPole-v1 (see \"opendr sim list\")";
    command.arg(Arg::new(ENV).long(ENV).value_name("ID").help(words)).arg(param_flag())
}

/// Returns the flag of the environment's parameters.
pub fn param_flag() -> Arg {
    Arg::new(ENV_PARAM)
        .long(ENV_PARAM)
        .action(ArgAction::Append)
        .value_name("NAME=VALUE")
        .help("Parameter of the environment (see \"opendr sim list ID\"); may be repeated")
}

fn episodes_flag() -> Arg {
    Arg::new("episodes")
        .long("episodes")
        .value_parser(value_parser!(u64).range(1..=1_000_000))
        .value_name("N")
        .help("Number of episodes to evaluate, each with its own seed")
}

/// Returns the environment that the user named, else the one that the model was trained in.
///
/// # Errors
/// `InvalidParam` if none is named or a parameter is wrong; `NotFound` for an unknown environment.
pub fn source(matches: &ArgMatches, learner: Option<&dyn AnyLearner>) -> Result<RegisteredSource> {
    if matches.try_get_one::<std::path::PathBuf>(dataset_flags::DATASET).ok().flatten().is_some() {
        return Err(Error::invalid_param(
            "a policy acts in an environment, not on a data set; give --env ID",
        ));
    }
    let trained_in = learner.and_then(opendr::training_environment).map(str::to_owned);
    let id = matches.get_one::<String>(ENV).cloned().or(trained_in).ok_or_else(|| {
        Error::invalid_param(
            "no environment; name one by --env, such as --env CartPole-v1 (see \"opendr sim list\")",
        )
    })?;
    opendr::environments::source(&id, &params(&id, matches)?)
}

/// Returns the environment's parameters that the user set.
///
/// # Errors
/// `InvalidParam` for an unknown parameter or a value of another type.
pub fn params(id: &str, matches: &ArgMatches) -> Result<ParamMap> {
    let registration = opendr::environments::registration(id)?;
    let given = matches.get_many::<String>(ENV_PARAM).into_iter().flatten();
    given
        .map(|text| crate::named_value::parse(ENV_PARAM, text, registration.id(), registration.fields()))
        .collect()
}
