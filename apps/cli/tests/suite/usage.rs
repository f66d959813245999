//! Help, lists and wrong usage, which need no data.

use std::process::Stdio;

use crate::place::Place;
use serde_json::Value;

fn models(place: &Place, flags: &[&str]) -> Vec<Value> {
    let done = place.run(["models", "--json"].iter().chain(flags)).ends_with(0);
    serde_json::from_str::<Value>(&done.stdout).unwrap().as_array().unwrap().clone()
}

/// Learners with models in the zoo.
fn learners(place: &Place) -> Vec<String> {
    let name = |row: &Value| row["model"].as_str().unwrap().split('/').next().unwrap().to_owned();
    let mut learners: Vec<_> = models(place, &[]).iter().map(name).collect();
    learners.dedup();
    learners
}

#[test]
fn help_of_every_command_has_examples() {
    let place = Place::new();
    let help = place.run(["--help"]).ends_with(0).stdout;
    for command in ["infer", "fit", "export", "optimize", "models", "download", "bench", "runtime", "demo"] {
        assert!(help.contains(command), "{help}");
        let own = place.run([command, "--help"]).ends_with(0).stdout;
        assert!(own.contains(&format!("Examples:\n  opendr {command}")), "{own}");
    }
    assert!(help.contains("130 Ctrl-C"), "{help}");
}

#[test]
fn help_of_a_learner_lists_its_parameters() {
    let place = Place::new();
    for learner in learners(&place) {
        for command in ["infer", "bench"] {
            let help = place.run([command, &learner, "--help"]).ends_with(0).stdout;
            let (_, parameters) = help.split_once(&format!("Parameters of {learner}:\n")).unwrap();
            let parameters = parameters.split("\n\n").next().unwrap();
            let flags: Vec<_> = parameters.split("      --").skip(1).collect();
            assert!(!flags.is_empty());
            flags.iter().for_each(|flag| assert!(flag.contains("[default: "), "{flag}"));
        }
    }
}

#[test]
fn models_are_listed_and_filtered() {
    let place = Place::new();
    let all = models(&place, &[]);
    let table = place.run(["models"]).ends_with(0).stdout;
    for row in &all {
        assert!(table.contains(row["model"].as_str().unwrap()), "{table}");
        for key in ["task", "bytes", "download_bytes", "licence", "source", "cached"] {
            assert!(!row[key].is_null(), "{row}");
        }
    }
    let commercial = models(&place, &["--commercial"]);
    assert!(!commercial.is_empty() && commercial.len() < all.len());
    assert!(commercial.iter().all(|row| row["licence"]["commercial"] == true));
    let task = all[0]["task"].as_str().unwrap();
    let of_task = models(&place, &["--task", task]);
    assert!(!of_task.is_empty() && of_task.iter().all(|row| row["task"] == task));
    let real = models(&place, &["--grade", "real"]);
    assert!(real.iter().all(|row| row["grade"] == "real" && row["accuracy"]["value"].is_number()));
    assert!(real.iter().any(|row| row["accuracy"]["interval"][0].is_number()));
    let transfer = models(&place, &["--grade", "transfer"]);
    assert!(
        real.len() < transfer.len() && transfer.len() < models(&place, &["--grade", "demonstration"]).len()
    );
    place.run(["models", "--grade", "perfect"]).ends_with(2);
    let unknown = place.run(["models", "--task", "nonsense"]).ends_with(13);
    assert!(unknown.stderr.contains(task), "{}", unknown.stderr);
}

#[test]
fn wrong_usage_says_what_is_wrong() {
    let place = Place::new();
    let detector = models(&place, &["--task", "object_detection_2d"]).remove(0);
    let learner = detector["model"].as_str().unwrap().split('/').next().unwrap();
    let picture = place.write("a.jpg", "");
    let picture = picture.to_str().unwrap();
    let cases: &[(&[&str], i32, &str)] = &[
        (&[], 2, "Usage: opendr"),
        (&["nonsense"], 2, "unrecognized subcommand"),
        (&["infer"], 2, "<INPUT>"),
        (&["infer", learner], 2, "<INPUT>"),
        (&["infer", "nonsense", picture], 13, "no learner \"nonsense\"; there are"),
        (&["infer", "nonsense", "--help"], 13, "no learner"),
        (&["infer", "--unknown", "1", "nonsense", picture], 13, "no learner"),
        (&["infer", learner, picture, "--treshold", "0.5"], 2, "--threshold"),
        (&["infer", learner, picture, "--threshold", "much"], 12, "threshold = much should be"),
        (&["infer", learner, picture, "--threshold", "1.5"], 12, "out of range"),
        (&["infer", learner, picture, "--threshold=-1"], 12, "out of range"),
        (&["infer", learner, picture, "--device", "gpu"], 12, "cuda"),
        (&["infer", learner, picture, "--limit", "0"], 2, "--limit"),
        (&["infer", &format!("{learner}/nonsense"), picture], 13, "no variant"),
        (&["infer", learner, "/no/such.jpg"], 13, "/no/such.jpg"),
        (&["infer", learner, picture, "--model", "/no/such/model"], 13, "/no/such/model"),
        (&["infer", learner, picture, picture, "--out", "one.png"], 12, "one.png is one image"),
        (&["infer", learner, picture, "--json=/no/such/folder/x"], 13, "/no/such/folder/x"),
        (&["bench", learner, "--frames", "0"], 2, "--frames"),
        (&["download"], 2, "LEARNER"),
        (&["download", "nonsense"], 13, "nonsense"),
        (&["runtime", "nonsense"], 2, "nonsense"),
    ];
    for (arguments, code, wanted) in cases {
        let done = place.run(*arguments).ends_with(*code);
        assert!(done.stderr.contains(wanted) && done.stdout.is_empty(), "{arguments:?}: {done:#?}");
        let errors = done.stderr.lines().filter(|line| line.starts_with("error: "));
        assert!(errors.count() <= 1, "{}", done.stderr);
    }
}

#[test]
fn missing_models_are_reported_offline() {
    let place = Place::new();
    let mut command = place.command(["demo"]);
    command.env("OPENDR_MODEL_REPOSITORY", "").env("OPENDR_RUNTIME", "builtin");
    let done = place.start(command).finish();
    assert!(done.stdout.starts_with("runtime: built-in"), "{done:?}");
    assert!(done.code > 10 && done.stderr.contains("OPENDR_OFFLINE is set"), "{done:?}");
}

#[test]
fn runtime_says_what_is_in_use() {
    let place = Place::new();
    let mut command = place.command(["runtime"]);
    command.env("OPENDR_RUNTIME", "builtin");
    let done = place.start(command).finish().ends_with(0);
    assert!(done.stdout.starts_with("in use: built-in"), "{done:?}");
    assert!(done.stdout.contains("\nfound: built-in"), "{done:?}");
    let mut command = place.command(["runtime"]);
    command.env("OPENDR_RUNTIME", "nonsense");
    assert!(place.start(command).finish().ends_with(12).stderr.contains("onnxruntime, builtin"));
}

#[test]
fn closed_pipe_is_no_error() {
    let place = Place::new();
    for arguments in [&["models"][..], &["models", "--json"], &["--help"], &["runtime"]] {
        let mut command = place.command(arguments);
        let mut child = command.stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let stderr = String::from_utf8_lossy(&output.stderr);
        assert!(output.status.success() && stderr.is_empty(), "{arguments:?}: {stderr}");
    }
}
