//! X3D: a small network for clips, expanded along time, space, width and depth.
//!
//! Feichtenhofer, X3D: Expanding Architectures for Efficient Video Recognition, CVPR 2020. Different from the paper,
//! convolutions through time are causal and excitation covers single frames, so that [`CoX3d`](super::CoX3d) computes the same
//! predictions frame by frame. Weights of the paper's networks therefore do not fit.

#[cfg(feature = "training")]
mod fit;

use opendr_engine::data::Video;
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;
use opendr_perception_common::clip_frames::ClipFrames;

use super::{Backbone, Sizes};

/// Parameters of [`X3d`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct X3dParams {
    /// Default frames of a clip, side of a frame and depth of the network.
    pub backbone: Backbone,
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub num_classes: Option<usize>,
    /// Number of frames of a clip, sampled evenly. None: that of the backbone.
    #[param(range = 1..=256)]
    pub num_frames: Option<usize>,
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

impl X3dParams {
    fn sizes(&self) -> Result<Sizes> {
        Sizes::new(self.backbone, self.num_frames, self.side, self.width, self.depth)
    }
}

/// A loaded X3D.
pub struct X3d {
    params: X3dParams,
    classes: Classes,
    frames: ClipFrames,
    session: Session,
    sizes: Sizes,
    inputs: Pool<Vec<f32>>,
}

/// File of the network in every container: `clip` `[frames, 3, side, side]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";

impl Learner for X3d {
    const SPEC: Spec = Spec::new("x3d", Task::ActivityRecognition)
        .class("X3DLearner")
        .about("X3D classifies the activity in a video clip; trainable.")
        .without_effect(&[
            ("network_head", "only classification is supported"),
            ("loss", "always cross-entropy"),
            ("drop_last", "an incomplete last batch is always dropped"),
            ("pin_memory", "page-locked memory is not used"),
        ]);
    type Params = X3dParams;
    type Input<'a> = &'a Video;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: X3dParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have exactly one input and one output")));
        };
        let &[_, Some(classes)] = &output.dims[..] else {
            return Err(Error::format(format!("{FILE} returns {output}; expected scores [1, classes]")));
        };
        let sizes = params.sizes()?;
        if input.dims != [Some(sizes.frames), Some(3), Some(sizes.side), Some(sizes.side)] {
            return Err(Error::invalid_param(format!(
                "{FILE} takes {input}, but backbone, num_frames and side specify [{}, 3, {}, {}]; omit these parameters",
                sizes.frames, sizes.side, sizes.side
            )));
        }
        check_classes(params.num_classes, classes)?;
        Ok(Self {
            frames: ClipFrames::new(sizes.side, sizes.frames),
            classes: model.manifest().classes.clone(),
            inputs: Pool::default(),
            sizes,
            params,
            session,
        })
    }

    fn params(&self) -> &X3dParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut X3dParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), video: &Video, category: &mut Category) -> Result<()> {
        let input = &mut *self.inputs.take();
        self.frames.clip_into(video, input)?;
        let Sizes { frames, side, .. } = self.sizes;
        let input = TensorView::new(&[frames, 3, side, side], &input[..])?;
        self.session.run(&[input], |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}

/// Checks the number of classes that the user gave, where there is one, against the model.
pub(super) fn check_classes(wanted: Option<usize>, there: usize) -> Result<()> {
    match wanted {
        Some(wanted) if wanted != there => Err(Error::invalid_param(format!(
            "num_classes = {wanted}, but the model has {there} classes; omit num_classes or load another model"
        ))),
        _ => Ok(()),
    }
}
