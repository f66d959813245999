//! CoST-GCN: spatio-temporal graph convolutions as those of [`SpatioTemporalGcn`](super::SpatioTemporalGcn), one frame at a time.
//!
//! Hedegaard, Heidari and Iosifidis, Continual Spatio-Temporal Graph Convolutional Networks, 2022. Every convolution through
//! time keeps the frames that it still needs, so each frame is computed once and not once for every clip that contains it: with
//! clips of 40 frames, a twentieth of the arithmetic per prediction. The parameter `backbone` chooses the architecture; in all of
//! them, joints exchange features within a frame only.
//!
//! # Delay and padding
//!
//! Neither this learner nor [`SpatioTemporalGcn`](super::SpatioTemporalGcn) pads in time or strides, so the prediction after a
//! frame equals that of the clip ending with the frame, except for rounding. A prediction covers `sequence_len` frames; the
//! residual connection of each block is delayed by half of `temporal_kernel`. There is no warm-up: the first frame of a person
//! is repeated for the time before it, so the first frame already yields a prediction (and takes `sequence_len` steps).

#[cfg(feature = "training")]
mod fit;

#[cfg(feature = "training")]
pub use fit::{CoStGcnFitParams, co_st_gcn_from};

use opendr_engine::data::SkeletonSequence;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::frame_features::{FEATURES_PER_COORDINATE, FrameFeatures, LastFrame};

use super::GraphType;
use super::model_checks::{check_architecture, check_classes, joints_of};
use super::persons::{add_to, mean_category};
use super::sizes::{Architecture, NetworkSizes};

opendr_engine::choices! {
    /// Network architecture.
    pub enum Backbone {
        /// Spatial-temporal graph convolutions (Yan et al., 2018).
        CoStGcn = "costgcn",
        /// Adaptive graph convolutions: edges from the similarity of joints, too (Shi et al., 2019).
        CoAGcn = "coagcn",
        /// Spatial transformer: self-attention among the joints from the fourth block on (Plizzari et al., 2021).
        CoSTr = "costr",
    }
}

/// Parameters of [`CoStGcn`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct CoStGcnParams {
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub num_classes: Option<usize>,
    /// Number of joints. None: that of the graph.
    #[param(range = 2..=1000)]
    pub num_point: Option<usize>,
    /// Maximum number of persons, the first ones of a recording; the prediction is the mean over those present so far.
    #[param(default = 2, range = 1..=64)]
    pub num_person: usize,
    /// Number of coordinates of a joint: 2 (a third channel of the input holds scores) or 3.
    #[param(default = 3, range = 2..=3)]
    pub in_channels: usize,
    /// Skeleton: joints and bones.
    pub graph_type: GraphType,
    /// Network architecture.
    pub backbone: Backbone,
    /// Number of frames that a prediction covers.
    #[param(default = 300, range = 1..=10_000)]
    pub sequence_len: usize,
    /// Output channels of each block; in `costr`, multiples of 32 from the fourth block on.
    #[param(default = vec![64, 64, 64, 64, 128, 128, 128, 256, 256, 256], range = 1..=4096)]
    pub channels: Vec<usize>,
    /// Kernel size in time of each block; odd.
    #[param(default = 9, range = 3..=101)]
    pub temporal_kernel: usize,
}

impl CoStGcnParams {
    /// Returns the sizes of the network.
    pub(super) fn sizes(&self) -> NetworkSizes {
        NetworkSizes {
            architecture: match self.backbone {
                Backbone::CoStGcn => Architecture::StGcn,
                Backbone::CoAGcn => Architecture::AGcn,
                Backbone::CoSTr => Architecture::STr,
            },
            graph: self.graph_type,
            coordinates: self.in_channels,
            frames: self.sequence_len,
            channels: self.channels.clone(),
            kernel: self.temporal_kernel,
        }
    }
}

/// A loaded CoST-GCN.
pub struct CoStGcn {
    params: CoStGcnParams,
    classes: Classes,
    features: FrameFeatures,
    session: Session,
    /// Length of a person's state vector.
    state: usize,
}

/// State of a stream: for every person, the features that the convolutions need for the next frame.
#[derive(Debug, Default)]
pub struct CoStGcnState {
    persons: Vec<Person>,
    frame: Vec<f32>,
    sum: Vec<f32>,
}

#[derive(Debug, Default)]
struct Person {
    last: LastFrame,
    state: Vec<f32>,
    next: Vec<f32>,
    logits: Vec<f32>,
}

