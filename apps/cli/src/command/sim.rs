//! `opendr sim`: lists the environments, records videos of them, renders data sets, exports worlds.

use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use clap::{Arg, ArgMatches, Command, value_parser};
use opendr::data::Image;
use opendr::environment::{Controller, Environment, EnvironmentSource, ResetOptions, Space, Step};
use opendr::learner::Outputs;
use opendr::rl::prior::{PriorId, SafetyRule};
use opendr::simulation::{Recording, Registry};
use opendr::viewer::{Shown, Viewer};
use opendr::{PolicyController, Progress, Random, Result, Unit};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::viewed_environment::{episode_name, notes, rendered};
use crate::{environment_flags, loading, stdout, viewing};

const EXAMPLES: &str = "\
Examples:
  opendr sim list                                               list the environments
  opendr sim list UavDepthCorridor-v1                           list its spaces and parameters
  opendr sim priors                                             list the prior controllers
  opendr sim view CartPole-v1                                   an episode of random actions, as CartPole-v1.gif
  opendr sim view CartPole-v1 --learner ppo --out cart.mp4      an episode of a policy (mp4 needs ffmpeg)
  opendr sim view PlanarPush-v1 --controller planar-push-teacher --rate 10
  opendr sim view QuadTrack-v1 --learner td3/quad_track --online --rate 10 --env-param mass_factor=1.3
  opendr sim view CartPole-v1 --view                            episodes on a web page, in real time
  opendr sim view UavDepthCorridor-v1 --env-param max_obstacles=10 --seed 7 --out flight.png
  opendr sim render persons rendered/ --frames 1000             a labelled data set, as COCO
  opendr sim record PlanarPush-v1 --controller planar-push-teacher --out pushes/   demonstrations, for LeRobot
  opendr sim export UavDepthCorridor-v1 flight.wbt --seed 7     the world of an episode, for Webots";

const ID: &str = "id";

pub fn grammar() -> Command {
    let view = Command::new("view")
        .about("Record a video of an environment, with random actions or a policy")
        .arg(Arg::new(ID).required(true).value_name("ID").help("Environment (see \"opendr sim list\")"))
        .args([
            Arg::new("out")
                .long("out")
                .short('o')
                .value_parser(value_parser!(PathBuf))
                .value_name("FILE")
                .help("File to write: .gif, .mp4, or .png for one image per step [default: ID.gif, or none with --view]"),
            Arg::new("learner")
                .long("learner")
                .value_name("LEARNER[/VARIANT]")
                .help("Policy that acts [default: random actions]"),
            Arg::new("controller")
                .long("controller")
                .value_name("PRIOR")
                .conflicts_with("learner")
                .help("Prior controller that acts (see \"opendr sim priors\")"),
            Arg::new("episodes")
                .long("episodes")
                .value_parser(value_parser!(u64).range(1..=1000))
                .value_name("N")
                .help("Number of episodes [default: 1, or with --view without end]"),
            Arg::new("seed")
                .long("seed")
                .default_value("0")
                .value_parser(value_parser!(u64))
                .value_name("N")
                .help("Seed of the first episode; each further episode adds 1"),
            Arg::new("rate")
                .long("rate")
                .value_parser(frame_rate)
                .value_name("HZ")
                .help("Frames per second [default: 30]"),
            environment_flags::param_flag(),
            viewing::flag().conflicts_with("online"),
        ])
        .args(super::online::flags().map(|flag| flag.requires("learner")))
        .args(loading::flags());
    Command::new("sim")
        .about("List environments and priors, record videos of episodes, render labelled data sets")
        .subcommand_required(true)
        .arg_required_else_help(true)
        .subcommands([
            Command::new("priors").about("List the prior controllers and the safety rules of shields"),
            Command::new("list").about("List the environments").arg(
                Arg::new(ID).value_name("ID").help("List the spaces and parameters of this environment"),
            ),
            view,
            super::sim_render::grammar(),
            #[cfg(feature = "lerobot")]
            super::sim_record::grammar(),
            #[cfg(feature = "webots")]
            super::sim_export::grammar(),
        ])
        .after_help(EXAMPLES)
}

