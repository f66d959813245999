use std::f32::consts::TAU;

use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{ErrorKind, Random};
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::overfit::losses_on_one_batch;

use super::network::{BilinearNetwork, NetworkSizes};
use super::objective::ExpressionObjective;
use super::*;

const POINTS: usize = 12;
const FRAMES: usize = 6;

fn params() -> ProgressiveSpatioTemporalBlnParams {
    growing(TopologyParams { topology: vec![1, 2], ..ProgressiveSpatioTemporalBlnParams::default().growth })
}

fn growing(growth: TopologyParams) -> ProgressiveSpatioTemporalBlnParams {
    ProgressiveSpatioTemporalBlnParams { num_frames: FRAMES, growth, ..Default::default() }
}

/// Points on a circle, of which a third moves outwards: the upper, the lower right or the lower left one.
struct Faces;

impl Dataset for Faces {}

impl DatasetIterator for Faces {
    fn len(&self) -> usize {
        12
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let target = Category::new(index as i64 % 3, None);
        Ok(Sample { data: vec![face(index).into()], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        ["anger", "joy", "surprise"].into_iter().collect()
    }
}

fn face(index: usize) -> SkeletonSequence {
    let mut random = Random::new(index as u64);
    let [left, top, size] =
        [random.uniform(0.0, 300.0), random.uniform(0.0, 300.0), random.uniform(20.0, 90.0)];
    let mut numbers = Vec::new();
    for channel in 0..2 {
        for frame in 0..FRAMES {
            for point in 0..POINTS {
                let moves = if 3 * point / POINTS == index % 3 { 0.1 * frame as f32 } else { 0.0 };
                let angle = point as f32 / POINTS as f32 * TAU;
                let place = [angle.cos(), angle.sin()][channel] * (1.0 + moves);
                numbers.push([left, top][channel] + size * (place + 0.02 * random.normal() as f32));
            }
        }
    }
    SkeletonSequence::new(numbers, [1, 2, FRAMES, POINTS, 1]).unwrap()
}

#[test]
fn one_batch_is_overfitted() {
    let params = params();
    let sizes = NetworkSizes { features: 4, frames: FRAMES, points: POINTS, channels: vec![5, 10] };
    let objective = ExpressionObjective { params: &params, classes: Faces.classes(), sizes: sizes.clone() };
    let samples = (0..Faces.len()).map(|index| Faces.get(index).unwrap()).collect();
    let network = |device: &burn::tensor::Device| BilinearNetwork::new(&sizes, 3, 0.0, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, 0.01);
    assert!(after < 0.05 * before, "{before} {after}");
}

#[test]
fn infer_loads_the_model_of_fit() {
    let output = std::env::temp_dir().join(format!("opendr-pst-bln-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let mut fit_params = ProgressiveSpatioTemporalBlnFitParams { dropout: 0.0, ..Default::default() };
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.training.lr) = (60, 12, 0.05);
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let mut handle = Handle::<ProgressiveSpatioTemporalBln>::new(params(), Device::Cpu).unwrap();
    handle.fit(&fit_params, DatasetRef::from(&Faces as &dyn DatasetIterator), None, &job).unwrap();
    // Other faces, at other positions and sizes.
    let right = (100..112).filter(|at| handle.infer(&face(*at)).unwrap().class == *at as i64 % 3).count();
    assert!(right >= 11, "{right} of 12");
    let missing = SkeletonSequence::new(vec![0.0; 2 * POINTS], [1, 2, 1, POINTS, 1]).unwrap();
    assert_eq!(handle.infer(&missing).unwrap_err().kind(), ErrorKind::InvalidInput);
    let one = SkeletonSequence::new(vec![1.0, 2.0], [1, 2, 1, 1, 1]).unwrap();
    assert_eq!(handle.infer(&one).unwrap_err().kind(), ErrorKind::InvalidInput);
    let calls = (0..3).map(|index| Faces.get(index).unwrap().data).collect();
    check_trained_learner::<ProgressiveSpatioTemporalBln>(&job.model(), &output.join("scratch"), calls);
    let params = ProgressiveSpatioTemporalBlnParams { num_point: Some(68), ..Default::default() };
    let mut other = Handle::<ProgressiveSpatioTemporalBln>::new(params, Device::Cpu).unwrap();
    assert_eq!(other.load(job.model()).unwrap_err().kind(), ErrorKind::InvalidParam);
    std::fs::remove_dir_all(&output).ok();
}

#[test]
fn the_network_grows() {
    let output = std::env::temp_dir().join(format!("opendr-pst-bln-grows-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let mut fit_params = ProgressiveSpatioTemporalBlnFitParams { dropout: 0.0, ..Default::default() };
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.training.lr) = (15, 12, 0.05);
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let limits = TopologyParams { num_blocks: 2, num_layers: 2, ..params().growth };
    let params = growing(TopologyParams { topology: Vec::new(), block_threshold: 0.05, ..limits });
    let mut handle = Handle::<ProgressiveSpatioTemporalBln>::new(params, Device::Cpu).unwrap();
    let dataset = DatasetRef::from(&Faces as &dyn DatasetIterator);
    let statistics = handle.fit(&fit_params, dataset, None, &job).unwrap();
    let losses = &statistics.curves["growth_loss"];
    assert!(losses.iter().copied().fold(f64::MAX, f64::min) < losses[0], "{losses:?}");
    let topology = &handle.params().growth.topology;
    assert!(topology.iter().sum::<usize>() > 1, "it grew: {topology:?}");
    let mut fresh = Handle::<ProgressiveSpatioTemporalBln>::new(Default::default(), Device::Cpu).unwrap();
    fresh.load(job.model()).unwrap();
    assert_eq!(fresh.infer(&face(3)).unwrap(), handle.infer(&face(3)).unwrap());
    std::fs::remove_dir_all(&output).ok();
}

#[test]
fn defaults_are_those_of_opendr() {
    let TopologyParams { blocksize, num_blocks, num_layers, topology, .. } =
        ProgressiveSpatioTemporalBlnParams::default().growth;
    assert_eq!((blocksize, num_blocks, num_layers, topology.len()), (5, 100, 10, 0));
}
