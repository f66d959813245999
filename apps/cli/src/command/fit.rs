//! `opendr fit`: trains a learner on a data set or in an environment.

use std::path::PathBuf;

use clap::{Arg, ArgAction, ArgMatches, Command, value_parser};
use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::evaluation::Teacher;
use opendr::params::ParamMap;
use opendr::{FitData, FitEnvironments, FitOptions, Fitted, Progress, Result};
use serde_json::json;

use crate::exit::Outcome;
use crate::progress_bar::ProgressBar;
use crate::{
    class_flags, cluster, curves, dataset_flags, environment_flags, learner_flags, loading, stdout, viewing,
};

const EXAMPLES: &str = "\
Examples:
  opendr fit LEARNER coco/ --val-split val2017                 train, and evaluate after each epoch
  opendr fit LEARNER train/ --val val/ --out runs/mine         write into a folder of your own
  opendr fit LEARNER train/ --out runs/mine --resume           resume after Ctrl-C or a power cut
  opendr fit LEARNER/VARIANT labelled/                         fine-tune a pretrained model
  opendr fit LEARNER photos/ --teacher nanodet                 distil the predictions of another learner
  opendr fit ppo --env CartPole-v1                             train a policy in an environment
  opendr fit act pushes/                                       imitate demonstrations (opendr sim record)
  opendr fit active_face_recognition --env SphereView-Face-v1  train a recogniser and the camera's motion
  opendr fit LEARNER coco/ --accumulate 8 --ray auto           divide each step among the workers of a Ray cluster
  opendr fit LEARNER --help                                    list the learner's flags, such as --epochs

Without --out the output folder is runs/LEARNER-DATE; --resume without it uses the last of these. The trained model is in
model/ of the output folder: opendr infer LEARNER --model OUTPUT/model street.jpg";

/// Folder of the curves within the output folder.
pub const LOGS: &str = "log";

pub fn grammar() -> Command {
    Command::new("fit")
        .about("Train a learner on a data set, or a policy in an environment")
        .arg(loading::learner())
        .arg(dataset_flags::dataset())
        .args(dataset_flags::flags())
        .args(val_flags())
        .args(output_flags())
        .args(teacher_flags())
        .arg(cluster::flag(&["view", "teacher", "val-format"]))
        .arg(
            Arg::new("limit")
                .long("limit")
                .value_parser(value_parser!(usize))
                .value_name("N")
                .help("Train on the first N samples"),
        )
        .arg(
            Arg::new("pretrained")
                .long("pretrained")
                .action(ArgAction::SetTrue)
                .help("Start from the learner's pretrained model; LEARNER/VARIANT and --model do so too"),
        )
        .args(loading::flags())
        .after_help(EXAMPLES)
}

fn val_flags() -> [Arg; 3] {
    [
        Arg::new("val")
            .long("val")
            .value_parser(value_parser!(PathBuf))
            .value_name("DATASET")
            .help("Evaluate on this data set after each epoch"),
        Arg::new("val-format")
            .long("val-format")
            .default_value("auto")
            .value_name("FORMAT")
            .help("Format of --val; by default detected"),
        Arg::new("val-split")
            .long("val-split")
            .value_name("NAME")
            .help("Split to evaluate on: of --val or, without it, of DATASET"),
    ]
}

fn output_flags() -> [Arg; 5] {
    [
        Arg::new("out")
            .long("out")
            .alias("output")
            .short('o')
            .value_parser(value_parser!(PathBuf))
            .value_name("DIR")
            .help("Folder of checkpoints and model [default: runs/LEARNER-DATE]"),
        Arg::new("logging-path")
            .long("logging-path")
            .value_parser(value_parser!(PathBuf))
            .value_name("DIR")
            .help("Folder of TensorBoard event files and curves [default: OUTPUT/log]"),
        Arg::new("resume")
            .long("resume")
            .action(ArgAction::SetTrue)
            .help("Resume from the last checkpoint in the output folder"),
        Arg::new("json").long("json").action(ArgAction::SetTrue).help("Print a JSON object"),
        viewing::flag(),
    ]
}

fn teacher_flags() -> [Arg; 6] {
    [
        Arg::new("teacher").long("teacher").value_name("LEARNER[/VARIANT]").help(
            "Train on this learner's predictions (distillation); DATASET may then be a folder of images",
        ),
        Arg::new("teacher-threshold")
            .long("teacher-threshold")
            .value_parser(value_parser!(f32))
            .value_name("NUMBER")
            .requires("teacher")
            .help("Drop the teacher's predictions below this score [default: 0.5]"),
        Arg::new("teacher-classes")
            .long("teacher-classes")
            .value_delimiter(',')
            .value_name("NAME,...")
            .requires("teacher")
            .help("Train on these classes only [default: those of DATASET, or the teacher's]"),
        Arg::new("teacher-map")
            .long("teacher-map")
            .value_delimiter(',')
            .value_name("TEACHER=CLASS,...")
            .requires("teacher")
            .help("Map classes of the teacher to classes of the training, where their names differ"),
        Arg::new("teacher-by-number")
            .long("teacher-by-number")
            .action(ArgAction::SetTrue)
            .requires("teacher")
            .help("Match the teacher's classes by index and ignore their names"),
        Arg::new("keep-empty")
            .long("keep-empty")
            .action(ArgAction::SetTrue)
            .requires("teacher")
            .help("Keep the images without a prediction of the teacher"),
    ]
}

