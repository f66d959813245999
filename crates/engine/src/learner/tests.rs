//! Tests of the learner interface with the counter.

use crate::data::{Image, Layout, PixelFormat};
use crate::dataset::{Dataset, DatasetIterator, Sample};
use crate::learner::counter::{Counter, CounterInputs, CounterParams, CounterTargets, write_model};
use crate::learner::{CheckOptions, FitJob, Handle, Learner, Ports, Registry, check_learner};
use crate::model::{Manifest, ModelWriter};
use crate::params::{ParamMap, ParamValue, Params};
use crate::target::{BoundingBox, BoundingBoxList};
use crate::{Device, ErrorKind, Header, Result, Value};

struct Samples(usize);

impl Dataset for Samples {}

impl DatasetIterator for Samples {
    fn len(&self) -> usize {
        self.0
    }

    fn get(&self, index: usize) -> Result<Sample> {
        Ok(Sample { data: vec![image(index as i64).into()], target: None })
    }
}

fn image(stamp: i64) -> Image {
    let image = Image::new(vec![0u8; 4], 2, 2, PixelFormat::Grey, Layout::Hwc).unwrap();
    image.with_header(Header::new(stamp, "camera"))
}

fn boxes(scores: &[f32]) -> BoundingBoxList {
    scores.iter().map(|score| BoundingBox::new(0, 0.0, 0.0, 1.0, 1.0, *score)).collect::<Vec<_>>().into()
}

