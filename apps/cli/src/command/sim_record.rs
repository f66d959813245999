//! `opendr sim record`: records demonstrations of a controller as a data set of LeRobot.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::environment::EnvironmentSource as _;
use opendr::imitation::{DemonstrationSet, RecordingOptions, write_demonstrations};
use opendr::{Progress as _, Result, Unit};

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{environment_flags, loading};

const EXAMPLES: &str = "\
Examples:
  opendr sim record PlanarPush-v1 --controller planar-push-teacher --episodes 100 --out pushes/
  opendr fit act pushes/                                        train on them
  opendr eval act --model runs/act/model --env PlanarPush-v1    and measure the policy";

pub fn grammar() -> Command {
    Command::new("record")
        .about("Record demonstrations of a prior controller as a data set of LeRobot")
        .args([
            Arg::new("id").required(true).value_name("ID").help("Environment (see \"opendr sim list\")"),
            Arg::new("controller")
                .long("controller")
                .required(true)
                .value_name("PRIOR")
                .help("Prior that demonstrates (see \"opendr sim priors\")"),
            Arg::new("out")
                .long("out")
                .short('o')
                .required(true)
                .value_parser(value_parser!(PathBuf))
                .value_name("FOLDER")
                .help("New folder to write the data set into"),
            Arg::new("episodes")
                .long("episodes")
                .default_value("100")
                .value_parser(value_parser!(u64).range(1..=1_000_000))
                .value_name("N")
                .help("Number of demonstrations"),
            Arg::new("seed")
                .long("seed")
                .default_value("0")
                .value_parser(value_parser!(u64))
                .value_name("N")
                .help("Seed of the first episode; each further episode adds 1"),
            Arg::new("rate")
                .long("rate")
                .default_value("10")
                .value_parser(value_parser!(f64))
                .value_name("HZ")
                .help("Steps of the environment per second, for the time stamps"),
            Arg::new("task").long("task").value_name("WORDS").help("The task in words [default: ID]"),
            Arg::new("failures")
                .long("failures")
                .action(ArgAction::SetTrue)
                .help("Keep demonstrations that fail, too"),
            environment_flags::param_flag(),
            loading::quiet(),
        ])
        .after_help(EXAMPLES)
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let text = |name: &str| matches.get_one::<String>(name).cloned().unwrap_or_default();
    let id = text("id");
    let mut environment =
        opendr::environments::source(&id, &environment_flags::params(&id, matches)?)?.make()?;
    let spec = environment.spec().clone();
    let mut teacher = opendr::prior(&text("controller"))?.controller(&spec.observation)?;
    let options = RecordingOptions {
        episodes: matches.get_one::<u64>("episodes").map_or(100, |episodes| *episodes as usize),
        first_seed: matches.get_one("seed").copied().unwrap_or(0),
        successes_only: !matches.get_flag("failures"),
    };
    bar.begin("demonstrations", Some(options.episodes as u64), Unit::Items);
    let set = DemonstrationSet::record(&mut *teacher, &mut *environment, &options, &mut |_| bar.advance(1));
    bar.end();
    let rate = matches.get_one("rate").copied().unwrap_or(10.0);
    let task = matches.get_one::<String>("task").unwrap_or(&spec.id).clone();
    let out = matches.get_one::<PathBuf>("out").cloned().unwrap_or_default();
    let info = write_demonstrations(&set?, &spec, rate, &task, &out)?;
    bar.note(&format!(
        "{} demonstrations, {} steps, in {}",
        info.total_episodes,
        info.total_frames,
        out.display()
    ));
    Ok(Outcome::Done)
}
