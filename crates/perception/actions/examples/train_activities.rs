//! Trains X3D to classify actions in clips of stick figures and measures its accuracy on other clips.
//!
//! The clips are no videos: the annotated joints of JHMDB (Jhuang et al., 2013) are drawn on black, each bone in its own
//! colour; 433 recordings for training, each in several versions (mirrored, rotated, stretched, cut), 176 others for testing.
//! The network learns to classify such drawings, not videos. The example produces the zoo's `x3d/stick_figures` and
//! `co_x3d/stick_figures`:
//!
//! ```console
//! $ cargo run --release -p opendr-actions --features training --example train_activities -- shared/data/skeleton out
//! ```

use std::path::Path;

use opendr_actions::activity_recognition::{X3d, X3dFitParams, X3dParams, co_x3d_from};
use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::data::{SkeletonSequence, Video};
use opendr_engine::dataset::{Dataset, DatasetIterator, ExternalDataset, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::model::Model;
use opendr_engine::target::{Classes, Skeleton};
use opendr_engine::{Device, Error, Random, Result, Value};
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [skeletons, output] = &arguments[..] else {
        return Err(Error::invalid_param("usage: train_activities SKELETON_FOLDER OUTPUT_FOLDER"));
    };
    let part = |name: &str, versions: usize| -> Result<StickFigures> {
        let dataset = ExternalDataset::new(skeletons, "jhmdb");
        let options = OpenOptions { split: Some(name.to_owned()), target: None };
        Ok(StickFigures { skeletons: open(&dataset, &options, &Problems::strict())?, versions })
    };
    let (training, test) = (part("jhmdb_GT_train_1", VERSIONS)?, part("jhmdb_GT_test_1", 1)?);
    let params = X3dParams {
        num_frames: Some(8),
        side: Some(48),
        width: 0.67,
        depth: Some(0.5),
        ..Default::default()
    };
    let defaults = X3dFitParams::default();
    let fit_params = X3dFitParams {
        dropout: 0.3,
        training: TrainingParams {
            epochs: 8,
            batch_size: 16,
            lr: 0.003,
            lr_schedule: ScheduleKind::Cosine,
            optimizer: OptimizerKind::Adamw,
            weight_decay: 0.02,
            num_workers: 1,
            ..defaults.training
        },
        ..defaults
    };
    let mut handle = Handle::<X3d>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, resume: true, ..FitJob::new(Path::new(output)) };
    let statistics = handle.fit(&fit_params, (&training as &dyn DatasetIterator).into(), None, &job)?;
    println!("{statistics}");
    co_x3d_from(&Model::open(job.model())?)?.write(&Path::new(output).join("co_x3d"))?;
    let mut right = 0;
    for index in 0..test.len() {
        let sample = test.get(index)?;
        let (Some(Value::Video(clip)), Some(Value::Category(action))) = (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("the sample has no video with an action"));
        };
        right += usize::from(handle.infer(clip)?.class == action.class);
    }
    println!("correct of {}: {right}, accuracy {:.4}", test.len(), right as f64 / test.len() as f64);
    Ok(())
}

/// Skeletons drawn as clips of stick figures, each in several versions.
struct StickFigures {
    skeletons: Box<dyn DatasetIterator>,
    versions: usize,
}

/// Number of versions of a training recording.
const VERSIONS: usize = 6;

impl Dataset for StickFigures {}

impl DatasetIterator for StickFigures {
    fn len(&self) -> usize {
        self.versions * self.skeletons.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let sample = self.skeletons.get(index % self.skeletons.len())?;
        let Some(Value::SkeletonSequence(sequence)) = sample.data.first() else {
            return Err(Error::invalid_input("the sample has no skeleton sequence"));
        };
        let version = match index < self.skeletons.len() {
            true => Version::ORIGINAL,
            false => Version::new(&mut Random::new(index as u64)),
        };
        Ok(Sample { data: vec![Value::Video(stick_figure(sequence, &version)?)], target: sample.target })
    }

    fn classes(&self) -> Classes {
        self.skeletons.classes()
    }
}

/// Side of a drawing in pixels.
const SIDE: usize = 48;
/// Number of points drawn along a bone.
const POINTS: usize = 40;

/// Random changes of a recording before it is drawn.
struct Version {
    is_mirrored: bool,
    /// Rotation in radians.
    turn: f32,
    /// Factor on the width.
    stretch: f32,
    /// Shares of the frames removed at the beginning and at the end.
    cut: [f32; 2],
}

impl Version {
    const ORIGINAL: Self = Self { is_mirrored: false, turn: 0.0, stretch: 1.0, cut: [0.0; 2] };

    fn new(random: &mut Random) -> Self {
        Self {
            is_mirrored: random.chance(0.5),
            turn: random.uniform(-0.25, 0.25),
            stretch: random.uniform(0.8, 1.25),
            cut: [random.uniform(0.0, 0.2), random.uniform(0.0, 0.2)],
        }
    }
}

/// Draws the person of a sequence, scaled so that all its frames fill the square.
fn stick_figure(sequence: &SkeletonSequence, version: &Version) -> Result<Video> {
    let [_, _, all_frames, joints, persons] = sequence.shape();
    let [first, left_out] = version.cut.map(|share| (share * all_frames as f32) as usize);
    let frames = all_frames - first - left_out;
    let (sin, cos) = version.turn.sin_cos();
    let at = |channel: usize, frame: usize, joint: usize| {
        let joint = match version.is_mirrored {
            true => Skeleton::Jhmdb15.partner(joint).unwrap_or(joint),
            false => joint,
        };
        let [x, y] = [0, 1].map(|channel| {
            sequence.as_slice()[((channel * all_frames + first + frame) * joints + joint) * persons]
        });
        let x = if version.is_mirrored { -x } else { x } * version.stretch;
        if channel == 0 { cos * x - sin * y } else { sin * x + cos * y }
    };
    let (mut low, mut high) = ([f32::MAX; 2], [f32::MIN; 2]);
    for channel in 0..2 {
        for number in (0..frames * joints).map(|place| at(channel, place / joints, place % joints)) {
            low[channel] = low[channel].min(number);
            high[channel] = high[channel].max(number);
        }
    }
    let scale = (SIDE - 5) as f32 / (high[0] - low[0]).max(high[1] - low[1]).max(1.0);
    let mut levels = vec![0.0; 3 * frames * SIDE * SIDE];
    for frame in 0..frames {
        for (number, [from, to]) in Skeleton::Jhmdb15.bones().iter().enumerate() {
            let hue = number as f32 / Skeleton::Jhmdb15.bones().len() as f32 * std::f32::consts::TAU;
            for point in 0..=POINTS {
                let part = point as f32 / POINTS as f32;
                let [x, y] = [0, 1].map(|channel| {
                    let place = at(channel, frame, *from) * (1.0 - part) + at(channel, frame, *to) * part;
                    ((place - low[channel]) * scale) as usize + 2
                });
                for (colour, level) in
                    [0.0, 2.1, 4.2].map(|shift| 0.6 + 0.4 * (hue + shift).cos()).into_iter().enumerate()
                {
                    for [right, down] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                        let (x, y) = ((x + right).min(SIDE - 1), (y + down).min(SIDE - 1));
                        levels[((colour * frames + frame) * SIDE + y) * SIDE + x] = level;
                    }
                }
            }
        }
    }
    Video::new(levels, [3, frames, SIDE, SIDE])
}