fn scratch(name: &str) -> std::path::PathBuf {
    let folder = std::env::temp_dir().join(format!("opendr-learner-{name}-{}", std::process::id()));
    std::fs::remove_dir_all(&folder).ok();
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

fn ready(name: &str) -> Handle<Counter> {
    ready_with(name, "factor")
}

/// Returns a handle whose container states the factor 3 under the name `param`.
fn ready_with(name: &str, param: &str) -> Handle<Counter> {
    let folder = scratch(name);
    write_model(&folder.join("model"), 1, &ParamMap::from([(param.to_owned(), 3.into())])).unwrap();
    let mut handle = Handle::<Counter>::new(CounterParams::default(), Device::Cpu).unwrap();
    handle.load(folder.join("model")).unwrap();
    handle
}

fn count(targets: &CounterTargets) -> f32 {
    targets.count.boxes[0].left
}

#[test]
fn counter_passes_check_learner() {
    let folder = scratch("check");
    write_model(&folder.join("model"), 1, &ParamMap::new()).unwrap();
    let registry = crate::learners![Counter];
    let call = |stamp, scores: &[f32]| -> Vec<(&'static str, Value)> {
        vec![
            ("image", image(stamp).into()),
            ("detections", boxes(scores).into()),
            ("first", boxes(scores).into()),
        ]
    };
    let calls = [call(1, &[0.9, 0.1]), call(2, &[0.9, 0.8]), call(3, &[0.7])];
    let options = CheckOptions { model: &folder.join("model"), scratch: &folder, calls: &calls };
    check_learner(registry.find("counter").unwrap(), &options).unwrap();
}

#[test]
fn former_names_of_params_are_accepted() {
    let mut handle = ready_with("former", "scale");
    assert_eq!(handle.params().factor, 3);
    assert_eq!(handle.default_of("factor"), Some(ParamValue::Int(3)));
    assert_eq!(handle.default_of("scale"), Some(ParamValue::Int(3)));
    let error = handle.set("scale", ParamValue::Int(1)).unwrap_err();
    assert!(error.to_string().contains("cannot change while"), "{error}");
    let params = CounterParams::from_map(&ParamMap::from([("scale".to_owned(), 5.into())])).unwrap();
    assert_eq!(params.factor, 5);
}

#[test]
fn container_params_fill_defaults_only() {
    let mut handle = ready("params");
    assert_eq!(handle.params().factor, 3);
    assert_eq!(handle.default_of("factor"), Some(ParamValue::Int(3)));
    let own = handle.default_of("threshold");
    assert_eq!(own, handle.params().to_map().remove("threshold"));
    let (image, found) = (image(1), boxes(&[0.9, 0.6]));
    let input = || CounterInputs { image: &image, detections: &found, first: None };
    assert_eq!(count(&handle.infer(input()).unwrap()), 7.0);
    handle.set("threshold", ParamValue::Float(0.7)).unwrap();
    assert_eq!(count(&handle.infer(input()).unwrap()), 10.0);
    assert_eq!(handle.default_of("threshold"), own);
    let error = handle.set("factor", ParamValue::Int(1)).unwrap_err();
    assert!(error.to_string().contains("cannot change while"), "{error}");
    handle.reset();
    assert_eq!(count(&handle.infer(input()).unwrap()), 4.0);
}

#[test]
fn pieces_and_batches_keep_stamps() {
    let handle = ready("pieces");
    let (images, found) = ([image(1), image(2)], boxes(&[0.9]));
    let inputs = || {
        images
            .iter()
            .map(|image| CounterInputs { image, detections: &found, first: None })
            .collect::<Vec<_>>()
    };
    let batch = handle.stream().unwrap().infer_batch(inputs()).unwrap();
    assert_eq!(batch.iter().map(count).collect::<Vec<_>>(), [4.0, 7.0]);
    assert_eq!(batch[1].count.header, Header::new(2, "camera"));
    let (mut stream, mut emitted) = (handle.stream().unwrap(), Vec::new());
    for input in inputs() {
        stream.push(input, &mut |target| emitted.push(target)).unwrap();
    }
    stream.flush(&mut |target| emitted.push(target)).unwrap();
    assert_eq!(emitted.iter().map(count).collect::<Vec<_>>(), [7.0, 2.0]);
    assert_eq!(emitted[1].poses.header, Header::new(2, "camera"));
}

#[test]
fn entries_list_capabilities() {
    let registry: Registry = crate::learners![Counter];
    let entry = registry.find("CounterLearner").unwrap();
    assert!(entry.capabilities.fit && entry.capabilities.streaming && entry.stateful);
    assert_eq!(entry.fit_params[0].name, "epochs");
    assert_eq!(
        entry.ports.iter().map(|port| port.name).collect::<Vec<_>>(),
        ["image", "detections", "first"]
    );
    assert!(entry.ports[2].init && entry.ports[2].optional);
    assert_eq!(entry.outputs.iter().map(|output| output.name).collect::<Vec<_>>(), ["count", "poses"]);
    let mut learner = entry.make(&ParamMap::new(), Device::Cpu).unwrap();
    let output = scratch("fit").join("model");
    let dataset: &dyn DatasetIterator = &Samples(5);
    let job = FitJob::new(&output);
    let params = ParamMap::from([("epochs".to_owned(), 4.into())]);
    let statistics = learner.fit(&params, dataset.into(), None, &job).unwrap();
    assert_eq!(statistics.curves["loss"].len(), 4);
    let (image, found) = (image(1), boxes(&[0.9]));
    let ports = Ports::default().with("image", &image).with("detections", &found);
    let error = learner.infer(&ports).unwrap_err();
    assert!(error.to_string().contains("\"first\""), "{error}");
    let outputs = learner.infer(&ports.clone().with("first", &found)).unwrap();
    let Some(Value::BoundingBoxList(list)) = outputs.get("count") else { panic!("{outputs:?}") };
    assert_eq!(list.boxes[0].left, 1.0 + 5.0 + 2.0);
    learner.infer(&ports).unwrap();
}

#[test]
fn a_model_of_another_learner_is_rejected() {
    let folder = scratch("other");
    ModelWriter::new(folder.join("model"), Manifest::new("other", "")).unwrap().finish().unwrap();
    let mut handle = Handle::<Counter>::new(CounterParams::default(), Device::Cpu).unwrap();
    let error = handle.load(folder.join("model")).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(error.to_string().contains("\"other\""), "{error}");
    assert!(registry_rejects_duplicates());
}

fn registry_rejects_duplicates() -> bool {
    let registry = crate::learners![Counter];
    registry.add(crate::learner::Entry::dynamic(Counter::SPEC, &[], &[], &[], |_, _| unreachable!())).is_err()
}
