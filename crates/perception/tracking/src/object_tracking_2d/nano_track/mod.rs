//! NanoTrack: tracking of one object of any class, from a box around it in the first frame.
//!
//! The network of H. Chu, NanoTrack, 2022 (Apache-2.0): MobileNetV3 computes features of the object and of a search region,
//! and the features at every position of the region are compared with the object's (B. Li et al., "High Performance Visual
//! Tracking with Siamese Region Proposal Network", CVPR 2018; boxes without anchors after Z. Zhang et al., "Ocean", ECCV
//! 2020). It has the interface of OpenDR's SiamRPN.

mod choice;
mod params;

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Name, TrackingAnnotation, TrackingAnnotationList};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_vision::{Border, Preprocess, Similarity};

use choice::{CELLS, Choice};
pub use params::NanoTrackParams;

/// A frame, and with the first one the object to track.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct NanoTrackInputs<'a> {
    /// Frame.
    pub image: &'a Image,
    /// Object to track from this frame on: its first box.
    #[port(init)]
    pub init_box: Option<&'a BoundingBoxList>,
}

/// The two networks of NanoTrack.
pub struct NanoTrack {
    params: NanoTrackParams,
    features: Session,
    comparison: Session,
    outputs: [usize; 2],
    template: Preprocess,
    search: Preprocess,
    inputs: Pool<Vec<f32>>,
}

/// The object of one stream.
#[derive(Default)]
pub struct NanoTrackState {
    object: Option<Object>,
    /// Features of the object.
    template: Vec<f32>,
    choice: Choice,
}

struct Object {
    name: Name,
    middle: [f32; 2],
    size: [f32; 2],
    frame: i64,
    /// Border level: the mean level of the first frame.
    border_level: f32,
}

/// Sides of the crops of object and search region, in pixels.
const TEMPLATE: usize = 127;
const SEARCH: usize = 255;
/// Shape of the object's features.
const TEMPLATE_SHAPE: [usize; 4] = [1, 48, 8, 8];
/// Margin around an object, as a share of its half circumference.
const CONTEXT: f32 = 0.5;
/// Minimum side of an object, in pixels.
const SMALLEST: f32 = 4.0;
/// Number of samples along each axis for the mean level of an image.
const POINTS: usize = 32;

impl Learner for NanoTrack {
    const SPEC: Spec = Spec::new("nano_track", Task::ObjectTracking2d)
        .class("SiamRPNLearner")
        .about("NanoTrack tracks one object of any class from a box in the first frame.")
        .without_effect(&[
            ("n_epochs", Spec::TRAINING_ONLY),
            ("num_workers", Spec::TRAINING_ONLY),
            ("warmup_epochs", Spec::TRAINING_ONLY),
            ("lr", Spec::TRAINING_ONLY),
            ("weight_decay", Spec::TRAINING_ONLY),
            ("momentum", Spec::TRAINING_ONLY),
            ("cls_weight", Spec::TRAINING_ONLY),
            ("loc_weight", Spec::TRAINING_ONLY),
            ("batch_size", Spec::TRAINING_ONLY),
        ]);
    type Params = NanoTrackParams;
    type Input<'a> = NanoTrackInputs<'a>;
    type Target = TrackingAnnotationList;
    type State = NanoTrackState;

    fn load(model: &Model, params: NanoTrackParams, device: Device) -> Result<Self> {
        let features = Session::open(&model.file("features.onnx")?, device)?;
        let comparison = Session::open(&model.file("comparison.onnx")?, device)?;
        if features.inputs().len() != 1 || features.outputs().len() != 1 || comparison.inputs().len() != 2 {
            return Err(Error::format(
                "NanoTrack needs a network from an image to features and one that compares two of these; load another model",
            ));
        }
        let outputs = [comparison.output_index("output1")?, comparison.output_index("output2")?];
        let [template, search] = [TEMPLATE, SEARCH].map(|side| Preprocess::new(side, side));
        Ok(Self { params, features, comparison, outputs, template, search, inputs: Pool::default() })
    }

    fn params(&self) -> &NanoTrackParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut NanoTrackParams {
        &mut self.params
    }

    fn infer_into(
        &self,
        state: &mut NanoTrackState,
        input: NanoTrackInputs<'_>,
        target: &mut TrackingAnnotationList,
    ) -> Result<()> {
        let NanoTrackInputs { image, init_box } = input;
        let confidence = match init_box {
            Some(boxes) => {
                target.classes.clone_from(&boxes.classes);
                self.begin(state, image, boxes)?;
                1.0
            }
            None => self.follow(state, image)?,
        };
        let Some(object) = &state.object else { return Ok(()) };
        let [width, height] = object.size;
        let [left, top] = [object.middle[0] - width / 2.0, object.middle[1] - height / 2.0];
        let bounding_box = BoundingBox::new(object.name.clone(), left, top, width, height, confidence);
        target.action = None;
        target.annotations.clear();
        target.annotations.push(TrackingAnnotation { bounding_box, id: 0, frame: Some(object.frame) });
        Ok(())
    }
}

