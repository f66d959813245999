//! Expressions by the landmarks of a face through time.
//!
//! Heidari and Iosifidis, Progressive Spatio-Temporal Bilinear Network with Monte Carlo Dropout for Landmark-based Facial
//! Expression Recognition with Uncertainty Estimation, 2021: each layer mixes all landmarks by a matrix of its own, learnt and
//! not drawn from a graph, and the channels by another, then looks through time. In place of the paper's growing of layers,
//! block by block, `topology` says how large they are; `opendr tune` searches it as any other parameter.

#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

#[cfg(feature = "training")]
pub use fit::ProgressiveSpatioTemporalBlnFitParams;
use opendr_engine::data::SkeletonSequence;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;
use opendr_perception_common::frame_features::{ClipWork, FrameFeatures};

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct ProgressiveSpatioTemporalBlnParams {
    /// Classes. None: as many as the data name.
    #[param(range = 2..=10_000)]
    pub num_class: Option<usize>,
    /// Landmarks of a face. None: as many as the data have.
    #[param(range = 2..=1000)]
    pub num_point: Option<usize>,
    /// Coordinates of a landmark: 2 (a third channel, where there is one, holds scores) or 3.
    #[param(default = 2, range = 2..=3)]
    pub in_channels: usize,
    /// Frames of a clip: the last of a longer recording; in a shorter one, the face stands still before it.
    #[param(default = 20, range = 1..=10_000)]
    pub num_frames: usize,
    /// Channels of a block.
    #[param(default = 5, range = 1..=256)]
    pub blocksize: usize,
    /// Blocks of each layer.
    #[param(default = vec![2, 2, 4, 4], range = 1..=1000)]
    pub topology: Vec<usize>,
}

/// A loaded network.
pub struct ProgressiveSpatioTemporalBln {
    params: ProgressiveSpatioTemporalBlnParams,
    classes: Classes,
    features: FrameFeatures,
    /// Of the network's input.
    shape: [usize; 4],
    session: Session,
    work: Pool<ClipWork>,
}

/// The network in every container: `clip` `[1, features, frames, landmarks]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";
/// Features of a coordinate: place and motion.
const KINDS: usize = 2;

impl Learner for ProgressiveSpatioTemporalBln {
    const SPEC: Spec = Spec::new("progressive_spatio_temporal_bln", Task::FacialExpressionRecognition)
        .class("ProgressiveSpatioTemporalBLNLearner")
        .about("PST-BLN tells an expression by the landmarks of a face through time; it trains.")
        .without_effect(&[
            ("experiment_name", "the folder of a training says it"),
            ("device_indices", "`device` says it"),
            ("val_batch_size", "validation asks the learner, clip by clip"),
            ("start_epoch", "`resume` of `fit` goes on where a training was"),
            ("dataset_name", "the data set says it"),
            ("num_person", "a recording is of one face, the first that is there"),
            ("num_blocks", "`topology` says it"),
            ("num_layers", "`topology` says it"),
            ("layer_threshold", "layers do not grow: `topology` says their sizes"),
            ("block_threshold", "layers do not grow: `topology` says their sizes"),
        ]);
    type Params = ProgressiveSpatioTemporalBlnParams;
    type Input<'a> = &'a SkeletonSequence;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: ProgressiveSpatioTemporalBlnParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} has not one input and one output")));
        };
        let ([_, Some(rows), Some(frames), Some(points)], [_, Some(classes)]) =
            (&input.dims[..], &output.dims[..])
        else {
            return Err(Error::format(format!(
                "{FILE} turns {input} into {output}, which are no landmarks and scores"
            )));
        };
        let shape = [1, *rows, *frames, *points];
        let fits = [1, KINDS * params.in_channels, params.num_frames, params.num_point.unwrap_or(*points)];
        if shape != fits || params.num_class.is_some_and(|wanted| wanted != *classes) {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {input} and tells {classes} classes, in_channels, num_frames, num_point and num_class make \
                 {fits:?} and others: leave them out"
            )));
        }
        let features = FrameFeatures::without_bones(*points, params.in_channels);
        Ok(Self { params, classes: model.classes().clone(), features, shape, session, work: Pool::default() })
    }

    fn params(&self) -> &ProgressiveSpatioTemporalBlnParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ProgressiveSpatioTemporalBlnParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), sequence: &SkeletonSequence, category: &mut Category) -> Result<()> {
        self.features.check(sequence)?;
        let work = &mut *self.work.take();
        first_face_into(&self.features, sequence, self.shape[2], work)?;
        self.session.run(&[TensorView::new(&self.shape, &work.clip[..])?], |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}

/// Replaces `work.clip` by the features of the first face that is in a recording.
///
/// # Errors
/// `InvalidInput` when none is.
fn first_face_into(
    features: &FrameFeatures,
    sequence: &SkeletonSequence,
    frames: usize,
    work: &mut ClipWork,
) -> Result<()> {
    match (0..sequence.shape()[4]).any(|face| features.clip_into(sequence, face, frames, work)) {
        true => Ok(()),
        false => {
            Err(Error::invalid_input("no face is in the recording: all landmarks are missing; leave it out"))
        }
    }
}
