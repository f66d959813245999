//! `opendr infer` on recordings, and recordings of its predictions.

use std::path::Path;

use crate::place::Place;
use opendr::bags::{BagFormat, PortTopic, Recording, RecordingWriter, SyncedSets};
use opendr::data::{Audio, Image, Timeseries};
use opendr::model::{Manifest, ModelWriter};
use opendr::target::{BoundingBox, BoundingBoxList};
use opendr::{Header, Value, ValueType};

/// A time-series learner whose weights are embedded.
const LEARNER: &str = "gated_recurrent_unit";
const START: i64 = 1_700_000_000_000_000_000;
const STEP: i64 = 50_000_000;

fn beat(number: i64) -> Value {
    let data: Vec<f32> = (0..140).map(|at| (at as f32 / (15 + number) as f32).sin()).collect();
    Timeseries::new(data, [140, 1]).unwrap().with_header(Header::new(START + number * STEP, "chest")).into()
}

fn record(path: &Path, format: BagFormat, topics: &[&str]) {
    let mut answers = RecordingWriter::create(path, format).unwrap();
    for number in 0..20 {
        for topic in topics {
            answers.write(topic, beat(number).as_value_ref(), START + number * STEP + 3).unwrap();
        }
    }
    answers.finish().unwrap();
}

#[test]
fn every_format_is_read_and_written() {
    let place = Place::new();
    for format in BagFormat::ALL {
        let name = match format {
            BagFormat::Bag1 => "beats.bag".to_owned(),
            BagFormat::Mcap => "beats.mcap".to_owned(),
            folder => folder.name().to_owned(),
        };
        record(&place.path(&name), format, &["/beats"]);
        let out = format!("answers-{name}");
        let flags = ["--json", "--out", &out, "--bag-format", format.name()];
        let lines = place.run(["infer", LEARNER, &name].iter().chain(&flags)).ends_with(0).lines();
        assert_eq!(lines.len(), 20);
        assert_eq!(lines[7]["outputs"]["category"]["stamp_ns"], START + 7 * STEP);
        assert_eq!(lines[7]["outputs"]["category"]["frame_id"], "chest");
        let recording = Recording::open(place.path(&out)).unwrap();
        assert_eq!(recording.bag().format(), format);
        let port = PortTopic::new(format!("/{LEARNER}/category"), ValueType::Category);
        let sets: Vec<_> = SyncedSets::open(&recording, vec![port]).unwrap().map(Result::unwrap).collect();
        assert_eq!(sets.len(), 20);
        for (number, (set, line)) in sets.iter().zip(&lines).enumerate() {
            assert_eq!(set.log_time_ns, START + number as i64 * STEP + 3);
            let Some(Value::Category(category)) = &set.values[0] else { panic!("no category") };
            assert_eq!(category.header, Header::new(START + number as i64 * STEP, "chest"));
            assert_eq!(line["outputs"]["category"]["class"], category.class);
        }
    }
}

#[test]
fn topics_are_named_where_several_fit() {
    let place = Place::new();
    record(&place.path("two.mcap"), BagFormat::Mcap, &["/left", "/right"]);
    let done = place.run(["infer", LEARNER, "two.mcap"]).ends_with(11);
    assert!(done.stderr.contains("--topic") && done.stderr.contains("/right  opendr_msgs"), "{done:?}");
    let named = ["infer", LEARNER, "two.mcap", "--json", "--topic"];
    for topic in ["/left", "right", "timeseries=/right"] {
        assert_eq!(place.run(named.iter().chain(&[topic])).ends_with(0).lines().len(), 20);
    }
    let cases = [("/none", 13, "/left"), ("x=/left", 12, "the learner has timeseries")];
    for (topic, code, wanted) in cases {
        let done = place.run(named.iter().chain(&[topic])).ends_with(code);
        assert!(done.stderr.contains(wanted), "{done:?}");
    }
    let twice = place.run(named.iter().chain(&["/left", "--topic", "/right"])).ends_with(12);
    assert!(twice.stderr.contains("twice"), "{twice:?}");
}

#[test]
fn existing_files_are_not_replaced() {
    let place = Place::new();
    record(&place.path("a.bag"), BagFormat::Bag1, &["/beats"]);
    let before = std::fs::read(place.path("a.bag")).unwrap();
    let cases: &[(&[&str], &str)] = &[
        (&["--out", "a.bag", "--overwrite"], "is the input itself"),
        (&["--out", "b.mcap"], "already exists"),
        (&["--out", "seen.png"], "--out draws on images"),
        (&["--out", "x.db3"], "name its folder"),
        (&["--out", "x", "--with-input"], "has no recording format"),
    ];
    place.write("b.mcap", "mine");
    for (flags, wanted) in cases {
        let done = place.run(["infer", LEARNER, "a.bag"].iter().chain(*flags)).ends_with(12);
        assert!(done.stderr.contains(wanted), "{done:?}");
    }
    assert_eq!(std::fs::read(place.path("a.bag")).unwrap(), before);
    assert_eq!(std::fs::read(place.path("b.mcap")).unwrap(), b"mine");
    place.run(["infer", LEARNER, "a.bag", "--out", "b.mcap", "--overwrite"]).ends_with(0);
    let info = place.run(["bag", "info", "b.mcap", "--json"]).ends_with(0).lines();
    assert_eq!(info[0]["topics"][0]["messages"], 20, "{info:?}");
    // A folder with other things stays as it is.
    place.write("mine/notes.txt", "mine");
    let folder = ["--out", "mine", "--bag-format", "bag2_sqlite", "--overwrite"];
    let done = place.run(["infer", LEARNER, "a.bag"].iter().chain(&folder)).ends_with(11);
    assert!(done.stderr.contains("contains other files but no recording"), "{done:?}");
    // A command that fails before the first prediction leaves no file.
    place.run(["infer", LEARNER, "a.bag", "--out", "c.mcap", "--model", "none"]).ends_with(13);
    assert!(!place.path("c.mcap").exists());
}

