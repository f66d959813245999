//! Facial expressions from sequences of landmarks.
//!
//! Heidari and Iosifidis, Progressive Spatio-Temporal Bilinear Network with Monte Carlo Dropout for Landmark-based Facial
//! Expression Recognition with Uncertainty Estimation, 2021: each layer mixes all landmarks by a learned matrix instead of
//! a given graph, and the channels by another one, then convolves over time. Without a given `topology`, `fit` starts with one layer
//! of one block and adds blocks and layers while the training loss decreases ([`progressive`](opendr_perception_common::progressive)).

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
use opendr_perception_common::frame_features::{ClipScratch, FrameFeatures};
use opendr_perception_common::progressive::TopologyParams;

/// Parameters of [`ProgressiveSpatioTemporalBln`]. Sizes are those of a network to train; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct ProgressiveSpatioTemporalBlnParams {
    /// Number of classes; by default that of the data set.
    #[param(range = 2..=10_000)]
    pub num_class: Option<usize>,
    /// Number of landmarks of a face; by default that of the data set.
    #[param(range = 2..=1000)]
    pub num_point: Option<usize>,
    /// Coordinates of a landmark: 2 (an optional third channel has scores) or 3.
    #[param(default = 2, range = 2..=3)]
    pub in_channels: usize,
    /// Frames of a clip: the last ones of a longer recording; a shorter one is extended by its first frame.
    #[param(default = 20, range = 1..=10_000)]
    pub num_frames: usize,
    /// Topology of the network, and limits of its growth.
    #[param(flatten, blocksize = 5, num_blocks = 100)]
    pub growth: TopologyParams,
}

/// A loaded network.
pub struct ProgressiveSpatioTemporalBln {
    params: ProgressiveSpatioTemporalBlnParams,
    classes: Classes,
    features: FrameFeatures,
    /// Shape of the network's input.
    shape: [usize; 4],
    session: Session,
    work: Pool<ClipScratch>,
}

/// File name of the network in a container. Input: `clip` `[1, features, frames, landmarks]`. Output: `logits`
/// `[1, classes]`.
const FILE: &str = "model.onnx";
/// Features per coordinate: position and motion.
const KINDS: usize = 2;

impl Learner for ProgressiveSpatioTemporalBln {
    const SPEC: Spec = Spec::new("progressive_spatio_temporal_bln", Task::FacialExpressionRecognition)
        .class("ProgressiveSpatioTemporalBLNLearner")
        .about("PST-BLN classifies facial expressions from sequences of landmarks; its network grows in the training.")
        .without_effect(&[
            ("experiment_name", "the output folder of a training names it"),
            ("device_indices", "`device` sets it"),
            ("val_batch_size", "the validation infers clip by clip"),
            ("start_epoch", "`resume` of `fit` continues a training"),
            ("dataset_name", "the data set defines it"),
            ("num_person", "a recording has one face, the first that occurs"),
        ]);
    type Params = ProgressiveSpatioTemporalBlnParams;
    type Input<'a> = &'a SkeletonSequence;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: ProgressiveSpatioTemporalBlnParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!(
                "{FILE} does not have one input and one output; train or download it again"
            )));
        };
        let ([_, Some(rows), Some(frames), Some(points)], [_, Some(classes)]) =
            (&input.dims[..], &output.dims[..])
        else {
            return Err(Error::format(format!(
                "{FILE} has the input {input} and the output {output} instead of landmarks and scores; train or download it again"
            )));
        };
        let shape = [1, *rows, *frames, *points];
        let fits = [1, KINDS * params.in_channels, params.num_frames, params.num_point.unwrap_or(*points)];
        if shape != fits || params.num_class.is_some_and(|wanted| wanted != *classes) {
            return Err(Error::invalid_param(format!(
                "{FILE} has the input {input} and {classes} classes, but in_channels, num_frames, num_point and num_class \
                 give {fits:?} and other classes; omit them"
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

/// Replaces `work.clip` by the features of the first face that occurs in a recording.
///
/// # Errors
/// `InvalidInput` when there is none.
fn first_face_into(
    features: &FrameFeatures,
    sequence: &SkeletonSequence,
    frames: usize,
    work: &mut ClipScratch,
) -> Result<()> {
    match (0..sequence.shape()[4]).any(|face| features.clip_into(sequence, face, frames, work)) {
        true => Ok(()),
        false => Err(Error::invalid_input("the recording has no face: all landmarks are missing; remove it")),
    }
}