fn frame_rate(text: &str) -> std::result::Result<f64, String> {
    let rate = text.parse().ok().filter(|rate| (0.01..=1000.0).contains(rate));
    rate.ok_or_else(|| "give 0.01 to 1000 frames per second".to_owned())
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    match matches.subcommand() {
        Some(("list", matches)) => list(matches),
        Some(("view", matches)) => view(matches),
        Some(("priors", _)) => priors(),
        Some(("render", matches)) => super::sim_render::run(matches),
        #[cfg(feature = "lerobot")]
        Some(("record", matches)) => super::sim_record::run(matches),
        #[cfg(feature = "webots")]
        Some(("export", matches)) => super::sim_export::run(matches),
        _ => Ok(Outcome::Done),
    }
}

fn list(matches: &ArgMatches) -> Result<Outcome> {
    let registry = Registry::builtin();
    let Some(id) = matches.get_one::<String>(ID) else {
        for id in registry.ids() {
            let spec = registry.get(id)?.make(&Default::default())?.spec().clone();
            stdout::print(format_args!("{id:28} observation {}, action {}", spec.observation, spec.action))?;
        }
        for external in opendr::environments::external() {
            stdout::print(format_args!("{:28} spaces of the robot that it is connected to", external.id()))?;
        }
        return Ok(Outcome::Done);
    };
    let registration = opendr::environments::registration(id)?;
    if registry.get(registration.id()).is_ok() {
        let spec = registration.make(&Default::default())?.spec().clone();
        stdout::print(format_args!(
            "{}\n  observation  {}\n  action       {}",
            spec.id, spec.observation, spec.action
        ))?;
        if let Some(limit) = spec.max_episode_steps {
            stdout::print(format_args!("  truncated    after {limit} steps"))?;
        }
    } else {
        stdout::print(format_args!("{}\n  spaces of the robot that it is connected to", registration.id()))?;
    }
    for field in registration.fields() {
        let range = field.range.map(|range| {
            let unit = if field.unit.is_empty() { String::new() } else { format!(" {}", field.unit) };
            format!(" [{} to {}{unit}]", range.low, range.high)
        });
        let (name, default) = (field.name, field.default.value());
        stdout::print(format_args!(
            "  --env-param {name}={default}{}  {}",
            range.unwrap_or_default(),
            field.doc
        ))?;
    }
    Ok(Outcome::Done)
}

fn priors() -> Result<Outcome> {
    for prior in opendr::priors() {
        let PriorId { name, version } = prior.id();
        let commands = if prior.has_commands() { ", follows commands" } else { "" };
        stdout::print(format_args!("{name:28} version {version}{commands}: {}", prior.description()))?;
    }
    for rule in SafetyRule::all() {
        stdout::print(format_args!("{:28} safety rule: {}", rule.name(), rule.description()))?;
    }
    Ok(Outcome::Done)
}

