use burn::module::Module;
use burn::tensor::activation::softmax;
use burn::tensor::{Device as Trainer, Tensor, TensorData};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{ErrorKind, Random, Value};
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_training::Objective;

use super::objective::HeartObjective;
use super::*;
use crate::heart_anomaly_detection::{
    AttentionNeuralBagOfFeatureFitParams, AttentionNeuralBagOfFeatureKind, AttentionNeuralBagOfFeatureParams,
    AttentionType, GatedRecurrentUnit, GatedRecurrentUnitFitParams, GatedRecurrentUnitKind,
    GatedRecurrentUnitParams, QuantizationType,
};

const SIZES: HeartSizes = HeartSizes { shape: [100, 2], classes: 3, dropout: 0.0 };

/// Small networks.
fn recurrent() -> GatedRecurrentUnitParams {
    GatedRecurrentUnitParams { recurrent_unit: 16, ..Default::default() }
}

fn bag(
    quantization_type: QuantizationType,
    attention_type: AttentionType,
) -> AttentionNeuralBagOfFeatureParams {
    AttentionNeuralBagOfFeatureParams {
        n_codeword: 24,
        quantization_type,
        attention_type,
        ..Default::default()
    }
}

fn bags() -> impl Iterator<Item = AttentionNeuralBagOfFeatureParams> {
    use AttentionType::*;
    [Spatial, Temporal, Spatialsa, Temporalsa, Spatiotemporal]
        .into_iter()
        .flat_map(|kind| [QuantizationType::Nbof, QuantizationType::Tnbof].map(|what| bag(what, kind)))
}

/// Noise with unrelated classes.
struct Noise;

impl Dataset for Noise {}

impl DatasetIterator for Noise {
    fn len(&self) -> usize {
        12
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::new(index as u64);
        let numbers: Vec<f32> = (0..200).map(|_| random.normal() as f32).collect();
        let series = Timeseries::new(numbers, [100, 2])?;
        Ok(Sample { data: vec![series.into()], target: Some(Category::new(index as i64 % 3, None).into()) })
    }

    fn classes(&self) -> Classes {
        ["normal", "early", "other"].into_iter().collect()
    }
}

fn objective<K: TrainableHeart>(params: &K::Params) -> HeartObjective<'_, K> {
    HeartObjective { sizes: SIZES, params, class_weight: &[], classes: Noise.classes() }
}

