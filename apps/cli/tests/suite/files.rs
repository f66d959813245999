//! `opendr infer` on time series and audio files; `opendr import` and `opendr export` of such a learner.

use crate::place::Place;

/// A time-series learner whose weights are embedded.
const LEARNER: &str = "gated_recurrent_unit";

/// A heartbeat of 140 samples.
fn series() -> String {
    (0..140).map(|at| format!("{}\n", (at as f32 / 20.0).sin())).collect()
}

#[test]
fn a_file_is_a_series() {
    let place = Place::new();
    place.write("beats/1.csv", series());
    place.write("beats/2.txt", format!("volt\n{}", series()));
    place.write("beats/notes.md", "no series");
    let text = place.run(["infer", LEARNER, "beats/1.csv"]).ends_with(0).stdout;
    assert!(text.starts_with("beats/1.csv\n"), "{text}");
    let lines = place.run(["infer", LEARNER, "beats", "--json"]).ends_with(0).lines();
    let inputs: Vec<_> = lines.iter().map(|line| line["input"].as_str().unwrap()).collect();
    assert_eq!(inputs, ["beats/1.csv", "beats/2.txt"]);
    assert_eq!(lines[0]["outputs"], lines[1]["outputs"]);
    assert!(lines[0]["outputs"]["category"]["confidence"].as_f64().unwrap() >= 0.5, "{lines:?}");
    assert_eq!(
        place.run(["infer", LEARNER, "beats", "--json", "--limit", "1"]).ends_with(0).lines().len(),
        1
    );
}

#[test]
fn invalid_files_are_reported_and_the_rest_is_processed() {
    let place = Place::new();
    place.write("1.csv", series());
    place.write("2.csv", "1\nabc\n");
    let done = place.run(["infer", LEARNER, "2.csv", "none.csv", "1.csv", "--json"]);
    assert!(
        done.stderr.contains("none.csv") && done.stderr.contains("line 2 has a column without a number"),
        "{}",
        done.stderr
    );
    let lines = done.ends_with(1).lines();
    assert!(lines.iter().any(|line| line["input"] == "1.csv" && line["outputs"].is_object()), "{lines:?}");
    assert!(
        lines.iter().any(|line| line["input"] == "2.csv" && line["error"]["kind"] == "Format"),
        "{lines:?}"
    );
    let alone = place.run(["infer", LEARNER, "none.csv"]).ends_with(13);
    assert!(alone.stderr.contains("none.csv"), "{}", alone.stderr);
    place.write("empty/notes.md", "");
    let empty = place.run(["infer", LEARNER, "empty"]).ends_with(13);
    assert!(empty.stderr.contains("no file .csv"), "{}", empty.stderr);
    let drawn = place.run(["infer", LEARNER, "1.csv", "--out", "seen.png"]).ends_with(12);
    assert!(drawn.stderr.contains("--out draws on images"), "{}", drawn.stderr);
}

#[test]
fn a_bare_network_is_imported_into_a_container() {
    let place = Place::new();
    place.write("1.csv", series());
    place.write("names.txt", "healthy\n\n ill \n");
    place.run(["export", LEARNER, "--out", "net.onnx"]).ends_with(0);
    // The flag of older releases.
    place.run(["export", LEARNER, "--output", "old.onnx"]).ends_with(0);
    let import = ["import", LEARNER, "net.onnx", "--out", "mine", "--recurrent-unit", "64"];
    place.run(import.into_iter().chain(["--classes", "names.txt"])).ends_with(0);
    let answer = |more: &[&str]| {
        let line = ["infer", LEARNER, "1.csv", "--json"].into_iter().chain(more.iter().copied());
        place.run(line).ends_with(0).lines().remove(0)["outputs"]["category"].clone()
    };
    let (wanted, own) = (answer(&[]), answer(&["--model", "mine"]));
    assert_eq!(own["confidence"], wanted["confidence"]);
    assert!(["healthy", "ill"].iter().any(|name| own.to_string().contains(name)), "{own}");
    // A model that another learner cannot load replaces nothing.
    let refused = place.run(["import", "matchboxnet", "net.onnx", "--out", "mine"]);
    assert!(refused.stderr.contains("matchboxnet cannot load this model"), "{}", refused.stderr);
    refused.ends_with(17);
    assert_eq!(answer(&["--model", "mine"]), own);
    place.write("notes.txt", "no model");
    let unknown = place.run(["import", LEARNER, "notes.txt", "--out", "other"]).ends_with(18);
    assert!(unknown.stderr.contains("no known format"), "{}", unknown.stderr);
    assert!(!place.path("other").exists());
}
