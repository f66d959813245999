use std::cell::RefCell;
use std::path::Path;

use opendr_engine::model::{Manifest, ModelWriter};
use opendr_engine::params::ParamValue;
use opendr_engine::{ErrorKind, Unit};
use opendr_perception_testing::stop_at::StopAt;

use super::*;

struct Folder(PathBuf);

impl Folder {
    fn new(name: &str) -> Self {
        let path = std::env::temp_dir().join(format!("opendr-growth-{name}-{}", std::process::id()));
        std::fs::remove_dir_all(&path).ok();
        Self(path)
    }
}

impl Drop for Folder {
    fn drop(&mut self) {
        std::fs::remove_dir_all(&self.0).ok();
    }
}

/// Number of steps of each stage.
const STEPS: u64 = 10;

/// A training without a network: its loss is a function of the topology. The topology is in the manifest.
fn trained(stage: &Stage<'_>, loss: f64) -> Result<Statistics> {
    let mut manifest = Manifest::new("of_the_test", "");
    let blocks = stage.topology.iter().map(|blocks| ParamValue::Int(*blocks as i64)).collect();
    manifest.params.insert("topology".to_owned(), ParamValue::List(blocks));
    let mut writer = ModelWriter::new(stage.job.model(), manifest)?;
    writer.add("model.onnx", b"weights")?;
    writer.finish()?;
    let limit = if stage.training.max_steps == 0 { STEPS } else { stage.training.max_steps };
    let steps = STEPS.min(limit);
    stage.job.progress.begin("training", Some(steps), Unit::Steps);
    stage.job.progress.advance(steps);
    let mut statistics = Statistics::default();
    statistics.set("steps", steps as f64);
    statistics.push("loss", 2.0 * loss);
    statistics.push("loss", loss);
    Ok(statistics)
}

fn params(num_layers: usize, num_blocks: usize) -> TopologyParams {
    TopologyParams { num_layers, num_blocks, ..Default::default() }
}

/// Grows a network whose loss is `loss` of its topology; returns the topologies of the stages and the statistics.
fn grown(
    params: &TopologyParams,
    training: &TrainingParams,
    job: &FitJob<'_>,
    loss: fn(&[usize]) -> f64,
) -> (Vec<String>, Statistics) {
    let stages = RefCell::new(Vec::new());
    let mut train = |stage: &Stage<'_>| {
        stages.borrow_mut().push(name_of(stage.topology));
        trained(stage, loss(stage.topology))
    };
    let statistics = train_topology(params, training, None, job, &mut train).unwrap();
    (stages.into_inner(), statistics)
}

fn topology(model: &Path) -> String {
    Model::open(model).unwrap().params()["topology"].to_string()
}

/// Two layers of two blocks are best; each further block or layer changes nothing.
fn best_at_two(topology: &[usize]) -> f64 {
    let useful: usize = topology.iter().take(2).map(|blocks| *blocks.min(&2)).sum();
    1.0 / useful as f64
}

#[test]
fn blocks_and_layers_are_added_while_the_loss_decreases() {
    let folder = Folder::new("decreases");
    let job = FitJob::new(&folder.0);
    let (stages, statistics) = grown(&params(10, 10), &TrainingParams::default(), &job, best_at_two);
    assert_eq!(stages, ["1", "2", "3", "2-1", "2-2", "2-3", "2-2-1", "2-2-2"]);
    assert_eq!(topology(&job.model()), "2,2");
    assert_eq!(statistics.get("steps"), Some(80.0));
    assert_eq!(statistics.curves["growth_loss"].len(), 8);
    assert_eq!(statistics.curves["loss"], [0.5, 0.25], "the curve of the network that was kept");
    assert_eq!(Model::open(job.model()).unwrap().file("model.onnx").unwrap(), b"weights");
}

#[test]
fn the_limits_end_the_growth() {
    let folder = Folder::new("limits");
    let job = FitJob::new(&folder.0);
    let ever = |topology: &[usize]| 1.0 / topology.iter().sum::<usize>() as f64;
    let (stages, _) = grown(&params(2, 3), &TrainingParams::default(), &job, ever);
    assert_eq!(stages, ["1", "2", "3", "3-1", "3-2", "3-3"]);
    assert_eq!(topology(&job.model()), "3,3");
}

#[test]
fn the_thresholds_are_relative() {
    let folder = Folder::new("thresholds");
    let job = FitJob::new(&folder.0);
    // A block decreases the loss by 10 %, a layer by 20 %.
    let share = |topology: &[usize]| {
        let blocks: usize = topology.iter().map(|blocks| blocks - 1).sum();
        0.001 * 0.9_f64.powi(blocks as i32) * 0.8_f64.powi(topology.len() as i32)
    };
    let limited = TopologyParams { block_threshold: 0.11, layer_threshold: 0.21, ..params(3, 3) };
    let (stages, _) = grown(&limited, &TrainingParams::default(), &job, share);
    assert_eq!(stages, ["1", "2", "1-1", "1-2"]);
    assert_eq!(topology(&job.model()), "1");
    std::fs::remove_dir_all(&folder.0).unwrap();
    let free = TopologyParams { block_threshold: 0.09, layer_threshold: 0.19, ..params(2, 2) };
    grown(&free, &TrainingParams::default(), &job, share);
    assert_eq!(topology(&job.model()), "2,2");
}

#[test]
fn max_steps_limits_all_stages_together() {
    let folder = Folder::new("steps");
    let job = FitJob::new(&folder.0);
    let training = TrainingParams { max_steps: 25, ..Default::default() };
    let (stages, statistics) = grown(&params(10, 10), &training, &job, best_at_two);
    assert_eq!(stages, ["1", "2", "3"]);
    assert_eq!(statistics.get("steps"), Some(25.0));
    assert_eq!(topology(&job.model()), "2", "the third block is not better");
}

#[test]
fn a_stop_counts_the_steps_of_all_stages() {
    let folder = Folder::new("stop");
    let progress = StopAt::new(35);
    let job = FitJob { progress: &progress, ..FitJob::new(&folder.0) };
    let (stages, _) = grown(&params(10, 10), &TrainingParams::default(), &job, best_at_two);
    assert_eq!(stages, ["1", "2", "3", "2-1"]);
    assert_eq!(topology(&job.model()), "2,1", "the stage was completed, and is better");
}

#[test]
fn a_given_topology_is_trained_at_once() {
    let folder = Folder::new("given");
    let job = FitJob::new(&folder.0);
    let given = TopologyParams { topology: vec![3, 1], ..Default::default() };
    let (stages, statistics) = grown(&given, &TrainingParams::default(), &job, best_at_two);
    assert_eq!(stages, ["3-1"]);
    assert_eq!((topology(&job.model()), statistics.get("steps")), ("3,1".to_owned(), Some(10.0)));
    assert!(!folder.0.join(FOLDER).exists());
    let base = Model::open(job.model()).unwrap();
    let refused = train_topology(
        &TopologyParams::default(),
        &TrainingParams::default(),
        Some(&base),
        &job,
        &mut |_| unreachable!(),
    );
    assert_eq!(refused.unwrap_err().kind(), ErrorKind::InvalidParam);
}
