use opendr_engine::{ErrorKind, Random};

use crate::{Storage, TrialState};

/// Written by Optuna 5.0, `tests/tuning/write_sqlite.py`.
const STUDY: &[u8] = include_bytes!("../../../../../fuzz/corpus/optuna_sqlite/study.db");

#[test]
fn studies_of_optuna_are_read() {
    let storage = Storage::from_sqlite_bytes(STUDY).unwrap();
    let study = storage.studies().find(|study| study.name == "everything").unwrap();
    assert_eq!(study.user_attributes["note"].as_str().map(str::len), Some(20_000), "it spans pages");
    assert_eq!(study.trials.len(), 60);
    use TrialState::{Complete, Failed, Pruned, Waiting};
    for (number, trial) in study.trials.iter().enumerate() {
        let expected = match number {
            58 => Failed,
            59 => Waiting,
            number if number % 7 == 3 => Pruned,
            _ => Complete,
        };
        assert_eq!(trial.state, expected, "{number}");
        assert_eq!(trial.number, number);
    }
    let trial = &study.trials[5];
    assert_eq!(trial.params["whole"].value(), trial.params["whole"].number as i64);
    assert_eq!(trial.values, [trial.params["x"].number * 2.0]);
    assert_eq!(trial.reports.values().copied().collect::<Vec<_>>(), [5.0, 5.5]);
    assert_eq!(study.trials[0].values, [f64::INFINITY]);
    assert!(study.trials[1].reports[&0].is_nan() && study.trials[1].reports[&1] == f64::NEG_INFINITY);
    assert!(trial.ended > trial.started);
    let two = storage.studies().find(|study| study.name == "two").unwrap();
    assert_eq!(two.trials[0].values, [1.0, 2.0]);
}

#[test]
fn damaged_databases_never_panic() {
    let mut random = Random::new(2);
    let mut refused = 0;
    for _ in 0..2000 {
        let mut bytes = STUDY.to_vec();
        for _ in 0..=random.below(8) {
            let page = random.below(bytes.len() / 4096) * 4096;
            // Half of the changes are in the header of a page, which has the structure.
            let within = if random.chance(0.5) { 64 } else { 4096 };
            let at = page + random.below(within);
            bytes[at] = random.bits() as u8;
        }
        if random.chance(0.1) {
            let length = random.below(bytes.len());
            bytes.truncate(length);
        }
        refused += usize::from(Storage::from_sqlite_bytes(&bytes).is_err());
    }
    assert!((100..2000).contains(&refused), "{refused}");
}

#[test]
fn unreadable_databases_are_reported() {
    let kind = |bytes: &[u8]| Storage::from_sqlite_bytes(bytes).unwrap_err().kind();
    assert_eq!(kind(b""), ErrorKind::Format);
    assert_eq!(kind(b"SQLite format 3\0"), ErrorKind::Format);
    let folder = std::env::temp_dir().join(format!("opendr-sqlite-{}", std::process::id()));
    std::fs::create_dir_all(&folder).unwrap();
    let path = folder.join("study.db");
    assert_eq!(Storage::sqlite(&path).unwrap_err().kind(), ErrorKind::NotFound);
    std::fs::write(&path, STUDY).unwrap();
    assert_eq!(Storage::sqlite(&path).unwrap().studies().count(), 2);
    std::fs::write(folder.join("study.db-journal"), "hot").unwrap();
    assert_eq!(Storage::sqlite(&path).unwrap_err().kind(), ErrorKind::Unsupported);
    std::fs::remove_dir_all(folder).unwrap();
}
