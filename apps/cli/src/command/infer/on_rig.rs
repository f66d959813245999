//! `opendr infer LEARNER --rig RIG`: moves a camera until the class is certain.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::active::rig::{PanTiltZoom, RecordedViews};
use opendr::active::{
    Active, ActiveContainer, AnyRecogniser, EnvironmentRig, Outcome as Run, ViewRecogniser, strip_of_views,
};
use opendr::environment::EnvironmentSource as _;
use opendr::learner::{AnyLearner, Entry};
use opendr::model::Model;
use opendr::rig::ViewRig;
use opendr::simulation::{RegisteredSource, Registry};
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
/// Width and height of the images of a pan-tilt-zoom camera, in pixels.
const WINDOW: [usize; 2] = [224, 224];

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
        flag(FIELD).requires(RIG).value_parser(value_parser!(f64)).default_value("1.0").value_name("RAD").help(
            "Horizontal field of view of the whole image, for a rig in a large image",
        ),
        flag(SEED).requires(RIG).value_parser(value_parser!(u64)).default_value("0").value_name("N").help(
            "Seed of the episode, for a rig in an environment",
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
    let (container, recogniser) = parts(learner.as_ref(), entry, matches)?;
    let mut rig = open(rig, matches)?;
    let run = Active::new(recogniser, &container.model)?.run(rig.as_mut())?;
    if let Some(path) = matches.get_one::<PathBuf>("out") {
        opendr::vision::save(&strip_of_views(&run)?, path)?;
    }
    if matches.contains_id("json") {
        stdout::print_json(EPISODE, &run)?;
    } else {
        print(&run, learner.as_ref())?;
    }
    Ok(Outcome::Done)
}

/// Returns the camera policy and the recogniser: both of the learner, or the policy of `--camera-policy`.
fn parts(
    learner: &dyn AnyLearner,
    entry: &'static Entry,
    matches: &ArgMatches,
) -> Result<(ActiveContainer, Box<dyn ViewRecogniser>)> {
    let policy = matches.get_one::<PathBuf>(CAMERA_POLICY);
    match policy {
        None if environment_flags::is_active(entry) => {
            let container = ActiveContainer::of(learner)?;
            let recogniser = Box::new(container.recogniser.clone());
            Ok((container, recogniser))
        }
        Some(path) if !environment_flags::is_active(entry) => {
            let container = ActiveContainer::read(&Model::open(path)?)?;
            let recogniser = AnyRecogniser::new(learner, entry, learner.classes().len())?;
            Ok((container, Box::new(recogniser)))
        }
        Some(_) => Err(Error::invalid_param(format!(
            "{} has a camera policy of its own; omit --{CAMERA_POLICY}",
            entry.spec.class
        ))),
        None => Err(Error::invalid_param(format!(
            "{} has no camera policy; give one by --{CAMERA_POLICY}, trained by \"opendr fit active_object_recognition\"",
            entry.spec.class
        ))),
    }
}

/// Opens an environment, an index of recorded views, or a large image.
fn open(rig: &str, matches: &ArgMatches) -> Result<Box<dyn ViewRig>> {
    if Registry::builtin().get(rig).is_ok() {
        let source = RegisteredSource::new(rig, &environment_flags::params(rig, matches)?)?;
        let mut rig = EnvironmentRig::new(source.make()?)?;
        rig.begin(matches.get_one(SEED).copied().unwrap_or_default())?;
        return Ok(Box::new(rig));
    }
    let path = Path::new(rig);
    if path.extension().is_some_and(|extension| extension.eq_ignore_ascii_case("json")) {
        return Ok(Box::new(RecordedViews::open(path)?));
    }
    if !path.exists() {
        return Err(Error::not_found(format!(
            "no rig {rig:?}: neither an environment (see \"opendr sim list\") nor a file; give SphereView-Face-v1, an index of recorded views (.json) or an image"
        )));
    }
    let field = matches.get_one(FIELD).copied().unwrap_or(1.0);
    Ok(Box::new(PanTiltZoom::new(opendr::vision::open(path)?, field, WINDOW)?))
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
