//! Conformance of every learner of the registry to the contract of the interface.

use std::path::Path;

use opendr::data::{Image, Layout, Observation, PixelFormat};
use opendr::dataset::{DatasetIterator as _, ExternalDataset};
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::environment::{Environment as _, ResetOptions};
use opendr::learner::{CheckOptions, Entry, Port, check_learner};
use opendr::model::Model;
use opendr::target::{BoundingBox, BoundingBox3D, BoundingBox3DList, BoundingBoxList, Heatmap};
use opendr::{Header, Value, ValueType};

use crate::models::Models;

#[test]
fn every_learner_conforms() {
    let Some(models) = Models::find() else { return };
    let scratch = std::env::temp_dir().join(format!("opendr-conformance-{}", std::process::id()));
    let mut checked = 0;
    for entry in learners() {
        let Some(model) = models.get(entry.spec.name) else { continue };
        let calls = match entry.ports[0].value_type {
            _ if entry.spec.name == "visual_odometry" => drive(),
            ValueType::Observation => observations(&model),
            ValueType::Vector => vectors(&model),
            kind => calls(kind, &models),
        };
        let calls = if calls[0].len() == 1 { with_further_ports(entry, calls) } else { calls };
        let options = CheckOptions { model: &model, scratch: &scratch, calls: &calls };
        check_learner(entry, &options).unwrap();
        checked += 1;
    }
    println!("{checked} learners checked");
    assert!(checked > 0);
    std::fs::remove_dir_all(&scratch).ok();
}

/// Three frames of a stereo pair on its way.
fn drive() -> Vec<Vec<(&'static str, Value)>> {
    use opendr::simulation::drive::{Drive, DriveOptions};
    let drive = Drive::new(&DriveOptions { size: [320, 240], ..DriveOptions::default() }).unwrap();
    let frames = (0..3).map(|number| {
        let frame = drive.render(number).unwrap();
        let header = Header::new(1 + number as i64, "sensor");
        let images = [("image", frame.left), ("right", frame.right)];
        images.map(|(name, image)| (name, Value::from(image.with_header(header.clone())))).into()
    });
    frames.collect()
}

/// Three observations of the environment that a policy was trained in.
fn observations(model: &Path) -> Vec<Vec<(&'static str, Value)>> {
    let model = Model::open(model).unwrap();
    let mut environment =
        opendr::simulation::make(model.manifest().inputs["environment"].as_str().unwrap()).unwrap();
    let space = environment.spec().observation.clone();
    let mut numbers = vec![0.0; space.len()];
    let values = (0..3).map(|seed| {
        environment.reset(Some(seed), &ResetOptions::new(), &mut numbers).unwrap();
        opendr::rl::observation_from_numbers(&space, &numbers).unwrap().into()
    });
    stamped(ValueType::Observation, values)
}

/// Three vectors of the length that a model takes.
fn vectors(model: &Path) -> Vec<Vec<(&'static str, Value)>> {
    let model = Model::open(model).unwrap();
    let size = model.manifest().inputs["vector"]["size"][0].as_u64().unwrap();
    let vector = |scale: f32| {
        let numbers: Vec<f32> = (0..size).map(|at| (scale * at as f32).sin()).collect();
        opendr::data::Vector::from_data(numbers).unwrap().into()
    };
    stamped(ValueType::Vector, [0.3, 1.0, 2.5].map(vector))
}

/// A simulated lidar scan of a street.
fn street(number: usize) -> Value {
    let sample = opendr::simulation::street::StreetScans::new(7, 3).get(number).unwrap();
    match sample.data.into_iter().next() {
        Some(Value::PointCloudWithCalibration(scan)) => scan.cloud.into(),
        other => panic!("{other:?}"),
    }
}

/// Three different data of a type, each with a stamp.
fn calls(kind: ValueType, models: &Models) -> Vec<Vec<(&'static str, Value)>> {
    let values: Vec<Value> = match kind {
        ValueType::Image => ["photos/zidane.jpg", "photos/t1.jpg", "photos/chelsea.png"]
            .map(|name| opendr::vision::open(models.data(name)).unwrap().into())
            .into(),
        ValueType::BoundingBoxList => [0.0, 4.0, 8.0].map(|shift| boxes(shift).into()).into(),
        ValueType::BoundingBox3DList => [0.0, 0.4, 0.8].map(|shift| cars(shift).into()).into(),
        ValueType::Heatmap => [1.0, 0.7, 0.4].map(values).map(Value::from).into(),
        ValueType::PointCloud => [0, 1, 2].map(street).into(),
        ValueType::Video => [3, 9, 30].map(clip).map(Value::from).into(),
        kind => {
            let (format, path) = match kind {
                ValueType::Audio => ("speech_commands", "speech_commands_v0.02_test"),
                ValueType::Timeseries => ("ucr", "ecg/ECG5000_TRAIN.txt"),
                ValueType::SkeletonSequence => ("skeleton", "skeleton/jhmdb_GT_test_1.pkl"),
                other => panic!("there are no test data of the type {}", other.name()),
            };
            let dataset = ExternalDataset::new(models.data(path), format);
            let dataset = open(&dataset, &OpenOptions::default(), &Problems::strict()).unwrap();
            [0, dataset.len() / 2, dataset.len() - 1]
                .map(|index| dataset.get(index).unwrap().data.remove(0))
                .into()
        }
    };
    stamped(kind, values)
}

