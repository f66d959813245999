//! Trains ST-GCN to tell actions by the moving joints of JHMDB, and measures it, on the first split of the data.
//!
//! The joints are the annotated ones of JHMDB (Jhuang et al., 2013), as DD-Net's authors hand them around: 433 recordings to
//! train on, 176 others to measure on. It makes the zoo's `spatio_temporal_gcn/jhmdb` and `co_st_gcn/jhmdb`:
//!
//! ```console
//! $ cargo run --release -p opendr-perception --features training --example train_actions -- shared/data/skeleton out
//! ```

use std::path::Path;

use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::dataset::{DatasetIterator, ExternalDataset};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result, Value};
use opendr_perception::skeleton_based_action_recognition::{
    GraphType, SpatioTemporalGcn, SpatioTemporalGcnFitParams, SpatioTemporalGcnParams, co_st_gcn_from,
};
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [skeletons, output, rest @ ..] = &arguments[..] else {
        return Err(Error::invalid_param("give the folder of the joints and one for the model"));
    };
    let part = |name: &str| {
        let dataset = ExternalDataset::new(skeletons, "jhmdb");
        let options = OpenOptions { split: Some(name.to_owned()), target: None };
        open(&dataset, &options, &Problems::strict())
    };
    let (training, test) = (part("jhmdb_GT_train_1")?, part("jhmdb_GT_test_1")?);
    let option = |name: &str, default: f64| {
        let at = rest.iter().position(|word| word == name);
        at.and_then(|at| rest.get(at + 1)?.parse().ok()).unwrap_or(default)
    };
    let channels = rest.iter().find_map(|word| word.strip_prefix("channels="));
    let channels =
        channels.map_or(vec![24, 32, 48], |list| list.split(',').filter_map(|n| n.parse().ok()).collect());
    let params = SpatioTemporalGcnParams {
        graph_type: GraphType::Jhmdb,
        num_person: 1,
        in_channels: 2,
        num_frames: option("frames", 40.0) as usize,
        channels,
        temporal_kernel: option("kernel", 7.0) as usize,
        ..Default::default()
    };
    let defaults = SpatioTemporalGcnFitParams::default();
    let fit_params = SpatioTemporalGcnFitParams {
        dropout: option("dropout", 0.2),
        label_smoothing: option("smoothing", 0.1) as f32,
        training: TrainingParams {
            epochs: option("epochs", 40.0) as usize,
            batch_size: 32,
            lr: option("lr", 0.004),
            lr_schedule: ScheduleKind::Cosine,
            optimizer: OptimizerKind::Adamw,
            weight_decay: option("decay", 0.02),
            seed: option("seed", 0.0) as u64,
            num_workers: 1,
            ..defaults.training
        },
        ..defaults
    };
    let mut handle = Handle::<SpatioTemporalGcn>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, ..FitJob::new(Path::new(output)) };
    let statistics = handle.fit(&fit_params, (&*training).into(), None, &job)?;
    println!("{statistics}");
    co_st_gcn_from(&Model::open(job.model())?)?.write(&Path::new(output).join("co_st_gcn"))?;
    for (name, part) in [("train", &training), ("test", &test)] {
        let (right, count) = (right(&mut handle, &**part)?, part.len());
        println!("{name}: of {count} {right} are right: {:.4}", right as f64 / count as f64);
    }
    Ok(())
}

fn right(handle: &mut Handle<SpatioTemporalGcn>, dataset: &dyn DatasetIterator) -> Result<usize> {
    let mut right = 0;
    for index in 0..dataset.len() {
        let sample = dataset.get(index)?;
        let (Some(Value::SkeletonSequence(sequence)), Some(Value::Category(action))) =
            (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("no skeletons with their action"));
        };
        right += usize::from(handle.infer(sequence)?.class == action.class);
    }
    Ok(right)
}