/// File of the network in every container. Inputs: `frame` `[1, features, 1, joints]`, `state` `[1, numbers]`; outputs:
/// `logits` `[1, classes]`, `next_state` `[1, numbers]`.
const FILE: &str = "model.onnx";

impl Learner for CoStGcn {
    const SPEC: Spec = Spec::new("co_st_gcn", Task::SkeletonBasedActionRecognition)
        .class("CoSTGCNLearner")
        .about("CoST-GCN, CoA-GCN or CoS-TR classifies the action of a moving skeleton, updated with every frame; trainable.")
        .without_effect(&[
            ("network_head", "only classification is supported"),
            ("loss", "always cross-entropy"),
            ("drop_last", "an incomplete last batch is always dropped"),
            ("pin_memory", "page-locked memory is not used"),
        ]);
    type Params = CoStGcnParams;
    type Input<'a> = &'a SkeletonSequence;
    type Target = Category;
    type State = CoStGcnState;

    fn load(model: &Model, params: CoStGcnParams, device: Device) -> Result<Self> {
        check_architecture("backbone", &params.backbone, model)?;
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([frame, state], [logits, next]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have two inputs and two outputs")));
        };
        let rows = FEATURES_PER_COORDINATE * params.in_channels;
        let joints = joints_of(params.graph_type, params.num_point)?;
        let (&[Some(1), Some(numbers)], &[_, Some(classes)]) = (&state.dims[..], &logits.dims[..]) else {
            return Err(Error::format(format!(
                "{FILE} takes {state} and returns {logits}; expected a network of one time step"
            )));
        };
        if next.dims != state.dims {
            return Err(Error::format(format!(
                "{FILE} returns {next} as the next state of {state}; the shapes must be equal"
            )));
        }
        if frame.dims != [Some(1), Some(rows), Some(1), Some(joints)] {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {frame}, but in_channels and graph_type specify [1, {rows}, 1, {joints}]; omit these parameters"
            )));
        }
        let wanted = params.sizes().state()?;
        if numbers != wanted {
            return Err(Error::invalid_param(format!(
                "{FILE} has a state of {numbers} values, but sequence_len, channels and temporal_kernel specify {wanted}; \
                 omit these parameters"
            )));
        }
        check_classes("num_classes", params.num_classes, classes)?;
        Ok(Self {
            features: FrameFeatures::new(params.graph_type.parents(), params.in_channels),
            classes: model.manifest().classes.clone(),
            state: numbers,
            params,
            session,
        })
    }

    fn params(&self) -> &CoStGcnParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut CoStGcnParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    /// Processes one or more frames of a sequence and writes the prediction after the last of them.
    fn infer_into(
        &self,
        state: &mut CoStGcnState,
        sequence: &SkeletonSequence,
        category: &mut Category,
    ) -> Result<()> {
        self.features.check(sequence)?;
        let [_, _, frames, _, persons] = sequence.shape();
        let CoStGcnState { persons: known, frame: features, sum } = state;
        features.resize(self.features.frame_len(), 0.0);
        for person in 0..persons.min(self.params.num_person) {
            if known.len() <= person {
                known.push(Person::default());
            }
            for frame in 0..frames {
                let one = &mut known[person];
                let first = !one.last.is_observed();
                if !self.features.write(sequence, frame, person, &mut one.last, features) {
                    continue;
                }
                if first {
                    one.state.clear();
                    one.state.resize(self.state, 0.0);
                    for _ in 1..self.params.sequence_len {
                        self.step(features, one)?;
                    }
                }
                self.step(features, one)?;
            }
        }
        sum.clear();
        let mut count = 0;
        for person in known.iter().take(persons).filter(|person| person.last.is_observed()) {
            add_to(sum, &person.logits);
            count += 1;
        }
        mean_category(category, sum, count, &self.classes)
    }
}

impl CoStGcn {
    /// Processes the features of one frame.
    fn step(&self, features: &[f32], person: &mut Person) -> Result<()> {
        let shape =
            [1, FEATURES_PER_COORDINATE * self.params.in_channels, 1, self.params.graph_type.joints()];
        let Person { state, next, logits, .. } = person;
        let inputs = [TensorView::new(&shape, features)?, TensorView::new(&[1, self.state], &state[..])?];
        self.session.run(&inputs, |outputs| {
            let [scores, kept] = outputs else {
                return Err(Error::internal("the network did not return two outputs"));
            };
            logits.clear();
            logits.extend_from_slice(scores.values()?);
            next.clear();
            next.extend_from_slice(kept.values()?);
            Ok(())
        })?;
        std::mem::swap(state, next);
        Ok(())
    }
}
