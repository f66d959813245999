//! Files that the version before wrote: reports, journals, checkpoints and containers (`tests/formats/version_1`).

use std::fs;
use std::path::{Path, PathBuf};

use opendr::data::Image;
use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::evaluation::Outcome;
use opendr::learner::{AnyLearner, Ports};
use opendr::params::ParamMap;
use opendr::simulation::RegisteredSource;
use opendr::{Device, ErrorKind, FitEnvironments, FitOptions, Fitted, Silent};

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/formats/version_1").join(name)
}

/// A copy of a folder of the fixtures that is deleted at the end.
struct Copy(PathBuf);

impl Copy {
    fn of(name: &str) -> Self {
        let folder = std::env::temp_dir().join(format!("opendr-formats-{name}-{}", std::process::id()));
        fs::remove_dir_all(&folder).ok();
        copy(&fixture(name), &folder);
        Self(folder)
    }
}

impl Drop for Copy {
    fn drop(&mut self) {
        fs::remove_dir_all(&self.0).ok();
    }
}

fn copy(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap() {
        let path = entry.unwrap().path();
        let target = to.join(path.file_name().unwrap());
        match path.is_dir() {
            true => copy(&path, &target),
            false => fs::copy(&path, &target).map(drop).unwrap(),
        }
    }
}

fn empty_learner(name: &str) -> Box<dyn AnyLearner> {
    opendr::registry().find(name).unwrap().make(&ParamMap::new(), Device::Cpu).unwrap()
}

#[test]
fn a_report_of_an_evaluation_opens_and_is_written_with_the_names_of_today() {
    let mut outcome = Outcome::read(&fixture("eval/report.json")).unwrap();
    assert_eq!((outcome.counted, outcome.skipped, outcome.lowest_scores.len()), (11, 1, 11));
    assert_eq!(outcome.report.statistics.get("samples"), Some(11.0));
    assert!(outcome.problems[0].location.is_some(), "{:?}", outcome.problems);

    let copy = Copy::of("eval");
    outcome.write_report(&copy.0).unwrap();
    let written = fs::read_to_string(copy.0.join("report.json")).unwrap();
    assert!(written.starts_with("{\n  \"format_version\": 2,"), "{written}");
    assert!(written.contains("\"lowest_scores\"") && written.contains("\"location\""), "{written}");
    assert!(!written.contains("\"worst\"") && !written.contains("\"place\""), "{written}");
    let again = Outcome::read(&copy.0.join("report.json")).unwrap();
    assert_eq!((again.report, again.lowest_scores), (outcome.report, outcome.lowest_scores));
}

#[test]
fn reports_of_a_newer_version_and_other_files_are_refused_by_name() {
    let copy = Copy::of("eval");
    let path = copy.0.join("report.json");
    fs::write(&path, r#"{"format_version": 3}"#).unwrap();
    for error in [Outcome::read(&path).unwrap_err(), Fitted::read(&path).unwrap_err()] {
        assert_eq!(error.kind(), ErrorKind::Unsupported);
        assert!(
            error.to_string().contains("report.json") && error.to_string().contains("update OpenDR"),
            "{error}"
        );
    }
    let journal = Outcome::read(&copy.0.join("predictions.jsonl")).unwrap_err();
    assert_eq!(journal.kind(), ErrorKind::Format, "{journal}");
    assert_eq!(Outcome::read(&copy.0.join("missing.json")).unwrap_err().kind(), ErrorKind::NotFound);
}

#[test]
fn reports_of_trainings_open() {
    let fitted = Fitted::read(&fixture("fit/report.json")).unwrap();
    assert_eq!((fitted.samples, fitted.statistics.curves["loss"].len()), (8, 2));
    let policy = Fitted::read(&fixture("policy/report.json")).unwrap();
    assert_eq!(policy.environment.as_deref(), Some("CartPole-v1"));
}

#[test]
fn containers_open_and_predict() {
    let mut classifier = empty_learner("image_classifier");
    classifier.load(&fixture("fit/model")).unwrap();
    let image: Image = opendr::vision::open(fixture("pix/up/0.png")).unwrap();
    let outputs = classifier.infer(&Ports::one(&image)).unwrap();
    assert_eq!(classifier.classes().iter().collect::<Vec<_>>(), ["down", "up"]);
    assert_eq!(outputs.iter().count(), 1);
}

/// The loss of both epochs is that of the uninterrupted run of the version before, up to what differs between builds.
#[test]
fn a_training_resumes_from_its_checkpoint() {
    let copy = Copy::of("fit");
    let expected = Fitted::read(&fixture("fit/report.json")).unwrap().statistics.curves["loss"].clone();
    let options = serde_json::json!({
        "out": copy.0, "resume": true, "params": {"epochs": 2, "batch_size": 4, "width": 4, "checkpoint_after_iter": 2},
    });
    let options: FitOptions = serde_json::from_value(options).unwrap();
    let entry = opendr::registry().find("image_classifier").unwrap();
    let mut learner = empty_learner("image_classifier");
    let dataset = ExternalDataset::new(fixture("pix"), "auto");
    let fitted =
        opendr::fit(learner.as_mut(), entry, DatasetRef::External(&dataset).into(), &options, &Silent)
            .unwrap();
    let loss = &fitted.statistics.curves["loss"];
    assert_eq!(loss.len(), 2);
    assert!(
        loss.iter().zip(&expected).all(|(one, other)| (one - other).abs() < 1e-5),
        "{loss:?} {expected:?}"
    );
    let last = copy.0.join("checkpoints/step-0000000004");
    assert!(last.join("training_state.json").exists() && !last.join("standing.json").exists());
}

#[test]
fn a_training_of_a_policy_resumes_from_its_checkpoint() {
    let copy = Copy::of("policy");
    let expected = Fitted::read(&fixture("policy/report.json")).unwrap().statistics;
    let options = serde_json::json!({
        "out": copy.0, "resume": true,
        "params": {
            "preset": false, "net_arch": [4], "n_steps": 64, "total_timesteps": 256, "eval_freq": 128,
            "n_eval_episodes": 2, "checkpoint_after_iter": 128,
        },
    });
    let options: FitOptions = serde_json::from_value(options).unwrap();
    let entry = opendr::registry().find("ppo").unwrap();
    let mut learner = empty_learner("ppo");
    let env = RegisteredSource::new("CartPole-v1", &ParamMap::new()).unwrap();
    let environments = FitEnvironments { env: &env, val_env: None };
    let fitted = opendr::fit_policy(learner.as_mut(), entry, environments, &options, &Silent).unwrap();
    assert_eq!(fitted.statistics.curves, expected.curves);
    let last = copy.0.join("checkpoints/step-0000000256");
    assert!(last.join("evaluations.json").exists() && !last.join("measured.json").exists());
}
