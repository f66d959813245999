//! ST-GCN: convolutions over the graph of joints and bones, and through time, over a clip.
//!
//! Yan, Xiong and Lin, Spatial Temporal Graph Convolutional Networks for Skeleton-Based Action Recognition, AAAI 2018; partitions by
//! distance from the middle of the body, learnt importance of the connections. Take it for recordings that are there
//! as a whole; [`CoStGcn`](super::CoStGcn) answers every frame of a stream with the same weights, at a fraction of the
//! arithmetic.

#[cfg(feature = "training")]
mod fit;

#[cfg(feature = "training")]
pub use fit::SpatioTemporalGcnFitParams;

use opendr_engine::data::SkeletonSequence;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;
use opendr_perception_common::frame_features::{ClipWork, FrameFeatures, KINDS};

use super::GraphType;

opendr_engine::choices! {
    /// Which network looks at the skeletons.
    pub enum Method {
        /// Spatial-temporal graph convolutions (Yan et al., 2018).
        StGcn = "stgcn",
    }
}

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct SpatioTemporalGcnParams {
    /// Classes. None: as many as the data name.
    #[param(range = 2..=10_000)]
    pub num_class: Option<usize>,
    /// Joints. None: as many as the graph has.
    #[param(range = 2..=1000)]
    pub num_point: Option<usize>,
    /// Persons of a recording that are looked at, the first ones; the answer is the mean over those that are there.
    #[param(default = 2, range = 1..=64)]
    pub num_person: usize,
    /// Coordinates of a joint: 2 (a third channel, where there is one, holds scores) or 3.
    #[param(default = 3, range = 2..=3)]
    pub in_channels: usize,
    /// Joints and bones.
    pub graph_type: GraphType,
    /// The network.
    pub method_name: Method,
    /// Frames of a clip: the last of a longer recording; in a shorter one, the person stands still before it.
    #[param(default = 300, range = 1..=10_000)]
    pub num_frames: usize,
    /// Channels of each block.
    #[param(default = vec![64, 64, 64, 64, 128, 128, 128, 256, 256, 256], range = 1..=4096)]
    pub channels: Vec<usize>,
    /// Frames that a block sees; odd.
    #[param(default = 9, range = 3..=101)]
    pub temporal_kernel: usize,
}

/// A loaded ST-GCN.
pub struct SpatioTemporalGcn {
    params: SpatioTemporalGcnParams,
    classes: Classes,
    features: FrameFeatures,
    session: Session,
    work: Pool<Work>,
}

#[derive(Default)]
struct Work {
    clip: ClipWork,
    sum: Vec<f32>,
}

/// The network in every container: `clip` `[1, features, frames, joints]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl Learner for SpatioTemporalGcn {
    const SPEC: Spec = Spec::new("spatio_temporal_gcn", Task::SkeletonBasedActionRecognition)
        .class("SpatioTemporalGCNLearner")
        .about("ST-GCN tells what a person does from a clip of its moving skeleton; it trains.")
        .without_effect(&[
            ("experiment_name", "the folder of a training says it"),
            ("device_ind", "`device` says it"),
            ("val_batch_size", "validation asks the learner, clip by clip"),
            ("start_epoch", "`resume` of `fit` goes on where a training was"),
            ("dataset_name", "the data set says it"),
            ("stbln_symmetric", "there is no bilinear network"),
            ("num_subframes", "only networks with temporal attention choose frames"),
        ]);
    type Params = SpatioTemporalGcnParams;
    type Input<'a> = &'a SkeletonSequence;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: SpatioTemporalGcnParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} has not one input and one output")));
        };
        let rows = KINDS * params.in_channels;
        let joints = joints_of(params.graph_type, params.num_point)?;
        let fits = input.dims == [Some(1), Some(rows), Some(params.num_frames), Some(joints)];
        let &[_, Some(classes)] = &output.dims[..] else {
            return Err(Error::format(format!("{FILE} gives {output}, which are no scores")));
        };
        if !fits {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {input}; in_channels, num_frames and graph_type make [1, {rows}, {}, {joints}]: leave them out",
                params.num_frames
            )));
        }
        check_classes("num_class", params.num_class, classes)?;
        Ok(Self {
            features: FrameFeatures::new(params.graph_type.parents(), params.in_channels),
            classes: model.manifest().classes.clone(),
            work: Pool::default(),
            params,
            session,
        })
    }

    fn params(&self) -> &SpatioTemporalGcnParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut SpatioTemporalGcnParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), sequence: &SkeletonSequence, category: &mut Category) -> Result<()> {
        self.features.check(sequence)?;
        let Work { clip, sum } = &mut *self.work.take();
        sum.clear();
        let (frames, joints) = (self.params.num_frames, sequence.shape()[3]);
        let mut there = 0;
        for person in 0..sequence.shape()[4].min(self.params.num_person) {
            if !self.features.clip_into(sequence, person, frames, clip) {
                continue;
            }
            there += 1;
            let input =
                TensorView::new(&[1, KINDS * self.params.in_channels, frames, joints], &clip.clip[..])?;
            self.session.run(&[input], |outputs| {
                add_to(sum, outputs.first().map_or(Ok(&[][..]), TensorView::values)?);
                Ok(())
            })?;
        }
        mean_category(category, sum, there, &self.classes)
    }
}

/// Adds the logits of one more person.
pub(super) fn add_to(sum: &mut Vec<f32>, logits: &[f32]) {
    sum.resize(logits.len(), 0.0);
    sum.iter_mut().zip(logits).for_each(|(sum, logit)| *sum += logit);
}

/// The category of the mean logits of `persons`.
///
/// # Errors
/// `InvalidInput` when nobody is there.
pub(super) fn mean_category(
    category: &mut Category,
    sum: &mut [f32],
    persons: usize,
    classes: &Classes,
) -> Result<()> {
    if persons == 0 {
        return Err(Error::invalid_input(
            "nobody is in the recording: all joints are missing; leave such frames out",
        ));
    }
    sum.iter_mut().for_each(|logit| *logit /= persons as f32);
    category_from_logits(category, sum, classes)
}

/// The joints of a graph.
///
/// # Errors
/// `InvalidParam` when the user gave another number.
pub(super) fn joints_of(graph: GraphType, given: Option<usize>) -> Result<usize> {
    match given {
        Some(given) if given != graph.joints() => Err(Error::invalid_param(format!(
            "num_point = {given}, but graph_type {} has {}; leave num_point out, or choose another graph_type",
            graph.name(),
            graph.joints()
        ))),
        _ => Ok(graph.joints()),
    }
}

/// Refuses another number of classes than the model has.
pub(super) fn check_classes(name: &str, wanted: Option<usize>, there: usize) -> Result<()> {
    match wanted {
        Some(wanted) if wanted != there => Err(Error::invalid_param(format!(
            "{name} = {wanted}, but the model's is {there}; leave it out, or load a model that fits"
        ))),
        _ => Ok(()),
    }
}
