//! `opendr report` and the versions of what the commands write.

use std::path::Path;

use crate::place::Place;
use serde_json::Value;

fn fixture(name: &str) -> String {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests/formats/version_1");
    folder.join(name).display().to_string()
}

#[test]
fn reports_of_the_version_before_are_printed() {
    let place = Place::new();
    let evaluation = place.run(["report", &fixture("eval")]).ends_with(0).stdout;
    assert!(evaluation.contains("11 of 12 samples") && evaluation.contains("accuracy"), "{evaluation}");
    let training = place.run(["report", &fixture("fit/report.json")]).ends_with(0).stdout;
    assert!(training.contains("image_classifier trained on 8 samples"), "{training}");
}

#[test]
fn a_newer_report_is_refused_with_what_to_do() {
    let place = Place::new();
    place.write("report.json", r#"{"format_version": 9}"#);
    let refused = place.run(["report", "."]).ends_with(18).stderr;
    assert!(refused.contains("format version 9") && refused.contains("update OpenDR"), "{refused}");
    place.write("report.json", "[]");
    place.run(["report", "."]).ends_with(17);
    place.run(["report", "missing.json"]).ends_with(13);
}

#[test]
fn predictions_of_a_newer_version_are_refused() {
    let place = Place::new();
    let data = fixture("pix");
    place.write("newer.jsonl", "{\"format_version\": 9, \"input\": \"up/0.png\", \"outputs\": {}}\n");
    let refused =
        place.run(["score", "newer.jsonl", &data, "--metric", "classification"]).ends_with(18).stderr;
    assert!(refused.contains("format version 9"), "{refused}");
}

#[test]
fn json_on_standard_output_has_a_version() {
    let place = Place::new();
    let data = fixture("pix");
    for arguments in [&["data", "check", &data, "--json"][..], &["data", "stats", &data, "--json"]] {
        let report: Value = serde_json::from_str(&place.run(arguments).ends_with(0).stdout).unwrap();
        assert_eq!(report["format_version"], 2, "{report}");
    }
}
