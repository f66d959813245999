//! `opendr infer LEARNER --rig RIG`: moves a camera until the class is certain.

use std::path::PathBuf;

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::active::rig::RigOptions;
use opendr::active::{Active, ActiveContainer, EpisodeStrip, Outcome as Run};
use opendr::learner::{AnyLearner, Entry};
use opendr::model::Model;
use opendr::params::ParamMap;
use opendr::simulation::Registry;
use opendr::target::ActionBase as _;
use opendr::{Error, JsonFormat, Result};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{environment_flags, learner_flags, loading, stdout};

const EPISODE: JsonFormat = JsonFormat::new("episode of a moving camera", 1);

pub const RIG: &str = "rig";
const CAMERA_POLICY: &str = "camera-policy";
const FIELD: &str = "field-of-view";
const SEED: &str = "rig-seed";

/// Adds the flags of the rig, which conflict with input files.
pub fn add(command: Command) -> Command {
    let flag = |name: &'static str| Arg::new(name).long(name);
    command.args([
        flag(RIG).value_name("RIG").conflicts_with_all(["input", "view"]).help(
            "Move a camera until the class is certain: in an environment (SphereView-Face-v1), over recorded views (their index, .json) or in a large image",
        ),
        flag(CAMERA_POLICY).requires(RIG).value_parser(value_parser!(PathBuf)).value_name("PATH").help(
            "Model of active perception whose camera policy moves the rig, for a learner that has none",
        ),
        flag(FIELD).requires(RIG).value_parser(value_parser!(f64)).value_name("RAD").help(
            "Horizontal field of view of the whole image, for a rig in a large image [default: 1.0]",
        ),
        flag(SEED).requires(RIG).value_parser(value_parser!(u64)).value_name("N").help(
            "Seed of the episode, for a rig in an environment [default: 0]",
        ),
        environment_flags::param_flag(),
    ])
}

/// Runs the perception loop and prints views and result.
pub fn run(
    spec: &str,
    entry: &'static Entry,
    rig: &str,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<Outcome> {
    let learner = loading::load(spec, &learner_flags::params(entry, matches)?, matches, bar)?;
    let policy = matches.get_one::<PathBuf>(CAMERA_POLICY);
    let policy = policy.map(|path| ActiveContainer::read(&Model::open(path)?)).transpose()?;
    let policy = policy.as_ref().map(|container| &container.model);
    let mut active = Active::of_learner(learner.as_ref(), entry, policy)?;
    let run = active.run(rig_options(rig, matches)?.open(rig)?.as_mut())?;
    if let Some(path) = matches.get_one::<PathBuf>("out") {
        EpisodeStrip::of(&run)?.save(path)?;
    }
    if matches.contains_id("json") {
        stdout::print_json(EPISODE, &run)?;
    } else {
        print(&run, learner.as_ref())?;
    }
    Ok(Outcome::Done)
}

/// Returns the options of a rig that the user set.
fn rig_options(rig: &str, matches: &ArgMatches) -> Result<RigOptions> {
    let params = match Registry::builtin().get(rig) {
        Ok(_) => environment_flags::params(rig, matches)?,
        Err(_) if matches.contains_id(environment_flags::ENV_PARAM) => {
            return Err(Error::invalid_param(format!(
                "--{} is for a rig in an environment, and {rig} is none; omit it",
                environment_flags::ENV_PARAM
            )));
        }
        Err(_) => ParamMap::new(),
    };
    let (seed, field_of_view) = (matches.get_one(SEED).copied(), matches.get_one(FIELD).copied());
    Ok(RigOptions { params, seed, field_of_view })
}

fn print(run: &Run, learner: &dyn AnyLearner) -> Result<()> {
    let classes = learner.classes();
    let name = |class: usize| {
        classes.name(class as i64).map_or_else(|| format!("class {class}"), |name| name.to_string())
    };
    for (number, view) in run.views.iter().enumerate() {
        let [azimuth, elevation] = [view.pose.azimuth, view.pose.elevation].map(f64::to_degrees);
        let action = view.action.map(|action| format!(", action {:.2?}", action.axes())).unwrap_or_default();
        stdout::print(format_args!(
            "view {}: azimuth {azimuth:.0}, elevation {elevation:.0} degrees, distance {:.2}: {} {:.2}{action}",
            number + 1,
            view.pose.distance,
            name(view.class),
            view.confidence
        ))?;
    }
    let confidence = run.probabilities.get(run.class).copied().unwrap_or_default();
    stdout::print(format_args!("{} {confidence:.2} after {} views", name(run.class), run.views.len()))
}