fn view(matches: &ArgMatches) -> Result<Outcome> {
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let id = matches.get_one::<String>(ID).map_or("", String::as_str);
    let source = opendr::environments::source(id, &environment_flags::params(id, matches)?)?;
    let first = matches.get_one::<u64>("seed").copied().unwrap_or(0);
    let viewer = viewing::of_items(source.id(), matches, &bar)?;
    let default = viewer.is_none().then(|| PathBuf::from(format!("{}.gif", source.id())));
    let out = matches.get_one::<PathBuf>("out").or(default.as_ref());
    let rate = matches.get_one::<f64>("rate").copied().unwrap_or(30.0);
    let learner = matches.get_one::<String>("learner");
    if let (true, Some(spec), Some(out)) = (super::online::is_online(matches), learner, out) {
        let learner = loading::load(spec, &Default::default(), matches, &bar)?;
        super::online::record(learner.as_ref(), &source, first, out, rate, matches, &bar)?;
        bar.note(&format!("written: {}", written_files(out)));
        return Ok(Outcome::Done);
    }
    let mut environment = source.make()?;
    let mut acting: Box<dyn Controller> = match (learner, matches.get_one::<String>("controller")) {
        (Some(spec), _) => {
            let learner = loading::load(spec, &Default::default(), matches, &bar)?;
            Box::new(PolicyController::new(learner.stream()?, loading::entry(spec)?, environment.spec())?)
        }
        (None, Some(prior)) => opendr::prior(prior)?.controller(&environment.spec().observation)?,
        (None, None) => random_controller(environment.spec().action.clone(), first),
    };
    let film = out.map(|out| Recording::create(out, rate)).transpose()?;
    let mut screen = Screen { film, viewer, frame: Duration::from_secs_f64(1.0 / rate), due: Instant::now() };
    let episodes = matches.get_one::<u64>("episodes").copied().or(screen.viewer.is_none().then_some(1));
    bar.begin("episodes", episodes, Unit::Items);
    for seed in (first..=u64::MAX).take(episodes.map_or(usize::MAX, |episodes| episodes as usize)) {
        if bar.stopped() {
            break;
        }
        let line = episode(&mut *environment, &mut *acting, seed, &mut screen, &bar);
        stdout::print(line.inspect_err(|_| bar.end())?)?;
        bar.advance(1);
    }
    bar.end();
    if let Some(film) = screen.film {
        film.finish()?;
    }
    if let Some(out) = out {
        bar.note(&format!("written: {}", written_files(out)));
    }
    Ok(Outcome::Done)
}

/// Where the images of episodes go.
struct Screen {
    film: Option<Recording>,
    viewer: Option<Viewer>,
    /// Time between two images.
    frame: Duration,
    /// When the page displays the next image.
    due: Instant,
}

impl Screen {
    /// Records an image, and displays it with `notes` when it is due.
    fn put(
        &mut self,
        name: &str,
        number: u64,
        image: Image,
        notes: impl FnOnce() -> Vec<(String, String)>,
    ) -> Result<()> {
        if let Some(film) = &mut self.film {
            film.write(&image)?;
        }
        if let Some(viewer) = &self.viewer {
            viewing::sleep(self.due.saturating_duration_since(Instant::now()));
            // After a slow step the next images are not hurried.
            self.due = self.due.max(Instant::now()) + self.frame;
            viewer.show(Shown {
                notes: notes(),
                ..viewing::shown(name.to_owned(), number, (&image).into(), &Outputs::default())
            });
        }
        Ok(())
    }
}

fn written_files(out: &Path) -> String {
    match out.extension() {
        Some(extension) if extension == "png" => {
            format!("{}-00001.png and so on", out.with_extension("").display())
        }
        _ => out.display().to_string(),
    }
}

fn random_controller(actions: Space, seed: u64) -> Box<dyn Controller> {
    let mut random = Random::new(seed);
    Box::new(move |_: &[f32], action: &mut [f32]| {
        actions.sample_into(&mut random, action);
        Ok(())
    })
}

/// Records an episode and returns a summary line.
fn episode(
    environment: &mut dyn Environment,
    acting: &mut dyn Controller,
    seed: u64,
    screen: &mut Screen,
    bar: &ProgressBar,
) -> Result<String> {
    let spec = environment.spec().clone();
    let (mut observation, mut action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
    environment.reset(Some(seed), &ResetOptions::new(), &mut observation)?;
    acting.reset();
    let (mut earned, mut length) = (0.0, 0u64);
    let name = episode_name(&spec.id, seed);
    screen.put(&name, 0, rendered(environment)?, Vec::new)?;
    loop {
        acting.act(&observation, &mut action)?;
        let step = environment.step(&action, &mut observation)?;
        (earned, length) = (earned + step.reward, length + 1);
        screen.put(&name, length, rendered(environment)?, || notes(&step, earned, &action))?;
        if step.is_over() || bar.stopped() {
            return Ok(format!("seed {seed}: return {earned:.2} in {length} steps, {}", ending(&step)));
        }
    }
}

fn ending(step: &Step) -> String {
    let how = match (step.terminated, step.truncated) {
        (true, _) => "terminated",
        (_, true) => "truncated",
        _ => "interrupted",
    };
    step.info.iter().fold(how.to_owned(), |text, (name, value)| format!("{text}, {name} {value}"))
}
