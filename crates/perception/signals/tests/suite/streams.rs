//! A step of a stream allocates nothing.

use std::path::Path;

use opendr_engine::data::Timeseries;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::Model;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Random, Result};
use opendr_inference::{Session, TensorView};
use opendr_signals::sequence_classification::{CoTransEnc, CoTransEncFitParams, CoTransEncParams};
use opendr_test_allocator::allocations_of_thread;

/// Noise of two classes.
struct Noise;

impl Dataset for Noise {}

impl DatasetIterator for Noise {
    fn len(&self) -> usize {
        4
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let target = Category::new(index as i64 % 2, None);
        Ok(Sample { data: vec![noise(index as u64).into()], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        ["calm", "moving"].into_iter().collect()
    }
}

fn noise(seed: u64) -> Timeseries {
    let mut random = Random::new(seed);
    let numbers: Vec<f32> = (0..16).map(|_| random.normal() as f32).collect();
    Timeseries::new(numbers, [2, 8]).unwrap()
}

/// Returns the number of allocations of a bare run of the network for `features`, `tokens` and `layers`.
fn allocations_of_run(model: &Path, [features, tokens, layers]: [usize; 3]) -> usize {
    let session =
        Session::open(&Model::open(model).unwrap().file("model.onnx").unwrap(), Device::Cpu).unwrap();
    let kept = features * if layers > 1 { 4 } else { 2 };
    let (vector, memory) = (vec![0.0; features], vec![0.0; (tokens - 1) * kept]);
    let inputs = [
        TensorView::new(&[1, features], &vector[..]).unwrap(),
        TensorView::new(&[1], &[0_i64][..]).unwrap(),
        TensorView::new(&[tokens - 1, kept], &memory[..]).unwrap(),
    ];
    let run = || session.run(&inputs, |_| Ok(())).unwrap();
    (0..20).for_each(|_| run());
    let before = allocations_of_thread();
    run();
    allocations_of_thread() - before
}

#[test]
fn a_step_of_the_transformer_encoder_allocates_nothing() {
    let folder = std::env::temp_dir().join(format!("opendr-signals-allocation-{}", std::process::id()));
    for num_layers in [1, 2] {
        std::fs::remove_dir_all(&folder).ok();
        let params = CoTransEncParams { num_layers, hidden_dims: 16, sequence_len: 6, ..Default::default() };
        let mut fit_params = CoTransEncFitParams::default();
        (fit_params.training.epochs, fit_params.training.batch_size) = (1, 4);
        let mut handle = Handle::<CoTransEnc>::new(params, Device::Cpu).unwrap();
        let dataset: &dyn DatasetIterator = &Noise;
        let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder) };
        handle.fit(&fit_params, dataset.into(), None, &job).unwrap();
        let (input, mut category) = (noise(7), Category::default());
        for _ in 0..20 {
            handle.infer_into(&input, &mut category).unwrap();
        }
        let before = allocations_of_thread();
        for _ in 0..20 {
            handle.infer_into(&input, &mut category).unwrap();
        }
        let allocations = allocations_of_thread() - before;
        // ONNX Runtime, where its library is found, allocates for the outputs of a run.
        let of_runtime = 20 * 2 * allocations_of_run(&job.model(), [8, 6, num_layers]);
        assert_eq!(allocations, of_runtime, "with {num_layers} layers");
    }
    std::fs::remove_dir_all(&folder).ok();
}
