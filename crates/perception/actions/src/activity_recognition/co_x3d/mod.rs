//! CoX3D: [`X3d`](super::X3d) on one image at a time.
//!
//! Hedegaard and Iosifidis, Continual 3D Convolutional Neural Networks for Real-time Processing of Videos, ECCV 2022. Every
//! convolution through time keeps the features that later frames need, so each frame is computed once and not once for every
//! clip that contains it.
//!
//! # Delay and padding
//!
//! Convolutions are causal, here and in [`X3d`](super::X3d), so there is no delay; the first frame is repeated for the time
//! before it. After as many frames as a clip has, the prediction equals that of [`X3d`](super::X3d) for the clip of these
//! frames. Later predictions also depend on frames before the clip, in place of repeated first frames.

#[cfg(feature = "training")]
mod fit;

#[cfg(feature = "training")]
pub use fit::{CoX3dFitParams, co_x3d_from};

use opendr_engine::data::Image;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;
use opendr_perception_common::clip_frames::ClipFrames;

use super::x3d::check_classes;
use super::{Backbone, Sizes};

/// Parameters of [`CoX3d`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct CoX3dParams {
    /// Default frames of a clip, side of a frame and depth of the network.
    pub backbone: Backbone,
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub num_classes: Option<usize>,
    /// Number of frames over which the features are averaged. None: that of the backbone.
    #[param(range = 1..=256)]
    pub temporal_window_size: Option<usize>,
    /// Side of a frame in pixels. None: that of the backbone.
    #[param(range = 32..=1024, unit = "px")]
    pub side: Option<usize>,
    /// Factor on the number of channels.
    #[param(default = 1.0, range = 0.1..=8.0)]
    pub width: f64,
    /// Factor on the number of blocks. None: that of the backbone.
    #[param(range = 0.1..=8.0)]
    pub depth: Option<f64>,
}

impl CoX3dParams {
    fn sizes(&self) -> Result<Sizes> {
        Sizes::new(self.backbone, self.temporal_window_size, self.side, self.width, self.depth)
    }
}

/// A loaded CoX3D.
pub struct CoX3d {
    params: CoX3dParams,
    classes: Classes,
    frames: ClipFrames,
    session: Session,
    side: usize,
    /// Length of the state vector.
    state: usize,
}

/// State of a stream: the features that the convolutions need for the next frame.
#[derive(Debug, Default)]
pub struct CoX3dState {
    input: Vec<f32>,
    /// Whether the stream has had a frame.
    has_begun: bool,
    kept: Vec<f32>,
    next: Vec<f32>,
}

/// File of the network in every container. Inputs: `frame` `[1, 3, side, side]`, `state` `[1, numbers]`, `is_first` `[1, 1]`;
/// outputs: `logits` `[1, classes]`, `next_state` `[1, numbers]`.
const FILE: &str = "model.onnx";

impl Learner for CoX3d {
    const SPEC: Spec = Spec::new("co_x3d", Task::ActivityRecognition)
        .class("CoX3DLearner")
        .about("CoX3D classifies the activity in a video, updated with every frame; trainable.")
        .without_effect(&[
            ("network_head", "only classification is supported"),
            ("loss", "always cross-entropy"),
            ("drop_last", "an incomplete last batch is always dropped"),
            ("pin_memory", "page-locked memory is not used"),
        ]);
    type Params = CoX3dParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = CoX3dState;

    fn load(model: &Model, params: CoX3dParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([frame, state, _], [logits, next]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have three inputs and two outputs")));
        };
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
        let Sizes { side, frames, .. } = params.sizes()?;
        if frame.dims != [Some(1), Some(3), Some(side), Some(side)] {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {frame}, but backbone and side specify [1, 3, {side}, {side}]; omit these parameters"
            )));
        }
        check_classes(params.num_classes, classes)?;
        Ok(Self {
            frames: ClipFrames::new(side, frames),
            classes: model.manifest().classes.clone(),
            state: numbers,
            params,
            session,
            side,
        })
    }

    fn params(&self) -> &CoX3dParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut CoX3dParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, state: &mut CoX3dState, image: &Image, category: &mut Category) -> Result<()> {
        let CoX3dState { input, has_begun, kept, next } = state;
        self.frames.image_into(image, input)?;
        let is_first = [if *has_begun { 0.0 } else { 1.0 }];
        kept.resize(self.state, 0.0);
        let inputs = [
            TensorView::new(&[1, 3, self.side, self.side], &input[..])?,
            TensorView::new(&[1, self.state], &kept[..])?,
            TensorView::new(&[1, 1], &is_first[..])?,
        ];
        self.session.run(&inputs, |outputs| {
            let [logits, left] = outputs else {
                return Err(Error::internal("the network did not return two outputs"));
            };
            next.clear();
            next.extend_from_slice(left.values()?);
            category_from_logits(category, logits.values()?, &self.classes)
        })?;
        std::mem::swap(kept, next);
        *has_begun = true;
        Ok(())
    }
}
