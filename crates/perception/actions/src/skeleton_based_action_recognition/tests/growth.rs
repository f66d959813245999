//! Growth of PST-GCN.

use opendr_perception_common::progressive::TopologyParams;
use opendr_perception_testing::stop_at::StopAt;

use super::*;

fn params(topology: &[usize]) -> ProgressiveSpatioTemporalGcnParams {
    let growth = TopologyParams {
        blocksize: 4,
        num_blocks: 3,
        num_layers: 2,
        topology: topology.to_vec(),
        block_threshold: 0.05,
        layer_threshold: 0.05,
    };
    ProgressiveSpatioTemporalGcnParams { clip: clip(), growth }
}

fn fit_params(epochs: usize) -> SpatioTemporalGcnFitParams {
    let mut fit_params = SpatioTemporalGcnFitParams { augment: false, ..Default::default() };
    let training = &mut fit_params.training;
    (training.epochs, training.batch_size, training.lr, training.num_workers) = (epochs, 9, 0.05, 0);
    fit_params
}

fn fit(
    params: ProgressiveSpatioTemporalGcnParams,
    epochs: usize,
    job: &FitJob<'_>,
) -> Result<Handle<ProgressiveSpatioTemporalGcn>> {
    let mut handle = Handle::<ProgressiveSpatioTemporalGcn>::new(params, Device::Cpu)?;
    let dataset: &dyn DatasetIterator = &Walks;
    let statistics = handle.fit(&fit_params(epochs), dataset.into(), None, job)?;
    let losses = &statistics.curves["loss"];
    assert!(losses.iter().all(|loss| loss.is_finite()));
    Ok(handle)
}

#[test]
fn the_network_grows_and_the_model_is_loaded() {
    let folder = Folder::new("grows");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder.0) };
    let mut handle = fit(params(&[]), 25, &job).unwrap();
    let topology = handle.params().growth.topology.clone();
    assert!(topology.iter().sum::<usize>() > 1, "it grew: {topology:?}");
    let right = (0..9).filter(|index| {
        let Value::SkeletonSequence(sequence) = Walks.get(*index).unwrap().data.remove(0) else {
            return false;
        };
        handle.infer(&sequence).unwrap().class == *index as i64 % 3
    });
    assert!(right.count() >= 8);
    let walks = (0..3).map(|seed| Value::SkeletonSequence(walk(seed, 9, 2))).collect();
    check::<ProgressiveSpatioTemporalGcn>(&job.model(), &folder.0.join("scratch"), walks);
    // A further training keeps the topology.
    let next = folder.0.join("next");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&next) };
    let dataset: &dyn DatasetIterator = &Walks;
    handle.fit(&fit_params(1), dataset.into(), None, &job).unwrap();
    assert_eq!(handle.params().growth.topology, topology);
}

#[test]
fn a_stopped_growth_resumes_bit_for_bit() {
    let folder = Folder::new("resumes");
    let (whole, parts) = (folder.0.join("whole"), folder.0.join("parts"));
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&whole) };
    let wanted = fit(params(&[]), 3, &job).unwrap();
    for steps in [2, 5, 6, u64::MAX] {
        let progress = StopAt::new(steps);
        let job = FitJob { device: Device::Cpu, resume: true, progress: &progress, ..FitJob::new(&parts) };
        let handle = fit(params(&[]), 3, &job).unwrap();
        if steps == u64::MAX {
            assert_eq!(handle.params().growth.topology, wanted.params().growth.topology);
        }
    }
    let file = |folder: &Path| Model::open(folder.join("model")).unwrap().file("network.bpk").unwrap();
    // Checkpoints and containers have the same weights; ids of parameters may differ, so the networks are compared.
    assert_eq!(file(&whole).len(), file(&parts).len());
    let onnx = |folder: &Path| Model::open(folder.join("model")).unwrap().file("model.onnx").unwrap();
    assert!(onnx(&whole) == onnx(&parts), "the networks differ");
}

#[test]
fn a_given_topology_is_trained_and_impossible_ones_are_refused() {
    let folder = Folder::new("topologies");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&folder.0) };
    let handle = fit(params(&[2, 1]), 1, &job).unwrap();
    assert_eq!(handle.params().growth.topology, [2, 1]);
    // Six layers leave no frame of twenty.
    let other = folder.0.join("other");
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&other) };
    let error = fit(params(&[1; 6]), 1, &job).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidParam);
}
