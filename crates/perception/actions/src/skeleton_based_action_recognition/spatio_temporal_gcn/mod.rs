//! ST-GCN: graph convolutions over joints and bones, and convolutions through time, on clips.
//!
//! Yan, Xiong and Lin, Spatial Temporal Graph Convolutional Networks for Skeleton-Based Action Recognition, AAAI 2018;
//! partitions by distance from the centre of the body, learnt edge weights. For complete recordings;
//! [`CoStGcn`](super::CoStGcn) classifies every frame of a stream with the same weights, at a fraction of the arithmetic.

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
use opendr_perception_common::frame_features::{ClipScratch, FEATURES_PER_COORDINATE, FrameFeatures};

use super::GraphType;

opendr_engine::choices! {
    /// Network architecture.
    pub enum Method {
        /// Spatial-temporal graph convolutions (Yan et al., 2018).
        StGcn = "stgcn",
    }
}

/// Parameters of [`SpatioTemporalGcn`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct SpatioTemporalGcnParams {
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub num_class: Option<usize>,
    /// Number of joints. None: that of the graph.
    #[param(range = 2..=1000)]
    pub num_point: Option<usize>,
    /// Maximum number of persons, the first ones of a recording; the prediction is the mean over those present.
    #[param(default = 2, range = 1..=64)]
    pub num_person: usize,
    /// Number of coordinates of a joint: 2 (a third channel of the input holds scores) or 3.
    #[param(default = 3, range = 2..=3)]
    pub in_channels: usize,
    /// Skeleton: joints and bones.
    pub graph_type: GraphType,
    /// Network architecture.
    pub method_name: Method,
    /// Number of frames of a clip: the last ones of a longer recording; a shorter one is preceded by its repeated first frame.
    #[param(default = 300, range = 1..=10_000)]
    pub num_frames: usize,
    /// Output channels of each block.
    #[param(default = vec![64, 64, 64, 64, 128, 128, 128, 256, 256, 256], range = 1..=4096)]
    pub channels: Vec<usize>,
    /// Kernel size in time of each block; odd.
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
    clip: ClipScratch,
    sum: Vec<f32>,
}

/// File of the network in every container: `clip` `[1, features, frames, joints]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl Learner for SpatioTemporalGcn {
    const SPEC: Spec = Spec::new("spatio_temporal_gcn", Task::SkeletonBasedActionRecognition)
        .class("SpatioTemporalGCNLearner")
        .about("ST-GCN classifies the action in a clip of a moving skeleton; trainable.")
        .without_effect(&[
            ("experiment_name", "the output folder names the run"),
            ("device_ind", "use `device`"),
            ("val_batch_size", "validation runs the learner on one clip at a time"),
            ("start_epoch", "use `resume` of `fit`"),
            ("dataset_name", "the data set has a name"),
            ("stbln_symmetric", "the bilinear network is not included"),
            ("num_subframes", "only networks with temporal attention select frames"),
        ]);
    type Params = SpatioTemporalGcnParams;
    type Input<'a> = &'a SkeletonSequence;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: SpatioTemporalGcnParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have exactly one input and one output")));
        };
        let rows = FEATURES_PER_COORDINATE * params.in_channels;
        let joints = joints_of(params.graph_type, params.num_point)?;
        let fits = input.dims == [Some(1), Some(rows), Some(params.num_frames), Some(joints)];
        let &[_, Some(classes)] = &output.dims[..] else {
            return Err(Error::format(format!("{FILE} returns {output}; expected scores [1, classes]")));
        };
        if !fits {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {input}, but in_channels, num_frames and graph_type specify [1, {rows}, {}, {joints}]; omit these parameters",
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
        let mut present = 0;
        for person in 0..sequence.shape()[4].min(self.params.num_person) {
            if !self.features.clip_into(sequence, person, frames, clip) {
                continue;
            }
            present += 1;
            let input = TensorView::new(
                &[1, FEATURES_PER_COORDINATE * self.params.in_channels, frames, joints],
                &clip.clip[..],
            )?;
            self.session.run(&[input], |outputs| {
                add_to(sum, outputs.first().map_or(Ok(&[][..]), TensorView::values)?);
                Ok(())
            })?;
        }
        mean_category(category, sum, present, &self.classes)
    }
}

/// Adds the logits of one person to `sum`.
pub(super) fn add_to(sum: &mut Vec<f32>, logits: &[f32]) {
    sum.resize(logits.len(), 0.0);
    sum.iter_mut().zip(logits).for_each(|(sum, logit)| *sum += logit);
}

/// Writes the category of the mean logits of `persons` into `category`; `sum` is their sum.
///
/// # Errors
/// `InvalidInput` when `persons` is zero.
pub(super) fn mean_category(
    category: &mut Category,
    sum: &mut [f32],
    persons: usize,
    classes: &Classes,
) -> Result<()> {
    if persons == 0 {
        return Err(Error::invalid_input(
            "the recording has no person: all joints are missing; skip such recordings",
        ));
    }
    sum.iter_mut().for_each(|logit| *logit /= persons as f32);
    category_from_logits(category, sum, classes)
}

/// Returns the number of joints of a graph.
///
/// # Errors
/// `InvalidParam` when the given number differs.
pub(super) fn joints_of(graph: GraphType, given: Option<usize>) -> Result<usize> {
    match given {
        Some(given) if given != graph.joints() => Err(Error::invalid_param(format!(
            "num_point = {given}, but graph_type {} has {}; omit num_point or choose another graph_type",
            graph.name(),
            graph.joints()
        ))),
        _ => Ok(graph.joints()),
    }
}

/// Checks the number of classes that the user gave, where there is one, against the model.
pub(super) fn check_classes(name: &str, wanted: Option<usize>, present: usize) -> Result<()> {
    match wanted {
        Some(wanted) if wanted != present => Err(Error::invalid_param(format!(
            "{name} = {wanted}, but the model has {present} classes; omit {name} or load another model"
        ))),
        _ => Ok(()),
    }
}
