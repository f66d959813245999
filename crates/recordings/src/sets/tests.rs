use std::path::Path;

use opendr_engine::data::Timeseries;
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Header, Value, ValueType};

use super::*;
use crate::{BagFormat, Recording, RecordingWriter};

const STEP: i64 = 100_000_000;
const START: i64 = 1_700_000_000_000_000_000;

fn series(stamp_ns: i64) -> Value {
    Timeseries::new(vec![1.0, 2.0], [2, 1]).unwrap().with_header(Header::new(stamp_ns, "chest")).into()
}

fn boxes(stamp_ns: i64) -> Value {
    let found = BoundingBox::new("person", 1.0, 2.0, 3.0, 4.0, 0.5);
    BoundingBoxList { header: Header::new(stamp_ns, "camera"), ..vec![found].into() }.into()
}

/// Records ten series, and boxes for all but the fifth, 5 ms apart by stamp and recorded half a second later.
fn record(path: &Path, format: BagFormat) {
    let mut answers = RecordingWriter::create(path, format).unwrap();
    for number in 0..10 {
        let stamp = START + number * STEP;
        answers.write("/series", series(stamp).as_value_ref(), stamp + 1).unwrap();
        if number != 4 {
            answers.write("/boxes", boxes(stamp + 5_000_000).as_value_ref(), stamp + 5 * STEP).unwrap();
        }
    }
    answers.finish().unwrap();
}

fn ports(need: Need) -> Vec<PortTopic> {
    vec![
        PortTopic::new("/series", ValueType::Timeseries),
        PortTopic { need, ..PortTopic::new("/boxes", ValueType::BoundingBoxList) },
    ]
}

#[test]
fn sets_have_matching_stamps() {
    let folder = tempfile::tempdir().unwrap();
    for format in BagFormat::ALL {
        let path = folder.path().join(format.name());
        record(&path, format);
        let recording = Recording::open(&path).unwrap();
        let mut sets = SyncedSets::open(&recording, ports(Need::Required)).unwrap();
        let found: Vec<_> = sets.by_ref().map(Result::unwrap).collect();
        assert_eq!((found.len(), sets.unmatched()), (9, 1), "{format}");
        for set in &found {
            let number = (set.stamp_ns - START) / STEP;
            assert_eq!((set.stamp_ns, set.log_time_ns), (START + number * STEP, set.stamp_ns + 1));
            assert_eq!(set.values[0].as_ref().unwrap(), &series(set.stamp_ns));
            let Some(Value::BoundingBoxList(list)) = &set.values[1] else { panic!("no boxes") };
            assert_eq!(list.header.stamp_ns, Some(set.stamp_ns + 5_000_000));
        }
        let optional = SyncedSets::open(&recording, ports(Need::Optional)).unwrap();
        let with: Vec<_> = optional.map(|set| set.unwrap().values[1].is_some()).collect();
        assert_eq!(with, [true, true, true, true, false, true, true, true, true, true], "{format}");
        assert_eq!(sets.held, 0);
    }
}

#[test]
fn a_message_without_a_stamp_has_the_time_of_its_recording() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.mcap");
    let mut answers = RecordingWriter::create(&path, BagFormat::Mcap).unwrap();
    let value = Value::from(Timeseries::new(vec![1.0, 2.0], [2, 1]).unwrap());
    answers.write("/stamped", value.as_value_ref(), START).unwrap();
    let bare = opendr_messages::MessageType::StdMsgsFloat32MultiArray;
    answers.write_as("/bare", value.as_value_ref(), bare, START).unwrap();
    answers.finish().unwrap();
    let recording = Recording::open(&path).unwrap();
    for topic in ["/stamped", "/bare"] {
        let mut sets =
            SyncedSets::open(&recording, vec![PortTopic::new(topic, ValueType::Timeseries)]).unwrap();
        let set = sets.next().unwrap().unwrap();
        assert_eq!(set.values[0].as_ref().unwrap().header().stamp_ns, Some(START));
        assert_eq!(set.stamp_ns, START);
        assert!(sets.next().is_none());
    }
    let error = recording.topic_for(ValueType::Timeseries, None).unwrap_err().to_string();
    assert!(error.contains("/bare  std_msgs/msg/Float32MultiArray, 1 messages (fits)"), "{error}");
    assert!(recording.topic_for(ValueType::Timeseries, Some("bare")).is_ok());
    assert!(recording.topic_for(ValueType::Timeseries, Some("/none")).is_err());
    let error = recording.topic_for(ValueType::Image, None).unwrap_err().to_string();
    assert!(error.contains("sensor_msgs/msg/Image, sensor_msgs/msg/CompressedImage"), "{error}");
}
