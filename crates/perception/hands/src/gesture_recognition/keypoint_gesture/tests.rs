use std::env;
use std::path::{Path, PathBuf};

use opendr_engine::ErrorKind;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample, Subset};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::{Manifest, ModelWriter};
use opendr_perception_testing::overfit::losses_on_one_batch;

use super::network::{KeypointGestureNetwork, NetworkSizes};
use super::objective::GestureObjective;
use super::*;

/// Rows of input features with their class.
struct Rows {
    rows: Vec<(Vec<f32>, i64)>,
    classes: Classes,
}

impl Dataset for Rows {}

impl DatasetIterator for Rows {
    fn len(&self) -> usize {
        self.rows.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (row, class) = &self.rows[index];
        let vector = Vector::from_data(row.clone())?;
        Ok(Sample { data: vec![vector.into()], target: Some(Category::new(*class, None).into()) })
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

/// Returns the rows of a file of `OPENDR_TEST_DATA`: the class, then the values.
fn rows(file: &str, classes: &[&str]) -> Option<Rows> {
    let Some(shared) = env::var_os("OPENDR_TEST_DATA").map(PathBuf::from) else {
        println!("skipped: no OPENDR_TEST_DATA");
        return None;
    };
    let text = std::fs::read_to_string(shared.join("models/hand").join(file)).unwrap();
    let row = |line: &str| {
        let (class, numbers) = line.split_once(',').unwrap();
        (numbers.split(',').map(|number| number.parse().unwrap()).collect(), class.parse().unwrap())
    };
    Some(Rows { rows: text.lines().map(row).collect(), classes: classes.iter().copied().collect() })
}

/// Returns the accuracy on `held_out`.
fn accuracy(handle: &mut Handle<KeypointGesture>, held_out: &Subset<&Rows>) -> f64 {
    let right = (0..held_out.len()).filter(|index| {
        let sample = held_out.get(*index).unwrap();
        let vector = Vector::from_data(objective::row_of(&sample).unwrap().to_vec()).unwrap();
        let Some(opendr_engine::Value::Category(expected)) = sample.target else { panic!() };
        handle.infer(&vector).unwrap().class == expected.class
    });
    let accuracy = right.count() as f64 / held_out.len() as f64;
    println!("accuracy {accuracy:.4} on {} held out rows", held_out.len());
    accuracy
}

const HAND: (&str, &str, &[&str]) = ("hand", "gesture_keypoint/keypoint.csv", &["open", "close", "pointer"]);
const PATH: (&str, &str, &[&str]) =
    ("path", "gesture_point_history/point_history.csv", &["stop", "clockwise", "counterclockwise", "move"]);

#[test]
fn the_zoos_weights_classify_held_out_rows() {
    for (name, file, classes) in [HAND, PATH] {
        let Some(rows) = rows(file, classes) else { return };
        let [_, held_out] = Subset::split(&rows, 0.8, 2024).unwrap();
        let weights = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../models/weights/keypoint_gesture");
        let folder = env::temp_dir().join(format!("opendr-gesture-{name}-{}", std::process::id()));
        let mut manifest = Manifest::new("keypoint_gesture", name);
        manifest.classes = rows.classes();
        let mut writer = ModelWriter::new(&folder, manifest).unwrap();
        writer.add(FILE, &std::fs::read(weights.join(format!("{name}.onnx"))).unwrap()).unwrap();
        let mut handle = Handle::new(KeypointGestureParams::default(), Device::Cpu).unwrap();
        handle.load_model(writer.finish().unwrap()).unwrap();
        std::fs::remove_dir_all(&folder).unwrap();
        assert!(accuracy(&mut handle, &held_out) >= 0.97, "{name}");
    }
}

#[test]
fn infer_loads_the_model_of_fit() {
    let (_, file, classes) = HAND;
    let Some(rows) = rows(file, classes) else { return };
    let [training, held_out] = Subset::split(&rows, 0.8, 2024).unwrap();
    let output = env::temp_dir().join(format!("opendr-gesture-fit-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let mut handle = Handle::<KeypointGesture>::new(KeypointGestureParams::default(), Device::Cpu).unwrap();
    let mut params = KeypointGestureFitParams::default();
    params.training.epochs = 10;
    handle.fit(&params, (&training as &dyn DatasetIterator).into(), None, &job).unwrap();
    assert!(accuracy(&mut handle, &held_out) >= 0.95);
    let open = Vector::from_data(rows.rows[0].0.clone()).unwrap();
    assert_eq!(handle.infer(&open).unwrap().description.as_deref(), Some("open"));
    let short = Vector::from_data(vec![0.0; 41]).unwrap();
    assert_eq!(handle.infer(&short).unwrap_err().kind(), ErrorKind::InvalidInput);
    let broken = Vector::from_data(vec![f32::NAN; 42]).unwrap();
    assert_eq!(handle.infer(&broken).unwrap_err().kind(), ErrorKind::InvalidInput);
    std::fs::remove_dir_all(&output).ok();
}

#[test]
fn one_batch_is_overfitted() {
    let noise = |index: usize| {
        let mut random = opendr_engine::Random::new(index as u64);
        let row = (0..10).map(|_| random.normal() as f32).collect();
        (row, index as i64 % 3)
    };
    let rows = Rows { rows: (0..12).map(noise).collect(), classes: ["a", "b", "c"].into_iter().collect() };
    let sizes = NetworkSizes { numbers: 10, classes: 3, hidden: 32, dropout: 0.0 };
    let params = KeypointGestureParams::default();
    let objective = GestureObjective { sizes, params: &params, classes: rows.classes() };
    let samples = (0..rows.len()).map(|index| rows.get(index).unwrap()).collect();
    let network = |device: &burn::tensor::Device| KeypointGestureNetwork::new(&sizes, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, 0.01);
    assert!(after < 0.05 * before, "{before} {after}");
}
