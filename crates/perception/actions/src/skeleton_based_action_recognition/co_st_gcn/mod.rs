//! CoST-GCN: the spatial-temporal graph convolutions of [`SpatioTemporalGcn`](super::SpatioTemporalGcn), one frame at a time.
//!
//! Hedegaard, Heidari and Iosifidis, Continual Spatio-Temporal Graph Convolutional Networks, 2022. Every convolution through time keeps
//! the frames that it still needs, so that a frame is computed once and not once for each clip that it is in: with
//! clips of 40 frames, a twentieth of the arithmetic per answer.
//!
//! # Delay and padding
//!
//! Nothing is padded in time, neither here nor clip-wise, and no block strides; so the answer after a frame is the one of
//! [`SpatioTemporalGcn`](super::SpatioTemporalGcn) to the clip that ends with that frame, but for the order in which numbers are
//! added up. It speaks of `sequence_len` frames; each block looks from the middle of its frames, half of
//! `temporal_kernel` ago. There is no warm-up either: before its first frame, a person stands still, there as here, so
//! that the first answer comes with the first frame (which alone takes `sequence_len` steps).

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
use opendr_perception_common::frame_features::{FrameFeatures, KINDS, LastFrame};

use super::GraphType;
use super::sizes::NetworkSizes;
use super::spatio_temporal_gcn::{add_to, check_classes, joints_of, mean_category};

opendr_engine::choices! {
    /// Which network looks at the skeletons.
    pub enum Backbone {
        /// Continual spatial-temporal graph convolutions (Hedegaard et al., 2022).
        CoStGcn = "costgcn",
    }
}

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct CoStGcnParams {
    /// Classes. None: as many as the data name.
    #[param(range = 2..=10_000)]
    pub num_classes: Option<usize>,
    /// Joints. None: as many as the graph has.
    #[param(range = 2..=1000)]
    pub num_point: Option<usize>,
    /// Persons of a recording that are looked at, the first ones; the answer is the mean over those seen so far.
    #[param(default = 2, range = 1..=64)]
    pub num_person: usize,
    /// Coordinates of a joint: 2 (a third channel, where there is one, holds scores) or 3.
    #[param(default = 3, range = 2..=3)]
    pub in_channels: usize,
    /// Joints and bones.
    pub graph_type: GraphType,
    /// The network.
    pub backbone: Backbone,
    /// Frames that an answer speaks of.
    #[param(default = 300, range = 1..=10_000)]
    pub sequence_len: usize,
    /// Channels of each block.
    #[param(default = vec![64, 64, 64, 64, 128, 128, 128, 256, 256, 256], range = 1..=4096)]
    pub channels: Vec<usize>,
    /// Frames that a block sees; odd.
    #[param(default = 9, range = 3..=101)]
    pub temporal_kernel: usize,
}

impl CoStGcnParams {
    fn sizes(&self) -> NetworkSizes {
        NetworkSizes {
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
    /// Numbers of a person's state.
    state: usize,
}

/// What a stream remembers: for every person what its convolutions still need.
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

/// The network in every container: `frame` `[1, features, 1, joints]` and `state` `[1, numbers]` to `logits`
/// `[1, classes]` and `next_state` `[1, numbers]`.
const FILE: &str = "model.onnx";

impl Learner for CoStGcn {
    const SPEC: Spec = Spec::new("co_st_gcn", Task::SkeletonBasedActionRecognition)
        .class("CoSTGCNLearner")
        .about("CoST-GCN tells after every frame what a person does by its moving skeleton; it trains.")
        .without_effect(&[
            ("network_head", "it classifies"),
            ("loss", "it is the cross-entropy"),
            ("drop_last", "a last batch that is not full is always left out"),
            ("pin_memory", "there is no such memory"),
        ]);
    type Params = CoStGcnParams;
    type Input<'a> = &'a SkeletonSequence;
    type Target = Category;
    type State = CoStGcnState;

    fn load(model: &Model, params: CoStGcnParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([frame, state], [logits, next]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} has not two inputs and two outputs")));
        };
        let rows = KINDS * params.in_channels;
        let joints = joints_of(params.graph_type, params.num_point)?;
        let (&[Some(1), Some(numbers)], &[_, Some(classes)]) = (&state.dims[..], &logits.dims[..]) else {
            return Err(Error::format(format!("{FILE} takes {state} and gives {logits}, which is no step")));
        };
        if next.dims != state.dims {
            return Err(Error::format(format!("{FILE} makes {next} of {state}, which is no next state")));
        }
        if frame.dims != [Some(1), Some(rows), Some(1), Some(joints)] {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {frame}; in_channels and graph_type make [1, {rows}, 1, {joints}]: leave them out"
            )));
        }
        let wanted = params.sizes().state()?;
        if numbers != wanted {
            return Err(Error::invalid_param(format!(
                "{FILE} keeps {numbers} numbers; sequence_len, channels and temporal_kernel make {wanted}: leave them out"
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

    /// Takes the frames of a sequence, one or many, and answers for the last.
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
                let first = !one.last.is_seen();
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
        for person in known.iter().take(persons).filter(|person| person.last.is_seen()) {
            add_to(sum, &person.logits);
            count += 1;
        }
        mean_category(category, sum, count, &self.classes)
    }
}

impl CoStGcn {
    /// Takes the features of one frame in.
    fn step(&self, features: &[f32], person: &mut Person) -> Result<()> {
        let shape = [1, KINDS * self.params.in_channels, 1, self.params.graph_type.joints()];
        let Person { state, next, logits, .. } = person;
        let inputs = [TensorView::new(&shape, features)?, TensorView::new(&[1, self.state], &state[..])?];
        self.session.run(&inputs, |outputs| {
            let [scores, kept] = outputs else {
                return Err(Error::internal("a step gave not two outputs"));
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
