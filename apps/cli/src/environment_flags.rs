//! Flags of the commands in which a policy acts.

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::learner::{AnyLearner, Entry};
use opendr::params::ParamMap;
use opendr::simulation::RegisteredSource;
use opendr::{Error, Result, ValueType};

use crate::dataset_flags;

const ENV: &str = "env";
pub const ENV_PARAM: &str = "env-param";

/// Returns whether a learner is a policy: it predicts actions of an environment.
pub fn is_policy(entry: &Entry) -> bool {
    entry.outputs.iter().any(|output| output.value_type == ValueType::RlTarget)
}

/// Returns whether a learner is one of active perception: it moves a camera in environments.
pub fn is_active(entry: &Entry) -> bool {
    opendr::active::has_camera_policy(entry)
}

/// Replaces the data set of a command by the environment, and adds the number of episodes.
pub fn add_for_episodes(command: Command) -> Command {
    add(command)
        .mut_arg(dataset_flags::DATASET, |dataset| dataset.required(false).hide(true))
        .args(episode_flags())
}

/// Adds the environment to a command that also takes a data set.
pub fn add_beside_dataset(command: Command) -> Command {
    add(command).mut_arg(dataset_flags::DATASET, |dataset| dataset.required(false)).args(episode_flags())
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

fn episode_flags() -> [Arg; 2] {
    [
        Arg::new("episodes")
            .long("episodes")
            .value_parser(value_parser!(u64).range(1..=1_000_000))
            .value_name("N")
            .help("Number of episodes to evaluate, each with its own seed"),
        Arg::new("first-seed")
            .long("first-seed")
            .value_parser(value_parser!(u64))
            .value_name("N")
            .help("Seed of the first evaluated episode; each further episode adds 1 [default: 1000000; 5000000 for a moving camera]"),
    ]
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
    named(matches, learner)
}

/// Returns the environment as [`source`], of a command that may have a data set, too.
///
/// # Errors
/// As [`source`].
pub fn named(matches: &ArgMatches, learner: Option<&dyn AnyLearner>) -> Result<RegisteredSource> {
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
