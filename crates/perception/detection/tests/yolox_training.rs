//! YOLOX's `fit` from published weights and from random ones.

#![cfg(feature = "training")]
#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};

use opendr_detection::object_detection_2d::{
    FrozenPart, Yolox, YoloxFitParams, YoloxNetwork, YoloxParams, YoloxSize,
};
use opendr_engine::data::Image;
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{Fit, FitJob, Learner};
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_engine::{Device, ErrorKind, Random, Result, Value};
use opendr_training::weights::WeightTable;

const COCO80: &str = include_str!("../../../../models/classes/coco80.txt");

/// Images of one bright box on noise.
struct Drawn {
    count: usize,
    classes: Classes,
}

const SIDE: usize = 96;

impl Drawn {
    fn new(count: usize, classes: [&str; 2]) -> Self {
        Self { count, classes: classes.into_iter().collect() }
    }
}

impl Dataset for Drawn {}

impl DatasetIterator for Drawn {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::from_key([3, index as u64]);
        let mut pixels: Vec<u8> = (0..SIDE * SIDE * 3).map(|_| random.below(90) as u8).collect();
        let [width, height] = [0, 1].map(|_| 24 + random.below(32));
        let [left, top] = [random.below(SIDE - width), random.below(SIDE - height)];
        let class = index % 2;
        for row in top..top + height {
            for column in left..left + width {
                pixels[(row * SIDE + column) * 3 + 2 * class] = 250;
            }
        }
        let [x, y, width, height] = [left, top, width, height].map(|value| value as f32);
        let list: BoundingBoxList = vec![BoundingBox::new(class as i64, x, y, width, height, 1.0)].into();
        let list = BoundingBoxList { classes: self.classes(), ..list };
        let image = Image::from_rgb8(pixels, SIDE, SIDE)?;
        Ok(Sample { data: vec![image.into()], target: Some(list.into()) })
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-yolox-{}-{name}", std::process::id()));
        std::fs::remove_dir_all(&path).ok();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// Returns YOLOX-nano of COCO as a container in `folder`.
fn published(folder: &Folder) -> Option<Model> {
    let Some(shared) = std::env::var_os("OPENDR_TEST_DATA") else {
        println!("skipped: no OPENDR_TEST_DATA");
        return None;
    };
    let onnx = std::fs::read(Path::new(&shared).join("models/found/yolox_nano.onnx")).unwrap();
    let mut manifest = Manifest::new("yolox", "");
    manifest.classes = COCO80.lines().collect();
    let mut writer = ModelWriter::new(&folder.0, manifest).unwrap();
    writer.add("model.onnx", &onnx).unwrap();
    Some(writer.finish().unwrap())
}

fn params(epochs: usize, set: impl FnOnce(&mut YoloxFitParams)) -> YoloxFitParams {
    let mut params = YoloxFitParams { augment: false, ..YoloxFitParams::default() };
    params.training.epochs = epochs;
    params.training.batch_size = 4;
    params.training.num_workers = 0;
    params.training.ema = 0.0;
    set(&mut params);
    params
}

fn fit(base: Option<&Model>, params: &YoloxFitParams, dataset: &Drawn, output: &Folder) -> Result<Model> {
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output.0) };
    Yolox::fit(base, &YoloxParams::default(), params, DatasetRef::Iterator(dataset), None, &job)?;
    Model::open(job.model())
}

fn boxes(model: &Model, image: &Image, threshold: f32) -> BoundingBoxList {
    let params = YoloxParams { threshold, ..YoloxParams::default() };
    let learner = Yolox::load(model, params, Device::Cpu).unwrap();
    let mut boxes = BoundingBoxList::default();
    learner.infer_into(&mut (), image, &mut boxes).unwrap();
    boxes
}

#[test]
fn training_at_rate_zero_keeps_predictions() {
    let folder = Folder::new("base");
    let Some(base) = published(&folder) else { return };
    let output = Folder::new("same");
    let once = params(1, |params| {
        params.training.lr = 0.0;
        params.training.max_steps = 1;
    });
    // The classes of the network, so that its outputs are kept.
    let mut drawn = Drawn::new(4, ["person", "bicycle"]);
    drawn.classes = base.classes().clone();
    let trained = fit(Some(&base), &once, &drawn, &output).unwrap();
    assert_eq!(trained.classes(), base.classes());
    let photo = Path::new(&std::env::var_os("OPENDR_TEST_DATA").unwrap()).join("data/photos/bus.jpg");
    let photo = opendr_vision::open(photo).unwrap();
    let (before, after) = (boxes(&base, &photo, 0.3), boxes(&trained, &photo, 0.3));
    assert!(before.boxes.len() >= 4, "{before:?}");
    assert_eq!(before.boxes.len(), after.boxes.len());
    for (before, after) in before.boxes.iter().zip(&after.boxes) {
        assert_eq!(before.name, after.name);
        assert!((before.confidence - after.confidence).abs() < 1e-4, "{before:?} {after:?}");
        let near = before.corners().into_iter().zip(after.corners()).all(|(a, b)| (a - b).abs() < 0.05);
        assert!(near, "{before:?} {after:?}");
    }
}

