use burn::module::Module as _;
use burn::tensor::activation::softmax;
use burn::tensor::{Device as Trainer, Tensor, TensorData};
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{Fit, FitJob, Handle};
use opendr_engine::{ErrorKind, Random};
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_training::Objective as _;

use super::network::MultilinearCompressiveNetwork;
use super::objective::CompressiveObjective;
use super::*;

const PICTURES: [usize; 3] = [3, 16, 20];
const MEASURED: [usize; 3] = [2, 9, 10];

fn params() -> MultilinearCompressiveParams {
    MultilinearCompressiveParams {
        input_shape: vec![16, 20, 3],
        compressed_shape: vec![9, 10, 2],
        ..Default::default()
    }
}

/// Stripes of three orientations.
struct Stripes;

impl Dataset for Stripes {}

impl DatasetIterator for Stripes {
    fn len(&self) -> usize {
        12
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::new(index as u64);
        let level = |at: usize| {
            let (row, column) = (at / 60, at / 3 % 20);
            let stripe = [row, column, row + column][index % 3] / 3 % 2;
            (100.0 * stripe as f64 + 20.0 * random.normal().abs()) as u8
        };
        let image = Image::from_rgb8((0..16 * 20 * 3).map(level).collect::<Vec<_>>(), 20, 16)?;
        Ok(Sample { data: vec![image.into()], target: Some(Category::new(index as i64 % 3, None).into()) })
    }

    fn classes(&self) -> Classes {
        ["rows", "columns", "diagonals"].into_iter().collect()
    }
}

fn picture(index: usize) -> Image {
    let data = Stripes.get(index).unwrap().data.into_iter().next();
    let Some(opendr_engine::Value::Image(image)) = data else { panic!() };
    image
}

fn objective(params: &MultilinearCompressiveParams) -> CompressiveObjective<'_> {
    CompressiveObjective {
        params,
        classes: Stripes.classes(),
        pictures: PICTURES,
        measured: MEASURED,
        flip: 0.0,
    }
}

fn network(device: &Trainer) -> MultilinearCompressiveNetwork {
    MultilinearCompressiveNetwork::new(PICTURES, MEASURED, 3, (8, 0.0), device)
}

#[test]
fn overfits_one_batch() {
    let samples = (0..Stripes.len()).map(|index| Stripes.get(index).unwrap()).collect();
    let [before, after] = losses_on_one_batch(&objective(&params()), network, samples, 0.005);
    assert!(after < 0.05 * before, "{before} {after}");
}

#[test]
fn inference_equals_the_training_network() {
    let device = Trainer::flex();
    device.seed(5);
    let network = network(&device);
    let folder = std::env::temp_dir().join(format!("opendr-compressive-{}", std::process::id()));
    objective(&params()).container(&network).unwrap().write(&folder).unwrap();
    let mut handle = Handle::<MultilinearCompressive>::new(Default::default(), Device::Cpu).unwrap();
    handle.load(&folder).unwrap();
    let category = handle.infer(&picture(1)).unwrap();
    let mut input = vec![0.0; 3 * 16 * 20];
    preprocess([16, 20]).run_into(picture(1).view(), &mut input).unwrap();
    let input = Tensor::<4>::from_data(TensorData::new(input, [1, 3, 16, 20]), &device);
    let network = network.valid();
    let measured = network.measure(input);
    assert_eq!(measured.dims(), [1, 2, 9, 10]);
    let wanted = softmax(network.classify(measured.clone()), 1).into_data().try_to_vec::<f32>().unwrap();
    assert!(category.probabilities.iter().zip(&wanted).all(|(got, wanted)| (got - wanted).abs() < 1e-5));
    let learner =
        MultilinearCompressive::load(&Model::open(&folder).unwrap(), params(), Device::Cpu).unwrap();
    let (mut measurement, mut again) = (Vec::new(), Category::default());
    learner.measure(&picture(1), &mut measurement).unwrap();
    assert_eq!((learner.measured(), measurement.len()), (MEASURED, 180));
    learner.infer_from_measurement(&measurement, &mut again).unwrap();
    assert_eq!(again.probabilities, category.probabilities);
    for wrong in [&measurement[1..], &[f32::NAN; 180]] {
        let refused = learner.infer_from_measurement(wrong, &mut again).unwrap_err();
        assert_eq!(refused.kind(), ErrorKind::InvalidInput);
    }
    std::fs::remove_dir_all(&folder).ok();
}

#[test]
fn infer_loads_the_model_of_fit_and_fit_refuses_invalid_shapes() {
    let output = std::env::temp_dir().join(format!("opendr-compressive-fit-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let mut fit_params = MultilinearCompressiveFitParams { width: 8, ..Default::default() };
    (fit_params.training.epochs, fit_params.training.batch_size) = (1, 6);
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let dataset = || DatasetRef::from(&Stripes as &dyn DatasetIterator);
    let mut handle = Handle::<MultilinearCompressive>::new(params(), Device::Cpu).unwrap();
    let statistics = handle.fit(&fit_params, dataset(), None, &job).unwrap();
    assert_eq!(statistics.scalars["steps"], 2.0);
    assert_eq!(handle.infer(&picture(0)).unwrap().probabilities.len(), 3);
    for compressed_shape in [vec![9, 10], vec![17, 10, 2], vec![9, 10, 4]] {
        let params = MultilinearCompressiveParams { compressed_shape, ..params() };
        let refused = MultilinearCompressive::fit(None, &params, &fit_params, dataset(), None, &job);
        assert_eq!(refused.unwrap_err().kind(), ErrorKind::InvalidParam);
    }
    std::fs::remove_dir_all(&output).ok();
}
