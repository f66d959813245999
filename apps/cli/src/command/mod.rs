//! The subcommands, one file each.

#[cfg(feature = "ros")]
mod bag;
mod bench;
mod data;
mod demo;
mod download;
mod eval;
mod export;
mod fit;
mod import;
mod infer;
mod models;
mod online;
mod optimize;
mod report;
#[cfg(feature = "ros")]
mod ros;
mod runtime;
mod score;
mod sim;
#[cfg(feature = "webots")]
mod sim_export;
#[cfg(feature = "lerobot")]
mod sim_record;
mod sim_render;
mod tune;
mod view;

use std::ffi::{OsStr, OsString};

use clap::{ArgAction, ArgMatches, Command};
use opendr::Result;
use opendr::learner::Entry;

use crate::exit::{CODES, Outcome};
use crate::{environment_flags, learner_flags, loading, recordings};

const EXAMPLES: &str = "\
Examples:
  opendr demo                                         detect people in a photograph
  opendr models                                       list learners and models
  opendr infer LEARNER street.jpg --out boxes.png     predict on an image
  opendr infer LEARNER dance.mp4 --json               ... on a video, as lines of JSON
  opendr infer LEARNER drive.bag --out boxes.mcap     ... on a ROS recording
  opendr view LEARNER camera:0                        show predictions on a local web page
  opendr infer LEARNER --help                         list the parameters of a learner
  opendr eval LEARNER coco/ --out evaluated/          measure a learner on a data set
  opendr fit LEARNER coco/ --val-split val2017        train a learner
  opendr fit ppo --env CartPole-v1                    train a policy in an environment
  opendr sim view CartPole-v1 --learner ppo           record a video of its episodes
  opendr ros2 run LEARNER --image /camera/image_raw   run a learner as a ROS 2 node
  opendr data check coco/                             check a data set";

/// Builds the command-line grammar. A subcommand that runs a learner gets the flags of the learner that `arguments` name.
///
/// # Errors
/// `NotFound` for an unknown learner.
pub fn grammar(arguments: &[OsString]) -> Result<Command> {
    let mut commands = vec![
        infer::grammar(),
        eval::grammar(),
        fit::grammar(),
        tune::grammar(),
        export::grammar(),
        import::grammar(),
        optimize::grammar(),
        score::grammar(),
        report::grammar(),
        data::grammar(),
        sim::grammar(),
        models::grammar(),
        download::grammar(),
        bench::grammar(),
        runtime::grammar(),
        demo::grammar(),
        view::grammar(),
        #[cfg(feature = "ros")]
        bag::grammar(),
        #[cfg(feature = "ros")]
        ros::ros2(),
        #[cfg(feature = "ros")]
        ros::ros1(),
    ];
    if let Some((name, rest)) = arguments.get(1..).and_then(<[_]>::split_first)
        && let Some(command) = commands.iter_mut().find(|command| command.get_name() == name)
        && let Some(entry) = named_learner(command, rest)?
    {
        let add = match name.to_str() {
            Some("fit" | "tune") => learner_flags::add_for_fit,
            Some("bench") => learner_flags::add_for_bench,
            // Samples of data sets contain the further inputs; model files need none.
            Some("eval" | "import" | "optimize") => learner_flags::with_params,
            _ => learner_flags::add,
        };
        *command = add(std::mem::take(command), entry);
        if ["infer", view::NAME].map(OsStr::new).contains(&name.as_os_str()) {
            *command = recordings::ports_by_topic(std::mem::take(command), entry);
        }
        if environment_flags::is_policy(entry) {
            let add = match name.to_str() {
                Some("eval" | "fit" | "tune") => environment_flags::add_for_episodes,
                Some("bench") => environment_flags::add,
                _ => |command| command,
            };
            *command = add(std::mem::take(command));
        }
        if environment_flags::is_active(entry) {
            let add = match name.to_str() {
                Some("eval") => eval::add_for_active,
                Some("fit") => environment_flags::add_beside_dataset,
                _ => |command| command,
            };
            *command = add(std::mem::take(command));
        }
    }
    Ok(Command::new("opendr")
        .about("OpenDR in Rust: the open deep-learning toolkit for robotics")
        .version(env!("CARGO_PKG_VERSION"))
        .after_help(format!("{EXAMPLES}\n\n{CODES}"))
        .subcommand_required(true)
        .arg_required_else_help(true)
        .disable_help_subcommand(true)
        .subcommands(commands))
}