#[test]
fn known_classes_keep_their_outputs() {
    let folder = Folder::new("known");
    let Some(base) = published(&folder) else { return };
    let device = burn::tensor::Device::flex();
    let table = WeightTable::from_bytes(&base.onnx().unwrap()).unwrap();
    let network = YoloxNetwork::from_table(&table, &device).unwrap();
    let classes: Classes = ["gripper", "dog"].into_iter().collect();
    let image = burn::tensor::Tensor::<4>::full([1, 3, 64, 64], 90.0, &device);
    let before = network.infer(image.clone());
    assert_eq!(before.dims()[2], 85);
    let after = network.with_classes(base.classes(), &classes).infer(image);
    let dog = base.classes().index("dog").unwrap() as usize;
    let column = |rows: &burn::tensor::Tensor<3>, column| {
        rows.clone().narrow(2, column, 1).into_data().try_to_vec::<f32>().unwrap()
    };
    assert_eq!(column(&before, 5 + dog), column(&after, 6));
    for value in 0..5 {
        assert_eq!(column(&before, value), column(&after, value));
    }
    assert!(column(&after, 5).iter().all(|score| *score < 0.5));
}

#[test]
fn random_weights_learn_a_batch() {
    let output = Folder::new("scratch");
    let learning = params(80, |params| {
        params.side = Some(SIDE);
        params.training.lr = 2e-3;
        params.training.warmup_steps = 5;
    });
    let drawn = Drawn::new(4, ["red", "blue"]);
    let model = fit(None, &learning, &drawn, &output).unwrap();
    for index in 0..4 {
        let Sample { data, target } = drawn.get(index).unwrap();
        let (Value::Image(image), Some(Value::BoundingBoxList(expected))) = (&data[0], target) else {
            panic!("no image with boxes")
        };
        let found = boxes(&model, image, 0.3);
        let best = found.boxes.first().unwrap_or_else(|| panic!("no box in image {index}"));
        assert_eq!(best.name, expected.boxes[0].name);
        let near =
            best.corners().into_iter().zip(expected.boxes[0].corners()).all(|(a, b)| (a - b).abs() < 8.0);
        assert!(near, "{best:?} {expected:?}");
    }
    // Its weights are a start for other classes, with frozen features.
    let further = Folder::new("further");
    let frozen = params(1, |params| params.freeze = FrozenPart::Features);
    let renamed = Drawn::new(4, ["blue", "green"]);
    let model = fit(Some(&model), &frozen, &renamed, &further).unwrap();
    assert_eq!(model.classes().iter().collect::<Vec<_>>(), ["blue", "green"]);
}

#[test]
fn every_size_has_the_paper_s_number_of_weights() {
    let device = burn::tensor::Device::flex();
    // Millions of parameters (Tables 3 and 4 of the paper), for 80 classes; the statistics of the normalisations are not counted.
    for (size, millions) in [(YoloxSize::Nano, 0.91), (YoloxSize::Tiny, 5.06), (YoloxSize::Small, 9.0)] {
        use burn::module::Module;
        let count = YoloxNetwork::new(size, 80, &device).num_params() as f64 / 1e6;
        assert!((count - millions).abs() < 0.05 * millions, "{}: {count}", size.name());
    }
}

#[test]
fn contradictions_are_refused() {
    let output = Folder::new("refused");
    let drawn = Drawn::new(4, ["red", "blue"]);
    let refused =
        |set: fn(&mut YoloxFitParams)| fit(None, &params(1, set), &drawn, &output).map(drop).unwrap_err();
    let error = refused(|params| params.side = Some(100));
    assert!(
        error.kind() == ErrorKind::InvalidParam && error.to_string().contains("multiple of 32"),
        "{error}"
    );
    let error = refused(|params| params.classes = vec!["green".to_owned()]);
    assert!(error.to_string().contains("green"), "{error}");
}
