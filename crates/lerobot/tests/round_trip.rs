//! Data sets that are written and read again, and damaged ones.

#![allow(clippy::unwrap_used)]

use std::collections::BTreeMap;
use std::path::Path;

use opendr_engine::ErrorKind;
use opendr_lerobot::{
    Column, Feature, LeRobotSet, LeRobotWriter, SetOptions, Values, columns_of_bytes, convert,
};
use proptest::prelude::*;

fn options() -> SetOptions {
    let feature = |dtype: &str, width: usize| Feature::new(dtype, vec![width], &[]);
    SetOptions {
        fps: 10.0,
        robot_type: Some("arm".to_owned()),
        features: BTreeMap::from([
            ("observation.state".to_owned(), feature("float32", 3)),
            ("action".to_owned(), feature("float32", 2)),
            ("next.reward".to_owned(), feature("float64", 1)),
            ("next.done".to_owned(), feature("bool", 1)),
        ]),
    }
}

fn episode(start: f32, length: usize) -> BTreeMap<String, Column> {
    let numbers = |width: usize| (0..length * width).map(|at| start + at as f32).collect::<Vec<f32>>();
    let rewards = (0..length).map(|at| at as f64 / 7.0).collect();
    let done = (0..length).map(|at| at + 1 == length).collect();
    BTreeMap::from([
        ("observation.state".to_owned(), Column::lists(Values::Float32(numbers(3)), 3)),
        ("action".to_owned(), Column::lists(Values::Float32(numbers(2)), 2)),
        ("next.reward".to_owned(), Column::scalars(Values::Float64(rewards))),
        ("next.done".to_owned(), Column::scalars(Values::Bool(done))),
    ])
}

fn write(target: &Path) {
    let mut writer = LeRobotWriter::create(target, &options()).unwrap();
    for (index, length) in [4, 1, 7].into_iter().enumerate() {
        let task = if index == 1 { "place" } else { "pick" };
        writer.add(&episode(10.0 * index as f32, length), task, &BTreeMap::new()).unwrap();
    }
    let info = writer.finish().unwrap();
    assert_eq!((info.total_episodes, info.total_frames, info.total_tasks), (3, 12, 2));
}

#[test]
fn episodes_are_read_as_they_were_written() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("set");
    write(&target);
    let mut set = LeRobotSet::open(&target).unwrap();
    assert_eq!(set.info().features["action"].shape, [2]);
    assert_eq!(set.tasks().values().collect::<Vec<_>>(), ["pick", "place"]);
    for (index, length) in [4, 1, 7].into_iter().enumerate() {
        let record = &set.episodes()[index];
        assert_eq!(
            (record.length, record.tasks[0].as_str()),
            (length, if index == 1 { "place" } else { "pick" })
        );
        let written = episode(10.0 * index as f32, length);
        assert_eq!(set.read(index, &|name| written.contains_key(name)).unwrap(), written);
    }
    let times = set.read(2, &|name| name == "timestamp" || name == "index").unwrap();
    assert_eq!(times["index"].counts().unwrap(), [5, 6, 7, 8, 9, 10, 11]);
    assert_eq!(
        times["timestamp"].values,
        Values::Float32((0..7).map(|at| (f64::from(at) / 10.0) as f32).collect())
    );
    assert_eq!(set.read(3, &|_| true).unwrap_err().kind(), ErrorKind::NotFound);
    let copy = folder.path().join("copy");
    convert(&mut set, &copy, &|index| index != 1, &mut |_| {}).unwrap();
    let mut copied = LeRobotSet::open(&copy).unwrap();
    assert_eq!(copied.episodes().len(), 2);
    let wanted = |name: &str| name == "action";
    assert_eq!(copied.read(1, &wanted).unwrap(), set.read(2, &wanted).unwrap());
}

#[test]
fn wrong_episodes_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let mut writer = LeRobotWriter::create(&folder.path().join("set"), &options()).unwrap();
    let none = BTreeMap::new();
    let mut missing = episode(0.0, 3);
    missing.remove("action");
    let mut uneven = episode(0.0, 3);
    uneven.insert("next.done".to_owned(), Column::scalars(Values::Bool(vec![true])));
    let mut typed = episode(0.0, 3);
    typed.insert("next.reward".to_owned(), Column::scalars(Values::Float32(vec![0.0; 3])));
    for wrong in [missing, uneven, typed, episode(0.0, 0)] {
        assert_eq!(writer.add(&wrong, "pick", &none).unwrap_err().kind(), ErrorKind::InvalidInput);
    }
    assert_eq!(writer.finish().unwrap_err().kind(), ErrorKind::InvalidInput);
    assert!(LeRobotWriter::create(folder.path(), &options()).is_err(), "the folder is not empty");
    let mut named = options();
    named.features.insert("../x".to_owned(), Feature::new("float32", vec![1], &[]));
    assert!(LeRobotWriter::create(&folder.path().join("other"), &named).is_err());
}

#[test]
fn damaged_files_are_errors() {
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("set");
    write(&target);
    let path = target.join("data/chunk-000/file-000.parquet");
    let whole = std::fs::read(&path).unwrap();
    for cut in [0, 3, whole.len() / 2, whole.len() - 1] {
        std::fs::write(&path, &whole[..cut]).unwrap();
        let mut set = LeRobotSet::open(&target).unwrap();
        assert_eq!(set.read(0, &|_| true).unwrap_err().kind(), ErrorKind::Format, "{cut}");
    }
    std::fs::write(&path, &whole).unwrap();
    let info = target.join("meta/info.json");
    let text = std::fs::read_to_string(&info).unwrap();
    for (from, to) in
        [("data/chunk", "../chunk"), ("v3.0", "v9.9"), ("\"fps\": 10", "\"fps\": -1"), ("{", "")]
    {
        std::fs::write(&info, text.replace(from, to)).unwrap();
        assert!(LeRobotSet::open(&target).is_err(), "{from}");
    }
    assert_eq!(LeRobotSet::open(folder.path()).unwrap_err().kind(), ErrorKind::NotFound);
}

/// The humanoid of the shared test data: version 2.1, of which the first 67 episodes are present.
#[test]
fn a_real_set_is_converted() {
    let shared = std::env::var("OPENDR_TEST_DATA").unwrap_or_else(|_| "/work/shared".to_owned());
    let source = Path::new(&shared).join("data/lerobot_g1_pick_bottle");
    if !source.exists() {
        return;
    }
    let mut set = LeRobotSet::open(&source).unwrap();
    assert_eq!((set.episodes().len(), set.info().fps), (100, 30.0));
    let folder = tempfile::tempdir().unwrap();
    let target = folder.path().join("v3");
    convert(&mut set, &target, &|index| index < 5, &mut |_| {}).unwrap();
    let mut converted = LeRobotSet::open(&target).unwrap();
    for index in 0..5 {
        let wanted = |name: &str| name == "action" || name == "observation.state" || name == "timestamp";
        assert_eq!(converted.read(index, &wanted).unwrap(), set.read(index, &wanted).unwrap());
        assert_eq!(converted.episodes()[index].tasks, set.episodes()[index].tasks);
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(64))]

    #[test]
    fn no_bytes_panic(at in prop::collection::vec((0usize..4000, any::<u8>()), 1..8)) {
        let folder = tempfile::tempdir().unwrap();
        let target = folder.path().join("set");
        write(&target);
        let mut bytes = std::fs::read(target.join("data/chunk-000/file-000.parquet")).unwrap();
        let length = bytes.len();
        for (place, byte) in at {
            bytes[place % length] = byte;
        }
        drop(columns_of_bytes(bytes));
    }
}
