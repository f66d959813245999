//! Hand gesture recognition from colour and depth.
//!
//! A convolutional network with four input channels, as OpenDR's learner of this name: colour and depth are fused in the first
//! layer. Both images show the same view and may differ in size; depth may have holes, and if it is unknown everywhere, colour
//! alone decides.

mod depth;
#[cfg(feature = "training")]
mod fit;
#[cfg(feature = "training")]
mod objective;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

#[cfg(feature = "training")]
pub use fit::RgbdHandGestureFitParams;
use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::category_scores::category_from_logits;
use opendr_vision::Preprocess;

use self::depth::DepthNormaliser;

opendr_engine::choices! {
    /// Network architecture.
    pub enum RgbdArchitecture {
        /// Four convolutions, as in the image classifier.
        Small = "small",
    }
}

/// Parameters of [`RgbdHandGesture`]. The sizes apply to the network that is trained; a loaded model has its own.
#[derive(Debug, Clone, Params)]
pub struct RgbdHandGestureParams {
    /// Number of classes. None: the number of classes in the data set.
    #[param(range = 2..=10_000)]
    pub n_class: Option<usize>,
    /// Network architecture.
    pub architecture: RgbdArchitecture,
}

/// An image and its depth.
#[derive(Inputs)]
pub struct RgbdInputs<'a> {
    /// The colour image.
    pub image: &'a Image,
    /// Depth of the same view, one channel: floats in metres, 16 bits in millimetres, 8 bits in centimetres. Values of at most
    /// 0 are unknown.
    pub depth: &'a Image,
}

/// A loaded network.
pub struct RgbdHandGesture {
    params: RgbdHandGestureParams,
    classes: Classes,
    session: Session,
    front_end: FrontEnd,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    input: Vec<f32>,
    depths: Vec<f32>,
}

/// File of the network in every container: `image` `[1, 4, side, side]` to `logits` `[1, classes]`.
const FILE: &str = "model.onnx";
/// Number of input channels: colour and depth.
const CHANNELS: usize = 4;

/// Computes the network's input from both images.
#[derive(Debug, Clone)]
struct FrontEnd {
    colour: Preprocess,
    depth: DepthNormaliser,
}

impl FrontEnd {
    /// Creates the front end for images of `side` x `side` pixels.
    fn new(side: usize) -> Self {
        let colour = Preprocess::new(side, side).normalise([127.5; 3], [127.5; 3]);
        Self { colour, depth: DepthNormaliser::new(side) }
    }

    /// Replaces `scratch.input` by `[4, side, side]`: colour in -1..=1, nearness in 0..=1.
    fn run(&self, inputs: &RgbdInputs<'_>, scratch: &mut Scratch) -> Result<()> {
        let Scratch { input, depths } = scratch;
        let colour = self.colour.len();
        input.resize(colour / 3 * CHANNELS, 0.0);
        let (levels, nearness) = input.split_at_mut(colour);
        self.colour.run_into(inputs.image.view(), levels)?;
        self.depth.run_into(inputs.depth, depths, nearness)
    }
}

impl Learner for RgbdHandGesture {
    const SPEC: Spec = Spec::new("rgbd_hand_gesture", Task::MultimodalHumanCentric)
        .class("RgbdHandGestureLearner")
        .about("Recognises hand gestures from colour and depth; trainable.")
        .without_effect(&[
            ("pretrained", "there are no pretrained weights for the network"),
            ("n_workers", Spec::TRAINING_ONLY),
            ("test_mode", "OpenDR used it to shorten its own tests"),
        ]);
    type Params = RgbdHandGestureParams;
    type Input<'a> = RgbdInputs<'a>;
    type Target = Category;
    type State = ();

    fn load(model: &Model, params: RgbdHandGestureParams, device: Device) -> Result<Self> {
        let session = Session::open(&model.file(FILE)?, device)?;
        let ([input], [output]) = (session.inputs(), session.outputs()) else {
            return Err(Error::format(format!("{FILE} does not have exactly one input and one output")));
        };
        let side = match input.dims[..] {
            [_, Some(CHANNELS), Some(height), Some(width)] if height == width => width,
            _ => {
                return Err(Error::format(format!(
                    "{FILE} takes {input}; expected a square image of 4 channels"
                )));
            }
        };
        if let (Some(wanted), Some(there)) = (params.n_class, output.dims.last().copied().flatten())
            && wanted != there
        {
            return Err(Error::invalid_param(format!(
                "n_class = {wanted}, but the model has {there} classes; omit n_class or load another model"
            )));
        }
        let classes = model.classes().clone();
        Ok(Self { params, classes, session, front_end: FrontEnd::new(side), scratch: Pool::default() })
    }

    fn params(&self) -> &RgbdHandGestureParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut RgbdHandGestureParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), inputs: RgbdInputs<'_>, category: &mut Category) -> Result<()> {
        let scratch = &mut *self.scratch.take();
        self.front_end.run(&inputs, scratch)?;
        let side = self.front_end.colour.size()[0];
        self.session.run(&[TensorView::new(&[1, CHANNELS, side, side], &scratch.input[..])?], |outputs| {
            let logits = outputs.first().map_or(Ok(&[][..]), TensorView::values)?;
            category_from_logits(category, logits, &self.classes)
        })
    }
}
