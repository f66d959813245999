use std::fs;
use std::io::Write;
use std::path::PathBuf;

use opendr_engine::{ErrorKind, Random};
use serde_json::json;

use super::*;
use crate::{Advice, Direction, Distribution, Median, Outcome, RandomSearch, SearchSpace, Study, TrialState};

fn file(name: &str) -> PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-journal-{name}-{}", std::process::id()));
    fs::create_dir_all(&folder).unwrap();
    folder.join("study.log")
}

/// Fills a journal with a study that uses all features.
fn filled(path: &Path) -> StudyRecord {
    let study = Study::open(Storage::journal(path).unwrap(), "all", &[Direction::Maximize])
        .unwrap()
        .with_sampler(RandomSearch::new(3))
        .with_pruner(Median { startup_trials: 1, warmup_steps: 0 });
    let space = SearchSpace::new()
        .with("lr", Distribution::log_float(1e-5, 1e-1).unwrap())
        .and_then(|space| space.with("size", Distribution::stepped_int(16, 64, 16)?))
        .and_then(|space| {
            space.with("net", Distribution::categorical([json!("a"), json!(null), json!([1, 2])])?)
        })
        .unwrap();
    study.set_study_attribute("why \"NaN\"", json!({"a": [1, 2.5, null]})).unwrap();
    let trial = study.ask(&space).unwrap();
    assert_eq!(trial.report(1, f64::INFINITY).unwrap(), Advice::Continue);
    trial.set_user_attribute("path", "out/é").unwrap();
    trial.tell(Outcome::from(f64::INFINITY)).unwrap();
    let trial = study.ask(&space).unwrap();
    assert_eq!(trial.report(1, f64::NAN).unwrap(), Advice::Continue, "an infinite median stops no trial");
    trial.tell(Outcome::Pruned).unwrap();
    study.ask(&space).unwrap().tell(Outcome::Paused(json!({"checkpoint": 3}))).unwrap();
    study.ask(&space).unwrap().tell(Outcome::Failed("no disk".to_owned())).unwrap();
    study.enqueue(&[("lr".to_owned(), json!(1e-3))].into()).unwrap();
    study.ask(&space).unwrap().tell(Outcome::from(2.0)).unwrap();
    study.enqueue(&[].into()).unwrap();
    study.snapshot()
}

/// Compares records as text, since NaN is not equal to itself.
fn text(study: &StudyRecord) -> String {
    format!("{study:?}")
}

#[test]
fn a_journal_round_trips() {
    let path = file("back");
    let written = filled(&path);
    assert_eq!(written.trials[4].params["lr"].number, 1e-3);
    let states: Vec<_> = written.trials.iter().map(|trial| trial.state).collect();
    use TrialState::{Complete, Failed, Pruned, Waiting};
    assert_eq!(states, [Complete, Pruned, Waiting, Failed, Complete, Waiting]);
    let read = Storage::journal(&path).unwrap();
    assert_eq!(text(read.studies().next().unwrap()), text(&written));
    let copy = path.with_file_name("copy.log");
    let mut other = Storage::journal(&copy).unwrap();
    read.copy_study("all", &mut other).unwrap();
    let mut copied = Storage::journal(&copy).unwrap().studies().next().unwrap().clone();
    copied
        .trials
        .iter_mut()
        .zip(&written.trials)
        .for_each(|(copy, trial)| copy.worker.clone_from(&trial.worker));
    assert_eq!(text(&copied), text(&written));
    assert_eq!(read.copy_study("all", &mut other).unwrap_err().kind(), ErrorKind::InvalidParam);
    assert_eq!(read.copy_study("none", &mut other).unwrap_err().kind(), ErrorKind::NotFound);
    fs::remove_dir_all(path.parent().unwrap()).unwrap();
}

#[test]
fn a_torn_last_line_is_left_out_and_cut_off() {
    let path = file("torn");
    let written = filled(&path);
    let mut journal = fs::OpenOptions::new().append(true).open(&path).unwrap();
    journal.write_all(b"{\"op_code\":4,\"worker_id\":\"x").unwrap();
    drop(journal);
    let study = Study::open(Storage::journal(&path).unwrap(), "all", &[Direction::Maximize]).unwrap();
    assert_eq!(text(&study.snapshot()), text(&written));
    study.set_study_attribute("after", json!(1)).unwrap();
    assert!(!fs::read_to_string(&path).unwrap().contains("\"x{"));
    assert_eq!(Storage::journal(&path).unwrap().studies().next().unwrap().user_attributes["after"], json!(1));
    fs::remove_dir_all(path.parent().unwrap()).unwrap();
}