/// Runs the subcommand.
///
/// # Errors
/// The error of the subcommand.
pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let Some((name, matches)) = matches.subcommand() else { return Ok(Outcome::Done) };
    loading::with_threads(matches, || match name {
        "infer" => infer::run(matches),
        "eval" => eval::run(matches),
        "fit" => fit::run(matches),
        "tune" => tune::run(matches),
        "export" => export::run(matches),
        "import" => import::run(matches),
        "optimize" => optimize::run(matches),
        "score" => score::run(matches),
        "report" => report::run(matches),
        "data" => data::run(matches),
        "sim" => sim::run(matches),
        "models" => models::run(matches),
        "download" => download::run(matches),
        "bench" => bench::run(matches),
        "runtime" => runtime::run(matches),
        "demo" => demo::run(matches),
        view::NAME => view::run(matches),
        #[cfg(feature = "ros")]
        "bag" => bag::run(matches),
        #[cfg(feature = "ros")]
        "ros2" => ros::run_ros2(matches),
        #[cfg(feature = "ros")]
        "ros1" => ros::run_ros1(matches),
        _ => Ok(Outcome::Done),
    })
}

/// Returns the learner named by the first word after `command` that is neither a flag nor a flag's value.
///
/// The learner's own flags are not known at this point; all of them take a value.
fn named_learner(command: &Command, words: &[OsString]) -> Result<Option<&'static Entry>> {
    if !command.get_positionals().any(|argument| argument.get_id() == loading::LEARNER) {
        return Ok(None);
    }
    let mut words = words.iter();
    while let Some(word) = words.next() {
        let bytes = word.as_encoded_bytes();
        if !bytes.starts_with(b"-") {
            let word = word.to_string_lossy();
            let is_run = command.get_name() == view::NAME && view::curves_of(&word).is_some();
            return if is_run { Ok(None) } else { loading::entry(&word).map(Some) };
        }
        if !bytes.contains(&b'=') && !is_switch(command, word) {
            words.next();
        }
    }
    Ok(None)
}

/// Returns whether `word` is a flag without a value.
fn is_switch(command: &Command, word: &OsStr) -> bool {
    let name = word.to_string_lossy();
    let takes_none = |action: &ArgAction| !action.takes_values();
    ["--help", "-h"].contains(&name.as_ref())
        || command.get_arguments().any(|argument| {
            let long = argument.get_long().is_some_and(|long| name.strip_prefix("--") == Some(long));
            let short = argument.get_short().is_some_and(|short| name == format!("-{short}"));
            let bare = takes_none(argument.get_action()) || argument.is_require_equals_set();
            (long || short) && bare
        })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<OsString> {
        text.split(' ').map(OsString::from).collect()
    }

    #[test]
    fn grammar_of_every_learner_is_valid() {
        for entry in opendr::registry().entries() {
            for command in ["infer", "bench", "eval", "fit", "import", "tune", "view"] {
                grammar(&words(&format!("opendr {command} {}", entry.spec.name))).unwrap().debug_assert();
            }
        }
    }

    #[test]
    fn learner_is_found_among_flags() {
        let entries = opendr::registry().entries();
        let name = entries[0].spec.name;
        for line in [
            "NAME a.jpg",
            "--device cpu NAME a.jpg",
            "--device=cpu -q --json NAME a.jpg",
            "--json=out.jsonl -o out NAME/variant a.jpg",
            "--unknown 1 NAME",
        ] {
            let found = named_learner(&infer::grammar(), &words(&line.replace("NAME", name))).unwrap();
            assert_eq!(found.map(|entry| entry.spec.name), Some(name), "{line}");
        }
        assert!(named_learner(&infer::grammar(), &words("--help")).unwrap().is_none());
        assert!(named_learner(&infer::grammar(), &words("--out a.jpg nonsense")).is_err());
    }
}