#[test]
fn chunks_of_audio_are_one_stream() {
    let place = Place::new();
    let samples: Vec<f32> = (0..40_000).map(|at| (at as f32 / 9.0).sin() * 0.3).collect();
    let record = |name: &str, size: usize| {
        let mut answers = RecordingWriter::create(place.path(name), BagFormat::Mcap).unwrap();
        for (number, piece) in samples.chunks(size).enumerate() {
            let value = Value::from(Audio::new(piece.to_vec(), 1, 16_000).unwrap());
            answers.write("/audio", value.as_value_ref(), START + number as i64 * STEP).unwrap();
        }
        answers.finish().unwrap();
    };
    record("pieces.mcap", 1_600);
    record("whole.mcap", 40_000);
    let categories = |name: &str| -> Vec<_> {
        let done = place.run(["infer", "matchboxnet", name, "--json"]);
        let lines = done.ends_with(0).lines();
        lines.iter().map(|line| line["outputs"]["category"].clone()).collect()
    };
    let probabilities = |categories: &[serde_json::Value]| -> Vec<_> {
        categories.iter().map(|category| category["probabilities"].clone()).collect()
    };
    let (pieces, whole) = (categories("pieces.mcap"), categories("whole.mcap"));
    // Windows of one second, half a second apart.
    assert_eq!(pieces.len(), 4);
    assert_eq!(probabilities(&pieces), probabilities(&whole));
    // Each has the stamp of the chunk that completed it.
    let stamps: Vec<_> =
        pieces.iter().map(|category| category["stamp_ns"].as_i64().unwrap() - START).collect();
    assert_eq!(stamps, [9, 14, 19, 24].map(|piece| piece * STEP));
}

/// Runs the test learner of all surfaces, which counts boxes from an initial value per stream.
#[test]
fn further_inputs_come_from_topics() {
    if opendr::registry().find("counter").is_err() {
        println!("skipped: no feature opendr/test-learner");
        return;
    }
    let place = Place::new();
    let mut model = ModelWriter::new(place.path("model"), Manifest::new("counter", "")).unwrap();
    model.add("bias.bin", &[0]).unwrap();
    model.finish().unwrap();
    let mut answers = RecordingWriter::create(place.path("a.mcap"), BagFormat::Mcap).unwrap();
    let boxes = |count: usize, stamp: i64| {
        let list = vec![BoundingBox::new(0, 0.0, 0.0, 1.0, 1.0, 0.9); count];
        Value::from(BoundingBoxList { header: Header::new(stamp, "camera"), ..list.into() })
    };
    for number in 0..6 {
        let stamp = START + number * STEP;
        let image = Image::from_rgb8(vec![0; 12], 2, 2).unwrap().with_header(Header::new(stamp, "camera"));
        answers.write("/image", Value::from(image).as_value_ref(), stamp).unwrap();
        // The fourth image has no boxes.
        if number != 3 {
            answers.write("/boxes", boxes(1, stamp + 5_000_000).as_value_ref(), stamp + 9 * STEP).unwrap();
        }
        if let Some(count) = [(0, 3), (4, 1)].iter().find_map(|(at, count)| (*at == number).then_some(*count))
        {
            answers.write("/first", boxes(count, stamp).as_value_ref(), stamp + 1).unwrap();
        }
    }
    answers.finish().unwrap();
    let infer = ["infer", "counter", "a.mcap", "--model", "model", "--json"];
    let topics =
        ["--topic", "detections=/boxes", "--topic", "first=/first", "--out", "b.bag", "--with-input"];
    let done = place.run(infer.iter().chain(&topics)).ends_with(1);
    assert!(done.stderr.contains("1 messages for image had none for detections, first"), "{done:?}");
    let answered: Vec<_> = done.lines().into_iter().filter(|line| line["outputs"].is_object()).collect();
    let counts: Vec<_> = answered.iter().map(|line| &line["outputs"]["count"]["boxes"][0]["left"]).collect();
    // One prediction per two boxes, each counted twice; the last prediction comes at the end of the stream.
    assert_eq!(counts, [3.0 + 4.0, 1.0 + 4.0, 2.0]);
    let info = place.run(["bag", "info", "b.bag", "--json"]).ends_with(0).lines();
    let topics: Vec<_> = info[0]["topics"].as_array().unwrap().iter().collect();
    let messages =
        |name: &str| topics.iter().find(|topic| topic["name"] == name).unwrap()["messages"].clone();
    assert_eq!([messages("/image"), messages("/boxes"), messages("/first")], [5, 5, 2]);
    assert_eq!(messages("/counter/count"), 3);
    let unclear = place.run(infer.iter().chain(&["--topic", "first=/first"])).ends_with(11);
    assert!(unclear.stderr.contains("choose one with --topic detections=TOPIC"), "{unclear:?}");
    let missing = place.run(infer).ends_with(2);
    assert!(missing.stderr.contains("--detections"), "{missing:?}");
}