pub fn run(matches: &ArgMatches) -> Result<Outcome> {
    let spec = matches.get_one::<String>(loading::LEARNER).map_or("", String::as_str);
    let entry = loading::entry(spec)?;
    let bar = ProgressBar::new(matches.get_flag("quiet"));
    let params = learner_flags::params(entry, matches)?;
    let device = loading::device(matches)?;
    let options = options(entry.spec.name, learner_flags::fit_params(entry, matches)?, matches)?;
    let starts_from_model =
        spec.contains('/') || matches.contains_id("model") || matches.get_flag("pretrained");
    if let Some(address) = cluster::address(matches) {
        let model = match starts_from_model {
            true => Some(loading::model(spec, matches, &bar)?),
            false => None,
        };
        let call = json!({
            "dataset": dataset_flags::described(matches),
            "val_dataset": matches.get_one::<PathBuf>("val"),
            "options": {
                "params": options.params,
                "split": options.split,
                "val_split": options.val_split,
                "limit": options.limit,
                "out": options.out,
                "logging_path": options.logging_path,
                "resume": options.resume,
                "skip_broken": options.skip_broken,
            },
            "learner": { "name": entry.spec.name, "model": model, "params": params },
        });
        return cluster::run("fit", address, Fitted::FORMAT, matches, call);
    }
    let curves = curves::of_training(options.logging_path.clone().unwrap_or_default());
    let _viewer = viewing::of_curves(entry.spec.class, curves, matches, &bar)?;
    let fits = entry.capabilities.fit || entry.capabilities.fit_in;
    let mut learner = match starts_from_model && fits {
        true => loading::load(spec, &params, matches, &bar)?,
        false => entry.make(&params, device)?,
    };
    if environment_flags::is_policy(entry) {
        if entry.capabilities.fit && matches.contains_id(dataset_flags::DATASET) {
            let demonstrations = dataset_flags::external(matches);
            let data = FitData::from(DatasetRef::External(&demonstrations));
            let fitted = opendr::fit(learner.as_mut(), entry, data, &options, &bar)?;
            return print_fitted(&fitted, matches, &bar);
        }
        let source = environment_flags::source(matches, Some(learner.as_ref()))?;
        let environments = FitEnvironments { env: &source, val_env: None };
        let fitted = opendr::fit_policy(learner.as_mut(), entry, environments, &options, &bar)?;
        return print_fitted(&fitted, matches, &bar);
    }
    if environment_flags::is_active(entry) {
        let env = environment_flags::named(matches, Some(learner.as_ref()))?;
        let fitted = if matches.contains_id(dataset_flags::DATASET) {
            let dataset = dataset_flags::external(matches);
            opendr::fit_active(learner.as_mut(), entry, (&dataset).into(), &env, &options, &bar)?
        } else {
            let environments = FitEnvironments { env: &env, val_env: None };
            opendr::fit_policy(learner.as_mut(), entry, environments, &options, &bar)?
        };
        return print_fitted(&fitted, matches, &bar);
    }
    let val = matches.get_one::<PathBuf>("val");
    let val = val.map(|path| ExternalDataset::new(path, word(matches, "val-format").unwrap_or_default()));
    let external = dataset_flags::external(matches);
    let data = FitData {
        dataset: DatasetRef::External(&external),
        val_dataset: val.as_ref().map(DatasetRef::External),
        teacher: word(matches, "teacher").map(|teacher| load_teacher(&teacher, matches, &bar)).transpose()?,
        group: None,
    };
    let fitted = opendr::fit(learner.as_mut(), entry, data, &options, &bar)?;
    print_fitted(&fitted, matches, &bar)
}

fn options(name: &str, params: ParamMap, matches: &ArgMatches) -> Result<FitOptions> {
    let mut options = FitOptions {
        params,
        split: dataset_flags::split(matches),
        val_split: word(matches, "val-split"),
        limit: matches.get_one("limit").copied(),
        out: matches.get_one("out").cloned(),
        logging_path: matches.get_one("logging-path").cloned(),
        resume: matches.get_flag("resume"),
        teacher_threshold: matches.get_one("teacher-threshold").copied(),
        teacher_classes: matches.get_many("teacher-classes").into_iter().flatten().cloned().collect(),
        teacher_map: class_flags::pairs("teacher-map", matches)?,
        teacher_by_number: matches.get_flag("teacher-by-number"),
        keep_empty: matches.get_flag("keep-empty"),
        skip_broken: dataset_flags::skip_broken(matches),
        ..FitOptions::default()
    };
    let output = options.output_folder(name)?;
    options.logging_path.get_or_insert_with(|| output.join(LOGS));
    options.out = Some(output);
    Ok(options)
}

fn word(matches: &ArgMatches, flag: &str) -> Option<String> {
    matches.get_one(flag).cloned()
}

/// Loads the pretrained teacher.
fn load_teacher(spec: &str, matches: &ArgMatches, bar: &ProgressBar) -> Result<Teacher> {
    let threshold = matches.get_one("teacher-threshold").copied();
    let device = loading::device(matches)?;
    opendr::teacher_with(spec, threshold, device, |params| {
        loading::load_pretrained(spec, params, matches, bar)
    })
}

/// Prints the outcome, the path of the model, and how to resume.
fn print_fitted(fitted: &Fitted, matches: &ArgMatches, bar: &ProgressBar) -> Result<Outcome> {
    if matches.get_flag("json") {
        stdout::print_json(Fitted::FORMAT, fitted)?;
    } else {
        stdout::print(fitted.to_string().trim_end())?;
    }
    if !fitted.complete {
        let output = fitted.output.display();
        bar.note(&format!("resume with the same command and --out {output} --resume"));
    }
    Ok(if fitted.skipped == 0 { Outcome::Done } else { Outcome::SomeFailed })
}