fn fit(
    params: &GatedRecurrentUnitParams,
    fit: &GatedRecurrentUnitFitParams,
    folder: &str,
) -> Result<Category> {
    let output = std::env::temp_dir().join(format!("opendr-gru-{folder}-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let dataset: &dyn DatasetIterator = &Noise;
    let trained = (|| {
        let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
        let mut handle = Handle::<GatedRecurrentUnit>::new(params.clone(), Device::Cpu)?;
        let statistics = handle.fit(fit, dataset.into(), None, &job)?;
        assert_eq!(statistics.scalars["steps"], 2.0);
        let Some(Value::Timeseries(series)) = Noise.get(0)?.data.into_iter().next() else { panic!() };
        handle.infer(&series)
    })();
    std::fs::remove_dir_all(&output).ok();
    trained
}

fn overfits<K: TrainableHeart>(params: &K::Params) {
    let samples = (0..Noise.len()).map(|index| Noise.get(index).unwrap()).collect();
    let network = |device: &Trainer| K::network(params, &SIZES, device);
    let [before, after] = losses_on_one_batch(&objective::<K>(params), network, samples, 0.005);
    assert!(after < 0.05 * before, "{params:?}: {before} {after}");
}

#[test]
fn overfit_one_batch() {
    overfits::<GatedRecurrentUnitKind>(&recurrent());
    for kind in [AttentionType::Spatial, AttentionType::Spatiotemporal] {
        overfits::<AttentionNeuralBagOfFeatureKind>(&bag(QuantizationType::Nbof, kind));
    }
}

fn inference_equals_training_network<K: TrainableHeart>(params: &K::Params, number: usize) {
    let device = Trainer::flex();
    device.seed(5);
    let network = K::network(params, &SIZES, &device);
    let container = objective::<K>(params).container(&network).unwrap();
    let name = format!("opendr-{}-{number}-{}", K::SPEC.name, std::process::id());
    let folder = std::env::temp_dir().join(name);
    container.write(&folder).unwrap();
    let mut handle = Handle::<HeartLearner<K>>::new(Default::default(), Device::Cpu).unwrap();
    handle.load(&folder).unwrap();
    let Some(Value::Timeseries(series)) = Noise.get(1).unwrap().data.into_iter().next() else { panic!() };
    let category = handle.infer(&series).unwrap();
    let input = Tensor::<3>::from_data(TensorData::new(series.as_slice().to_vec(), [1, 100, 2]), &device);
    let wanted = softmax(K::forward(&network.valid(), input), 1).into_data().try_to_vec::<f32>().unwrap();
    assert!(category.probabilities.iter().zip(&wanted).all(|(got, wanted)| (got - wanted).abs() < 1e-5));
    assert_eq!(category.description, Noise.classes().name(category.class).cloned());
    assert_eq!(handle.params().to_map(), params.to_map());
    std::fs::remove_dir_all(&folder).ok();
}

#[test]
fn inference_equals_the_training_network() {
    inference_equals_training_network::<GatedRecurrentUnitKind>(&recurrent(), 0);
    for (number, params) in bags().enumerate() {
        inference_equals_training_network::<AttentionNeuralBagOfFeatureKind>(&params, number);
    }
}

#[test]
fn inputs_that_do_not_fit_the_network_are_refused() {
    let device = Trainer::flex();
    let params = recurrent();
    let network = GatedRecurrentUnitKind::network(&params, &SIZES, &device);
    let folder = std::env::temp_dir().join(format!("opendr-gru-unfit-{}", std::process::id()));
    objective::<GatedRecurrentUnitKind>(&params).container(&network).unwrap().write(&folder).unwrap();
    let mut handle = Handle::<GatedRecurrentUnit>::new(Default::default(), Device::Cpu).unwrap();
    handle.load(&folder).unwrap();
    let short = Timeseries::new(vec![0.0; 100], [50, 2]).unwrap();
    assert_eq!(handle.infer(&short).unwrap_err().kind(), ErrorKind::InvalidInput);
    let missing = Timeseries::new(vec![f32::NAN; 200], [100, 2]).unwrap();
    assert_eq!(handle.infer(&missing).unwrap_err().kind(), ErrorKind::InvalidInput);
    let mut other = GatedRecurrentUnitParams::default();
    other.heart.n_class = Some(2);
    let mut handle = Handle::<GatedRecurrentUnit>::new(other, Device::Cpu).unwrap();
    assert_eq!(handle.load(&folder).unwrap_err().kind(), ErrorKind::InvalidParam);
    std::fs::remove_dir_all(&folder).ok();
}

#[test]
fn infer_loads_the_model_of_fit() {
    let params = GatedRecurrentUnitParams { recurrent_unit: 8, ..Default::default() };
    let mut fit_params = GatedRecurrentUnitFitParams::default();
    (fit_params.training.epochs, fit_params.training.batch_size) = (1, 6);
    let category = fit(&params, &fit_params, "fit").unwrap();
    assert_eq!(category.probabilities.len(), 3);
}

#[test]
fn parameters_that_do_not_fit_the_data_are_refused() {
    let fit_params = GatedRecurrentUnitFitParams::default();
    let sized = |change: fn(&mut GatedRecurrentUnitParams)| {
        let mut params = GatedRecurrentUnitParams::default();
        change(&mut params);
        params
    };
    for (params, kind) in [
        (sized(|params| params.heart.n_class = Some(2)), ErrorKind::InvalidInput),
        (sized(|params| params.heart.in_channels = Some(1)), ErrorKind::InvalidParam),
        (sized(|params| params.heart.series_length = Some(99)), ErrorKind::InvalidParam),
    ] {
        assert_eq!(fit(&params, &fit_params, "refused").unwrap_err().kind(), kind);
    }
    let weights = GatedRecurrentUnitFitParams { class_weight: vec![1.0; 2], ..Default::default() };
    let refused = fit(&GatedRecurrentUnitParams::default(), &weights, "weights");
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::InvalidParam);
}

#[test]
fn defaults_of_training_are_those_of_opendr() {
    let training = GatedRecurrentUnitFitParams::default().training;
    assert_eq!((training.epochs, training.batch_size, training.lr, training.lr_min), (200, 32, 2e-4, 1e-5));
    let training = AttentionNeuralBagOfFeatureFitParams::default().training;
    assert_eq!((training.epochs, training.batch_size, training.lr, training.lr_min), (300, 32, 1e-3, 1e-5));
}