#[test]
fn a_damaged_line_is_reported_by_its_number() {
    let good = "{\"op_code\":0,\"worker_id\":\"w\",\"study_name\":\"s\",\"directions\":[1]}\n";
    assert_eq!(Storage::from_journal_bytes(good.as_bytes()).unwrap().studies().count(), 1);
    let create = "{\"op_code\":4,\"worker_id\":\"w\",\"study_id\":0,\"datetime_start\":null";
    for invalid in [
        "torn{\n".to_owned(),
        "[]\n".to_owned(),
        "{\"op_code\":11,\"worker_id\":\"w\"}\n".to_owned(),
        "{\"op_code\":4,\"worker_id\":\"w\",\"study_id\":-1}\n".to_owned(),
        "{\"op_code\":0,\"worker_id\":\"w\",\"study_name\":\"t\",\"directions\":[3]}\n".to_owned(),
        format!("{create},\"state\":9}}\n"),
        format!("{create},\"params\":{{\"x\":1}}}}\n"),
        format!("{create},\"datetime_complete\":\"yesterday\"}}\n"),
        format!("{create},\"intermediate_values\":{{\"one\":1}}}}\n"),
        "{\"op_code\":8,\"worker_id\":\"w\",\"trial_id\":0,\"user_attr\":{}}\n".to_owned(),
        "\u{fffd}\n".to_owned(),
    ] {
        let error = Storage::from_journal_bytes(format!("{good}{invalid}{good}").as_bytes()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Format, "{invalid}");
        assert!(error.to_string().contains("line 2"), "{error}");
    }
    let latin = [good.as_bytes(), &[0xe9, b'\n']].concat();
    assert!(Storage::from_journal_bytes(&latin).unwrap_err().to_string().contains("line 2"));
}

#[test]
fn changes_of_missing_items_have_no_effect() {
    let journal = "{\"op_code\":4,\"worker_id\":\"w\",\"study_id\":7,\"datetime_start\":null}\n\
                   {\"op_code\":7,\"worker_id\":\"w\",\"trial_id\":9,\"step\":1,\"intermediate_value\":NaN}\n\
                   {\"op_code\":6,\"worker_id\":\"w\",\"trial_id\":0,\"state\":1,\"values\":[Infinity]}\n\
                   {\"op_code\":1,\"worker_id\":\"w\",\"study_id\":7}\n\
                   {\"op_code\":10,\"worker_id\":\"w\"}\n";
    assert_eq!(Storage::from_journal_bytes(journal.as_bytes()).unwrap().studies().count(), 0);
}

#[test]
fn damaged_journals_never_panic() {
    let path = file("fuzz");
    filled(&path);
    let whole = fs::read(&path).unwrap();
    fs::remove_dir_all(path.parent().unwrap()).unwrap();
    let mut random = Random::new(11);
    let mut refused = 0;
    for _ in 0..3000 {
        let mut bytes = whole.clone();
        for _ in 0..=random.below(3) {
            let at = random.below(bytes.len());
            match random.below(3) {
                0 => bytes[at] = random.bits() as u8,
                1 => bytes.truncate(at + 1),
                _ => bytes.splice(at..at, [b"0123456789-[]{}\",:nNe\\\n"[random.below(22)]]).for_each(drop),
            }
        }
        refused += usize::from(Storage::from_journal_bytes(&bytes).is_err());
    }
    assert!((100..3000).contains(&refused), "{refused}");
}

#[test]
fn two_handles_on_a_file_see_each_other() {
    let path = file("two");
    let open = || Study::open(Storage::journal(&path).unwrap(), "s", &[Direction::Minimize]).unwrap();
    let (one, two) = (open(), open());
    let space = SearchSpace::new().with("x", Distribution::float(0.0, 1.0).unwrap()).unwrap();
    let numbers: Vec<usize> = (0..6).map(|at| [&one, &two][at % 2].ask(&space).unwrap().number()).collect();
    assert_eq!(numbers, [0, 1, 2, 3, 4, 5]);
    one.enqueue(&[].into()).unwrap();
    let queued = two.ask(&space).unwrap();
    assert_eq!(queued.number(), 6);
    assert_eq!(
        one.tell(6, Outcome::from(1.0)).unwrap_err().kind(),
        ErrorKind::InvalidParam,
        "the trial belongs to the other worker"
    );
    queued.tell(Outcome::from(0.5)).unwrap();
    one.refresh().unwrap();
    assert_eq!(one.best().unwrap().number, 6);
    fs::remove_file(&path).unwrap();
    fs::write(&path, "").unwrap();
    assert_eq!(one.refresh().unwrap_err().kind(), ErrorKind::Integrity);
    fs::remove_dir_all(path.parent().unwrap()).unwrap();
}
