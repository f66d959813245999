//! Trains ST-GCN on the skeletons of JHMDB and measures its accuracy on the first split of the data set.
//!
//! The joints are the annotated ones of JHMDB (Jhuang et al., 2013), in the files that DD-Net's authors distribute: 433
//! recordings for training, 176 others for testing. The example produces the zoo's `spatio_temporal_gcn/jhmdb` and
//! `co_st_gcn/jhmdb`:
//!
//! ```console
//! $ cargo run --release -p opendr-actions --features training --example train_actions -- shared/data/skeleton out
//! ```

use std::path::Path;

use opendr_actions::skeleton_based_action_recognition::{
    CoStGcn, CoStGcnParams, GraphType, SpatioTemporalGcn, SpatioTemporalGcnFitParams,
    SpatioTemporalGcnParams, co_st_gcn_from,
};
use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::dataset::ExternalDataset;
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result, Value};
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [skeletons, output] = &arguments[..] else {
        return Err(Error::invalid_param("usage: train_actions SKELETON_FOLDER OUTPUT_FOLDER"));
    };
    let part = |name: &str| {
        let dataset = ExternalDataset::new(skeletons, "jhmdb");
        let options = OpenOptions { split: Some(name.to_owned()), target: None };
        open(&dataset, &options, &Problems::strict())
    };
    let (training, test) = (part("jhmdb_GT_train_1")?, part("jhmdb_GT_test_1")?);
    let params = SpatioTemporalGcnParams {
        graph_type: GraphType::Jhmdb,
        num_person: 1,
        in_channels: 2,
        num_frames: 32,
        channels: vec![16, 24, 32],
        temporal_kernel: 7,
        ..Default::default()
    };
    let defaults = SpatioTemporalGcnFitParams::default();
    let fit_params = SpatioTemporalGcnFitParams {
        dropout: 0.2,
        label_smoothing: 0.1,
        training: TrainingParams {
            epochs: 40,
            batch_size: 32,
            lr: 0.006,
            lr_schedule: ScheduleKind::Cosine,
            optimizer: OptimizerKind::Adamw,
            weight_decay: 0.02,
            num_workers: 1,
            ..defaults.training
        },
        ..defaults
    };
    let mut clip_wise = Handle::<SpatioTemporalGcn>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, ..FitJob::new(Path::new(output)) };
    let statistics = clip_wise.fit(&fit_params, (&*training).into(), None, &job)?;
    println!("{statistics}");
    let steps = Path::new(output).join("co_st_gcn");
    co_st_gcn_from(&Model::open(job.model())?)?.write(&steps)?;
    let mut continual = Handle::<CoStGcn>::new(CoStGcnParams::default(), Device::Cpu)?;
    continual.load(&steps)?;
    let mut correct = [0; 2];
    for index in 0..test.len() {
        let sample = test.get(index)?;
        let (Some(Value::SkeletonSequence(sequence)), Some(Value::Category(action))) =
            (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("the sample has no skeleton sequence with an action"));
        };
        continual.reset();
        let predictions = [clip_wise.infer(sequence)?, continual.infer(sequence)?];
        correct.iter_mut().zip(&predictions).for_each(|(correct, prediction)| {
            *correct += usize::from(prediction.class == action.class);
        });
    }
    let shares = correct.map(|correct| correct as f64 / test.len() as f64);
    println!("correct of {}, clip-wise and frame by frame: {correct:?}, accuracy {shares:.4?}", test.len());
    Ok(())
}
