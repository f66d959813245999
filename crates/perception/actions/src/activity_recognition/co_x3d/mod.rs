//! CoX3D: [`X3d`](super::X3d), one picture at a time.
//!
//! Hedegaard and Iosifidis, Continual 3D Convolutional Neural Networks for Real-time Processing of Videos, ECCV 2022. Every convolution
//! through time keeps what the next frames need of this one, so that a frame is computed once and not once for each clip that
//! it is in.
//!
//! # Delay and padding
//!
//! Convolutions look back only, here as clip-wise, so nothing is delayed; before its first frame, a stream stands still.
//! After as many frames as a clip has, the answer is that of [`X3d`](super::X3d) to the clip of these frames. Later, frames
//! before the clip still count, where clip-wise they never were: what the network sees then is a real past.

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

/// What a user may set. Sizes are those of the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct CoX3dParams {
    /// Frames of a clip, pixels of a frame and depth of the network, where nothing else is given.
    pub backbone: Backbone,
    /// Classes. None: as many as the data name.
    #[param(range = 2..=10_000)]
    pub num_classes: Option<usize>,
    /// Frames that an answer is averaged over. None: as the backbone has.
    #[param(range = 1..=256)]
    pub temporal_window_size: Option<usize>,
    /// Pixels of a side of a frame. None: as the backbone has.
    #[param(range = 32..=1024, unit = "px")]
    pub side: Option<usize>,
    /// Factor on the channels.
    #[param(default = 1.0, range = 0.1..=8.0)]
    pub width: f64,
    /// Factor on the number of blocks. None: as the backbone has.
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
    /// Numbers of a state.
    state: usize,
}

/// What a stream remembers: what its convolutions still need.
#[derive(Debug, Default)]
pub struct CoX3dState {
    input: Vec<f32>,
    /// Whether there was a picture.
    has_begun: bool,
    kept: Vec<f32>,
    next: Vec<f32>,
}

/// The network in every container: `frame` `[1, 3, side, side]`, `state` `[1, numbers]` and `is_first` `[1, 1]` to
/// `logits` `[1, classes]` and `next_state` `[1, numbers]`.
const FILE: &str = "model.onnx";

impl Learner for CoX3d {
    const SPEC: Spec = Spec::new("co_x3d", Task::ActivityRecognition)
        .class("CoX3DLearner")
        .about("CoX3D tells after every picture of a video what persons do; it trains.")
        .without_effect(&[
            ("network_head", "it classifies"),
            ("loss", "it is the cross-entropy"),
            ("drop_last", "a last batch that is not full is always left out"),
            ("pin_memory", "there is no such memory"),
        ]);
    type Params = CoX3dParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = CoX3dState;

    fn load(model: &Model, params: CoX3dParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([frame, state, _], [logits, next]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} has not three inputs and two outputs")));
        };
        let (&[Some(1), Some(numbers)], &[_, Some(classes)]) = (&state.dims[..], &logits.dims[..]) else {
            return Err(Error::format(format!("{FILE} takes {state} and gives {logits}, which is no step")));
        };
        if next.dims != state.dims {
            return Err(Error::format(format!("{FILE} makes {next} of {state}, which is no next state")));
        }
        let Sizes { side, frames, .. } = params.sizes()?;
        if frame.dims != [Some(1), Some(3), Some(side), Some(side)] {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {frame}; backbone and side make [1, 3, {side}, {side}]: leave them out"
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
        self.frames.picture_into(image, input)?;
        let is_first = [if *has_begun { 0.0 } else { 1.0 }];
        kept.resize(self.state, 0.0);
        let inputs = [
            TensorView::new(&[1, 3, self.side, self.side], &input[..])?,
            TensorView::new(&[1, self.state], &kept[..])?,
            TensorView::new(&[1, 1], &is_first[..])?,
        ];
        self.session.run(&inputs, |outputs| {
            let [logits, left] = outputs else {
                return Err(Error::internal("a step gave not two outputs"));
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