/// The calls under the name of the first port, with detections and pictures for further ports.
fn with_further_ports(
    entry: &Entry,
    mut calls: Vec<Vec<(&'static str, Value)>>,
) -> Vec<Vec<(&'static str, Value)>> {
    let [first, further @ ..] = entry.ports else { return calls };
    for (call, shift) in calls.iter_mut().zip([0.0, 4.0, 8.0]) {
        call.iter_mut().for_each(|(name, _)| *name = first.name);
        let beside: Vec<_> =
            further.iter().map(|port| (port.name, beside(port, &call[0].1, shift))).collect();
        call.extend(beside);
    }
    calls
}

/// The value of a further port beside `first`.
fn beside(port: &Port, first: &Value, shift: f32) -> Value {
    match (port.value_type, port.name, first) {
        (ValueType::BoundingBoxList, ..) => boxes(shift).into(),
        (ValueType::BoundingBox3DList, ..) => cars(shift).into(),
        (ValueType::Image, "depth", Value::Image(image)) => {
            let (width, height) = (image.width(), image.height());
            let metres: Vec<_> = (0..width * height).map(|at| 0.5 + (at % 97) as f32 / 200.0).collect();
            Image::new(metres, width, height, PixelFormat::Grey, Layout::Hwc).unwrap().into()
        }
        (ValueType::Observation, "pose", _) => {
            let pose = vec![0.1 * shift, 0.02 * shift, 3.5];
            Observation::from_data(pose).unwrap().into()
        }
        (ValueType::Image, "right", Value::Image(image)) => image.clone().into(),
        (ValueType::Image, ..) => checkered(shift as usize).into(),
        (other, ..) => panic!("there are no test data of the type {}", other.name()),
    }
}

/// A checkerboard image in many greys, moved to the right.
fn checkered(shift: usize) -> Image {
    let grey = |at: usize| {
        let (x, y) = ((at % 400 + 64 - shift) / 16, at / 400 / 16);
        (x * 37 + y * 91) as u8
    };
    let samples = (0..400 * 300).flat_map(|at| [grey(at); 3]).collect();
    Image::from_rgb8(samples, 400, 300).unwrap()
}

/// Three persons, moved to the right.
fn boxes(shift: f32) -> BoundingBoxList {
    let person = |left: f32| BoundingBox::new(0, left + shift, 50.0, 60.0, 150.0, 0.9);
    [10.0, 200.0, 300.0].map(person).to_vec().into()
}

/// Two cars, moved ahead.
fn cars(shift: f32) -> BoundingBox3DList {
    let car = |x: f32| BoundingBox3D {
        name: "Car".into(),
        dimensions: [4.0, 1.5, 1.8],
        location: [x, 1.6, 20.0 + shift],
        confidence: 0.9,
        ..BoundingBox3D::default()
    };
    [-5.0, 5.0].map(car).to_vec().into()
}

/// A heatmap of smooth hills.
fn values(step: f32) -> Heatmap {
    let values = (0..30 * 40).map(|at| (at as f32 * step).sin() + (at / 40) as f32 / 30.0).collect();
    Heatmap::from_scores(values, &[30, 40]).unwrap()
}

/// A square that crosses a clip of so many frames.
fn clip(frames: usize) -> opendr::data::Video {
    let (side, mut levels) = (48, Vec::new());
    for place in 0..3 * frames * side * side {
        let (frame, row, column) = (place / side / side % frames, place / side % side, place % side);
        let left = frame * (side - 8) / frames;
        levels.push(if (left..left + 8).contains(&column) && row < 20 { 0.9 } else { 0.1 });
    }
    opendr::data::Video::new(levels, [3, frames, side, side]).unwrap()
}

fn stamped(kind: ValueType, values: impl IntoIterator<Item = Value>) -> Vec<Vec<(&'static str, Value)>> {
    let stamped = values.into_iter().zip(1..).map(|(mut value, stamp)| {
        *value.header_mut() = Header::new(stamp, "sensor");
        vec![(kind.port(), value)]
    });
    stamped.collect()
}

/// All learners but the test learner, which the engine's own tests check: it has inputs besides an image.
fn learners() -> impl Iterator<Item = &'static Entry> {
    opendr::registry().entries().into_iter().filter(|entry| entry.spec.name != "counter")
}

fn zoo() -> opendr::zoo::Zoo {
    opendr::zoo::Zoo::new(opendr::zoo::ZooOptions::new("unused")).unwrap()
}

fn card<'a>(zoo: &'a opendr::zoo::Zoo, entry: &Entry) -> &'a opendr::zoo::Card {
    zoo.cards().iter().find(|card| card.learner == entry.spec.name).unwrap()
}

#[test]
fn every_learner_has_a_card_of_its_task() {
    let zoo = zoo();
    for entry in learners() {
        let card = card(&zoo, entry);
        assert_eq!(card.task, Some(entry.spec.task), "{}", entry.spec.name);
        let params = card.variant(None).map(|variant| variant.params.clone());
        entry.make(&params.unwrap_or_default(), opendr::Device::Cpu).unwrap();
        let trains = entry.capabilities.fit || entry.capabilities.fit_in;
        let has_weights = !card.variants.is_empty();
        let takes_networks = entry.spec.recognises_network.is_some();
        assert!(has_weights || trains || takes_networks, "{} has no weights and no fit", entry.spec.name);
    }
}
