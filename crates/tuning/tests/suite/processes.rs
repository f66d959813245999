//! Processes that share a study by its journal, one of which is killed.

// Other systems do not report that a process is dead.

use std::fs;
use std::io::{BufRead, BufReader, Lines};
use std::path::{Path, PathBuf};
use std::process::{Child, ChildStdout, Command, Stdio};
use std::thread;
use std::time::Duration;

use opendr_tuning::{
    Asha, Budget, Direction, Distribution, Outcome, Progress, SearchSpace, Storage, Study, StudyRecord,
    TrialRecord, TrialState,
};
use serde_json::json;

const TRIALS: usize = 30;
const JOURNAL: &str = "OPENDR_TUNING_JOURNAL";
const HANG: &str = "OPENDR_TUNING_HANG";
const GO: &str = "go";

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

/// The program of each process; not a test of its own. In the first trial that it starts or resumes, it hangs forever, or
/// until a file exists beside the journal.
#[test]
fn worker() {
    let Some(path) = std::env::var_os(JOURNAL) else { return };
    let hang = std::env::var(HANG).unwrap_or_default();
    let go = Path::new(&path).with_file_name(GO);
    let objective = |trial: &opendr_tuning::Trial<'_>| {
        let x = trial.float("x")?;
        let begun = trial.resumed_from().map_or(0, |state| state["step"].as_i64().unwrap_or(0));
        for step in begun + 1..=9 {
            let here = match hang.as_str() {
                "begun" => step == 1,
                "promoted" => begun > 0,
                "until released" => step == 1 && !go.exists(),
                _ => false,
            };
            if here {
                println!("\nhanging in {}", trial.number());
                while hang != "until released" || !go.exists() {
                    thread::sleep(Duration::from_millis(5));
                }
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
        .args(["--exact", "processes::worker", "--nocapture"])
        .env(JOURNAL, path)
        .env(HANG, hang)
        .stdout(Stdio::piped());
    command.spawn().unwrap()
}

/// Waits until the process hangs. Returns the trial, and the rest of its output.
fn hanging(process: &mut Child) -> (usize, Lines<BufReader<ChildStdout>>) {
    let mut lines = BufReader::new(process.stdout.take().unwrap()).lines();
    let number = lines
        .by_ref()
        .map_while(Result::ok)
        .find_map(|line| line.strip_prefix("hanging in ")?.parse().ok())
        .unwrap();
    (number, lines)
}

/// Returns the study in its journal, after all workers have ended.
fn study_after(workers: Vec<Child>, path: &Path) -> StudyRecord {
    for worker in workers {
        assert!(worker.wait_with_output().unwrap().status.success());
    }
    let study = study(path).snapshot();
    // Resumed trials did not restart: no step was reported twice.
    let reports = fs::read_to_string(path).unwrap().matches("intermediate_value").count();
    assert_eq!(reports, study.trials.iter().map(|trial| trial.reports.len()).sum::<usize>());
    fs::remove_file(path.with_file_name(GO)).ok();
    assert_eq!(fs::read_dir(path.parent().unwrap()).unwrap().count(), 1, "a lock is left");
    fs::remove_dir_all(path.parent().unwrap()).unwrap();
    study
}

#[test]
fn a_killed_worker_loses_only_its_trial() {
    let path = folder("begun").join("study.log");
    let mut victim = spawn(&path, "begun");
    let (number, _lines) = hanging(&mut victim);
    let mut others: Vec<Child> = (0..3).map(|_| spawn(&path, "until released")).collect();
    let _lines: Vec<_> = others.iter_mut().map(hanging).collect();
    let running = |trial: &TrialRecord| trial.state == TrialState::Running;
    assert_eq!(study(&path).snapshot().trials.iter().filter(|trial| running(trial)).count(), 4);
    // SIGKILL cannot be handled by the process.
    victim.kill().unwrap();
    victim.wait().unwrap();
    fs::write(path.with_file_name(GO), "").unwrap();
    let study = study_after(others, &path);
    let lost: Vec<_> = study.trials.iter().filter(|trial| trial.state == TrialState::Failed).collect();
    assert_eq!(lost.iter().map(|trial| trial.number).collect::<Vec<_>>(), [number]);
    assert_eq!(lost[0].system_attributes["fail_reason"], json!("its worker died"));
    assert_eq!(study.trials.len(), TRIALS + 1);
    assert!(study.trials.iter().all(|trial| trial.state != TrialState::Running));
    assert!(study.complete().count() > 0);
}

#[test]
fn a_paused_trial_survives_its_worker() {
    let path = folder("promoted").join("study.log");
    let mut victim = spawn(&path, "promoted");
    let (number, _lines) = hanging(&mut victim);
    victim.kill().unwrap();
    victim.wait().unwrap();
    let study = study_after((0..3).map(|_| spawn(&path, "")).collect(), &path);
    assert!(
        study.trials.iter().all(|trial| !matches!(trial.state, TrialState::Failed | TrialState::Running))
    );
    assert_eq!(study.trials.len(), TRIALS);
    assert!(study.trials[number].is_paused() || study.trials[number].state == TrialState::Complete);
}
