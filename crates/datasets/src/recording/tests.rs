use opendr_engine::data::Image;
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Header, ValueRef};
use opendr_recordings::{BagFormat, RecordingWriter, WriteOptions};

use super::*;
use crate::folder::TemporaryFolder;

const START: i64 = 1_700_000_000_000_000_000;
const STEP: i64 = 100_000_000;

/// Records ten images, and boxes for every second one: stamped 3 ms later, recorded a second later.
fn record(path: &Path, format: BagFormat, pictures: &[&str]) {
    let options = WriteOptions { chunk_bytes: 300, ..format.into() };
    let mut answers = RecordingWriter::create(path, options).unwrap();
    for number in 0..10 {
        let stamp = START + number * STEP;
        let image = Image::from_rgb8(vec![number as u8; 4 * 2 * 3], 4, 2).unwrap();
        let image = image.with_header(Header::new(stamp, "camera"));
        for topic in pictures {
            answers.write(topic, ValueRef::Image(&image), stamp + 7).unwrap();
        }
        if number % 2 == 0 {
            let name = if number == 0 { "person" } else { "car" };
            let list = vec![BoundingBox::new(name, number as f32, 0.0, 1.0, 1.0, 1.0)];
            let list = BoundingBoxList { header: Header::new(stamp + 3_000_000, "camera"), ..list.into() };
            answers.write("/truth", ValueRef::BoundingBoxList(&list), stamp + 10 * STEP).unwrap();
        }
    }
    answers.finish().unwrap();
}

fn open(path: &Path, split: Option<&str>) -> Result<AnnotatedRecording> {
    let options = OpenOptions { split: split.map(str::to_owned), target: Some(ValueType::BoundingBoxList) };
    AnnotatedRecording::open(path, &options, &Problems::strict())
}

#[test]
fn annotations_are_matched_with_images() {
    let folder = TemporaryFolder::new();
    for format in BagFormat::ALL {
        let extension = if format == BagFormat::Bag1 { ".bag" } else { ".mcap" };
        let path =
            folder.path().join(format.name().to_owned() + if format.is_folder() { "" } else { extension });
        record(&path, format, &["/image"]);
        assert_eq!(AnnotatedRecording::recognise(&path), Recognition::Certain);
        let dataset = open(&path, None).unwrap();
        assert_eq!(dataset.len(), 5);
        for at in [3, 0, 4] {
            let sample = dataset.get(at).unwrap();
            let [Value::Image(image)] = &sample.data[..] else { panic!("no picture") };
            assert_eq!(image.header.stamp_ns, Some(START + at as i64 * 2 * STEP));
            let Some(Value::BoundingBoxList(list)) = sample.target else { panic!("no boxes") };
            assert_eq!(list.boxes[0].left, at as f32 * 2.0);
            // Messages of ROS 1 have no names: an unknown class is -1 there.
            if format != BagFormat::Bag1 {
                assert_eq!(list.label(&list.boxes[0]), Some(if at == 0 { "person" } else { "car" }));
                assert_eq!(list.boxes[0].name, Name::Index(i64::from(at == 0)));
            }
        }
        assert!(dataset.get(5).is_err());
        assert_eq!(dataset.name(1), (START + 2 * STEP).to_string());
    }
}

#[test]
fn topics_must_be_selected_if_several_fit() {
    let folder = TemporaryFolder::new();
    let path = folder.path().join("a.mcap");
    record(&path, BagFormat::Mcap, &["/left", "/right"]);
    let error = open(&path, None).unwrap_err().to_string();
    assert!(
        error.contains("--split TOPIC,TOPIC") && error.contains("/right  sensor_msgs/msg/Image"),
        "{error}"
    );
    assert_eq!(open(&path, Some("/left,/truth")).unwrap().data.0.name, "/left");
    assert_eq!(open(&path, Some("right")).unwrap().data.0.name, "/right");
    for wrong in ["/none", "/left,/right", "/none,/left"] {
        assert!(open(&path, Some(wrong)).is_err(), "{wrong}");
    }
}

#[test]
fn a_truncated_recording_is_a_problem() {
    let folder = TemporaryFolder::new();
    let path = folder.path().join("a.mcap");
    record(&path, BagFormat::Mcap, &["/image"]);
    let bytes = std::fs::read(&path).unwrap();
    std::fs::write(&path, &bytes[..bytes.len() / 2]).unwrap();
    assert!(open(&path, None).is_err());
    let problems = Problems::skipping();
    let options = OpenOptions { target: Some(ValueType::BoundingBoxList), ..OpenOptions::default() };
    let dataset = AnnotatedRecording::open(&path, &options, &problems).unwrap();
    assert!((1..5).contains(&dataset.len()), "{}", dataset.len());
    assert!(problems.list()[0].to_string().contains("truncated"));
    assert!((0..dataset.len()).all(|at| dataset.get(at).is_ok()));
}
