//! Processes that share a study by its journal, one of which is killed.

#![allow(clippy::unwrap_used)]

use std::fs;
use std::io::{BufRead, BufReader};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, Stdio};
use std::thread;
use std::time::Duration;

use opendr_tuning::{
    Asha, Budget, Direction, Distribution, Outcome, Progress, SearchSpace, Storage, Study, StudyRecord,
    TrialState,
};
use serde_json::json;

const TRIALS: usize = 30;
const JOURNAL: &str = "OPENDR_TUNING_JOURNAL";
const HANG: &str = "OPENDR_TUNING_HANG";

fn folder(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-tuning-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    folder
}

fn study(path: &Path) -> Study {
    Study::open(Storage::journal(path).unwrap(), "shared", &[Direction::Minimize])
        .unwrap()
        .with_pruner(Asha::new(1, 3).unwrap())
}

fn space() -> SearchSpace {
    SearchSpace::new().with("x", Distribution::float(-1.0, 1.0).unwrap()).unwrap()
}

/// What each process does; no test of its own. One that hangs does so in the first trial it begins, or goes on with.
#[test]
fn worker() {
    let Some(path) = std::env::var_os(JOURNAL) else { return };
    let hang = std::env::var(HANG).unwrap_or_default();
    let objective = |trial: &opendr_tuning::Trial<'_>| {
        let x = trial.float("x")?;
        let begun = trial.resumed_from().map_or(0, |state| state["step"].as_i64().unwrap_or(0));
        for step in begun + 1..=9 {
            if (hang == "begun" && step == 1) || (hang == "promoted" && begun > 0) {
                println!("\nhanging in {}", trial.number());
                thread::sleep(Duration::from_secs(600));
            }
            match trial.report(step, x * x + 1.0 / step as f64)? {
                opendr_tuning::Advice::Pause if step < 9 => {
                    return Ok(Outcome::Paused(json!({"step": step})));
                }
                _ => {}
            }
        }
        Ok(Outcome::from(x * x))
    };
    study(Path::new(&path))
        .optimize(&space(), &Budget::total(TRIALS), objective, |_, _| Progress::Continue)
        .unwrap();
}

fn spawn(path: &Path, hang: &str) -> Child {
    let mut command = Command::new(std::env::current_exe().unwrap());
    command
        .args(["--exact", "worker", "--nocapture"])
        .env(JOURNAL, path)
        .env(HANG, hang)
        .stdout(Stdio::piped());
    command.spawn().unwrap()
}

/// The study after one worker was killed in a trial, whose number comes second, and three others have ended it.
#[cfg(target_os = "linux")]
fn study_after_kill(hang: &str) -> (StudyRecord, usize) {
    let folder = folder(hang);
    let path = folder.join("study.log");
    let mut victim = spawn(&path, hang);
    let lines = BufReader::new(victim.stdout.take().unwrap()).lines();
    let number =
        lines.map_while(Result::ok).find_map(|line| line.strip_prefix("hanging in ")?.parse().ok()).unwrap();
    victim.kill().unwrap();
    victim.wait().unwrap();
    let workers: Vec<Child> = (0..3).map(|_| spawn(&path, "")).collect();
    for worker in workers {
        assert!(worker.wait_with_output().unwrap().status.success());
    }
    let study = study(&path).snapshot();
    // Those that went on did not begin anew: no step was reported twice.
    let reports = fs::read_to_string(&path).unwrap().matches("intermediate_value").count();
    assert_eq!(reports, study.trials.iter().map(|trial| trial.reports.len()).sum::<usize>());
    assert_eq!(fs::read_dir(&folder).unwrap().count(), 1, "a lock is left");
    fs::remove_dir_all(folder).unwrap();
    (study, number)
}

#[cfg(target_os = "linux")]
#[test]
fn a_killed_worker_loses_its_one_trial_only() {
    let (study, number) = study_after_kill("begun");
    let lost: Vec<_> = study.trials.iter().filter(|trial| trial.state == TrialState::Failed).collect();
    assert_eq!(lost.iter().map(|trial| trial.number).collect::<Vec<_>>(), [number]);
    assert_eq!(lost[0].system_attributes["fail_reason"], json!("its worker died"));
    assert_eq!(study.trials.len(), TRIALS + 1);
    assert!(study.trials.iter().all(|trial| trial.state != TrialState::Running));
    assert!(study.complete().count() > 0);
}

#[cfg(target_os = "linux")]
#[test]
fn a_trial_that_had_been_paused_is_not_lost_at_all() {
    let (study, number) = study_after_kill("promoted");
    assert!(
        study.trials.iter().all(|trial| !matches!(trial.state, TrialState::Failed | TrialState::Running))
    );
    assert_eq!(study.trials.len(), TRIALS);
    assert!(study.trials[number].is_paused() || study.trials[number].state == TrialState::Complete);
}
