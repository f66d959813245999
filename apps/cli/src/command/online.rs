//! `--online` of `opendr eval` and `opendr sim view`: a policy that is adapted while it acts.

use std::path::{Path, PathBuf};

use clap::{Arg, ArgAction, ArgMatches};
use opendr::control::online::{AdaptationParams, tracking_task};
use opendr::data::{Image, PixelFormat};
use opendr::environment::{Controller, Environment, EnvironmentSource as _, ResetOptions};
use opendr::learner::AnyLearner;
use opendr::params::Params as _;
use opendr::rl::EvaluationProtocol;
use opendr::simulation::{Recording, RegisteredSource};
use opendr::{JsonFormat, OnlineTuning, Progress, Result, Unit};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::viewed_environment::rendered;
use crate::{named_value, report_file, stdout};

const REPORT: JsonFormat = JsonFormat::new("evaluation of online adaptation", 1);
const ONLINE: &str = "online";
const ONLINE_PARAM: &str = "online-param";

/// Returns the flags of online adaptation.
pub fn flags() -> [Arg; 2] {
    [
        Arg::new(ONLINE).long(ONLINE).action(ArgAction::SetTrue).help(
            "Adapt the policy while it acts, and compare it with the frozen policy and the conventional controller (docs/online_adaptation.md)",
        ),
        Arg::new(ONLINE_PARAM)
            .long(ONLINE_PARAM)
            .action(ArgAction::Append)
            .requires(ONLINE)
            .value_name("NAME=VALUE")
            .help("Parameter of the adaptation (docs/online_adaptation.md); may be repeated"),
    ]
}

/// Returns whether the policy is to be adapted.
pub fn is_online(matches: &ArgMatches) -> bool {
    matches.get_flag(ONLINE)
}

/// Returns the parameters of the adaptation that the user set, over the defaults.
fn params(matches: &ArgMatches) -> Result<AdaptationParams> {
    let mut params = AdaptationParams::default();
    for text in matches.get_many::<String>(ONLINE_PARAM).into_iter().flatten() {
        let (name, value) =
            named_value::parse(ONLINE_PARAM, text, "online adaptation", AdaptationParams::FIELDS)?;
        params.set(&name, value)?;
    }
    params.check()?;
    Ok(params)
}

/// Calibrates a policy in the environment with its default parameters.
fn tuning(learner: &dyn AnyLearner, source: &RegisteredSource) -> Result<OnlineTuning> {
    OnlineTuning::new(learner, &RegisteredSource::new(source.id(), &Default::default())?)
}

/// Evaluates a policy frozen, adapted and beside the conventional controller, in `environment`, which is one of `source`.
pub fn evaluate(
    learner: &dyn AnyLearner,
    source: &RegisteredSource,
    environment: &mut dyn Environment,
    protocol: &EvaluationProtocol,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<Outcome> {
    let params = params(matches)?;
    let report = tuning(learner, source)?.compare(environment, &params, protocol, bar)?;
    if matches.get_flag("json") {
        stdout::print_json(REPORT, &report)?;
    } else {
        stdout::print(report.to_string().trim_end())?;
    }
    if let Some(folder) = matches.get_one::<PathBuf>("out") {
        bar.note(&format!("written: {}", report_file::write(REPORT, &report, folder)?.display()));
    }
    Ok(Outcome::Done)
}

/// Records an episode of the frozen policy (left) beside the adapted one (right), in real time.
pub fn record(
    learner: &dyn AnyLearner,
    source: &RegisteredSource,
    seed: u64,
    out: &Path,
    rate: f64,
    matches: &ArgMatches,
    bar: &ProgressBar,
) -> Result<()> {
    let params = params(matches)?;
    let tuning = tuning(learner, source)?;
    let mut frozen = Flight::new(source, Box::new(tuning.frozen()), seed)?;
    let mut adapted = Flight::new(source, Box::new(tuning.adapter(params)?), seed)?;
    let period = tracking_task(frozen.environment.spec())?.period;
    let every = (1.0 / (rate * period)).round().max(1.0) as u64;
    let mut video = Recording::create(out, rate)?;
    bar.begin("steps", None, Unit::Items);
    for step in 0u64.. {
        if step.is_multiple_of(every) {
            let images = [frozen.render()?, adapted.render()?];
            video.write(&beside(&images)?)?;
        }
        let over = [frozen.step()?, adapted.step()?];
        bar.advance(1);
        if over.contains(&true) || bar.stopped() {
            break;
        }
    }
    bar.end();
    video.finish()?;
    stdout::print(format_args!(
        "seed {seed}: RMS error of the last third {:.4} frozen (left), {:.4} adapted (right)",
        frozen.rms(),
        adapted.rms()
    ))
}

/// One controller in an environment of its own.
struct Flight {
    environment: Box<dyn Environment>,
    controller: Box<dyn Controller>,
    observation: Vec<f32>,
    action: Vec<f32>,
    errors: Vec<f64>,
}

impl Flight {
    fn new(source: &RegisteredSource, controller: Box<dyn Controller>, seed: u64) -> Result<Self> {
        let mut environment = source.make()?;
        let spec = environment.spec();
        let (mut observation, action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
        environment.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
        Ok(Self { environment, controller, observation, action, errors: Vec::new() })
    }

    fn render(&mut self) -> Result<Image> {
        rendered(self.environment.as_mut())
    }

    fn step(&mut self) -> Result<bool> {
        self.controller.act(&self.observation, &mut self.action)?;
        let step = self.environment.step(&self.action, &mut self.observation)?;
        self.errors.push(step.info.get("error").unwrap_or(f64::NAN));
        Ok(step.is_over())
    }

    fn rms(&self) -> f64 {
        let last = &self.errors[self.errors.len() - self.errors.len().div_ceil(3)..];
        (last.iter().map(|error| error * error).sum::<f64>() / last.len().max(1) as f64).sqrt()
    }
}

/// Images of one height beside each other.
fn beside(images: &[Image]) -> Result<Image> {
    let bytes: Vec<_> = images.iter().map(|image| (image.width(), image.hwc_u8(PixelFormat::Rgb))).collect();
    let height = images.iter().map(Image::height).min().unwrap_or(0);
    let rows = (0..height).flat_map(|row| {
        bytes.iter().flat_map(move |(width, own)| &own[3 * width * row..3 * width * (row + 1)])
    });
    Image::from_rgb8(rows.copied().collect(), images.iter().map(Image::width).sum(), height)
}