impl NanoTrack {
    /// Starts to track the first of `boxes`.
    fn begin(&self, state: &mut NanoTrackState, image: &Image, boxes: &BoundingBoxList) -> Result<()> {
        let object = Object::of(image, boxes)?;
        state.object = None;
        let NanoTrackState { template, .. } = state;
        self.extract_features(&self.template, image, &object, object.context_side(), |features| {
            let features = features.values()?;
            let expected: usize = TEMPLATE_SHAPE.iter().product();
            if features.len() != expected {
                return Err(Error::format(format!(
                    "the network has {} features of an object instead of {expected}; load another model",
                    features.len()
                )));
            }
            template.clear();
            template.extend_from_slice(features);
            Ok(())
        })?;
        state.object = Some(object);
        Ok(())
    }

    /// Updates position and size of the object and returns its score.
    fn follow(&self, state: &mut NanoTrackState, image: &Image) -> Result<f32> {
        let NanoTrackState { object, template, choice } = state;
        let Some(object) = object else {
            return Err(Error::invalid_input(
                "no object is tracked yet; give init_box, a box around the object, with the first frame of a stream",
            ));
        };
        let context_side = object.context_side();
        // Pixels of the crop per pixel of the image.
        let scale = TEMPLATE as f32 / context_side;
        let template = TensorView::new(&TEMPLATE_SHAPE, &template[..])?;
        let mut found = None;
        self.extract_features(
            &self.search,
            image,
            object,
            context_side * SEARCH as f32 / TEMPLATE as f32,
            |features| {
                self.comparison.run(&[template, *features], |outputs| {
                    let [classes, sides] = self.outputs.map(|output| outputs[output].values::<f32>());
                    found =
                        choice.best(classes?, sides?, object.size.map(|side| side * scale), &self.params)?;
                    Ok(())
                })
            },
        )?;
        object.frame = object.frame.saturating_add(1);
        let Some(found) = found else { return Ok(0.0) };
        let picture = [image.width(), image.height()].map(|side| side as f32);
        for (axis, picture) in picture.into_iter().enumerate() {
            object.middle[axis] = (object.middle[axis] + found.offset[axis] / scale).clamp(0.0, picture);
            let side = object.size[axis] * (1.0 - found.rate) + found.size[axis] / scale * found.rate;
            object.size[axis] = side.clamp(SMALLEST, picture.max(SMALLEST));
        }
        Ok(found.score)
    }

    /// Computes the features of a square of `side` pixels around an object and passes them to `sink`.
    fn extract_features(
        &self,
        preprocess: &Preprocess,
        image: &Image,
        object: &Object,
        side: f32,
        mut sink: impl FnMut(&TensorView<'_>) -> Result<()>,
    ) -> Result<()> {
        let [crop_side, _] = preprocess.size();
        let crop = Similarity::rotated_square(object.middle, side, 0.0, crop_side);
        let preprocess = preprocess.clone().border(Border::Constant(object.border_level));
        let (shape, count) = (preprocess.shape(), preprocess.len());
        let mut input = self.inputs.take();
        input.resize(count, 0.0);
        preprocess.warp_into(image.view(), &crop, &mut input[..])?;
        self.features.run(&[TensorView::new(&shape, &input[..])?], |outputs| match outputs {
            [features] => sink(features),
            _ => Err(Error::format(format!(
                "the network has {} outputs instead of one; load another model",
                outputs.len()
            ))),
        })
    }
}

impl Object {
    /// Creates the object from the first of `boxes`.
    fn of(image: &Image, boxes: &BoundingBoxList) -> Result<Self> {
        let found = boxes.boxes.first().ok_or_else(|| {
            Error::invalid_input("init_box has no box; give one around the object to track")
        })?;
        let (width, height) = (image.width() as f32, image.height() as f32);
        let [left, top, right, bottom] = found.corners();
        let is_sound = [left, top, right, bottom].iter().all(|edge| edge.is_finite())
            && found.width > 0.0
            && found.height > 0.0
            && (left < width && right > 0.0 && top < height && bottom > 0.0)
            && found.width <= 4.0 * width
            && found.height <= 4.0 * height;
        if !is_sound {
            return Err(Error::invalid_input(format!(
                "init_box is {left}, {top}, {right}, {bottom}; give a box with an area in the image of {width}x{height}"
            )));
        }
        Ok(Self {
            name: found.name.clone(),
            middle: [(left + right) / 2.0, (top + bottom) / 2.0],
            size: [found.width.max(SMALLEST), found.height.max(SMALLEST)],
            frame: 1,
            border_level: brightness(image),
        })
    }

    /// Returns the side of the square around the object with its context.
    fn context_side(&self) -> f32 {
        let [width, height] = self.size;
        let context = CONTEXT * (width + height);
        ((width + context) * (height + context)).sqrt()
    }
}

/// Returns the mean level of an image, 0..=255.
fn brightness(image: &Image) -> f32 {
    let (view, channels) = (image.view(), image.channels().min(3));
    let mut sum = 0.0;
    for at in 0..POINTS * POINTS {
        let [x, y] = [(at % POINTS, image.width()), (at / POINTS, image.height())]
            .map(|(step, side)| (2 * step + 1) * side / (2 * POINTS));
        sum += (0..channels).map(|channel| f32::from(view.sample_u8(x, y, channel))).sum::<f32>();
    }
    sum / (POINTS * POINTS * channels.max(1)) as f32
}

// The positions of the output lie within the crop.
const _: () = assert!(CELLS * 16 == SEARCH + 1);

#[cfg(test)]
mod tests;
