//! NanoTrack: one object of any kind, from a box around it in the first frame.
//!
//! The network of H. Chu, NanoTrack, 2022 (Apache-2.0): MobileNetV3 sees what is to be followed and where it may be now, and
//! every place of the second is compared with the first (B. Li et al., "High Performance Visual Tracking with Siamese Region
//! Proposal Network", CVPR 2018; boxes without anchors after Z. Zhang et al., "Ocean", ECCV 2020). Behind the interface of
//! OpenDR's SiamRPN.

mod choice;

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::params::Params;
use opendr_engine::target::{BoundingBox, BoundingBoxList, Name, TrackingAnnotation, TrackingAnnotationList};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_vision::{Border, Preprocess, Similarity};

use choice::{CELLS, Choice};

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct NanoTrackParams {
    /// How much a place far from where the object was is marked down.
    #[param(default = 0.455, range = 0.0..=1.0, live)]
    pub window_influence: f32,
    /// How much another size or shape than before is marked down.
    #[param(default = 0.138, range = 0.0..=1.0, live)]
    pub penalty: f32,
    /// How fast the size of the box follows what is seen.
    #[param(default = 0.348, range = 0.0..=1.0, live)]
    pub size_rate: f32,
}

/// A frame, and with the first what is to be followed.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct NanoTrackInputs<'a> {
    /// The frame.
    pub image: &'a Image,
    /// What is to be followed from this frame on: its first box.
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

/// What is followed in one stream.
#[derive(Default)]
pub struct NanoTrackState {
    object: Option<Object>,
    /// What it looked like.
    template: Vec<f32>,
    choice: Choice,
}

struct Object {
    name: Name,
    middle: [f32; 2],
    size: [f32; 2],
    frame: i64,
    /// The level of what lies beside the picture.
    beside: f32,
}

/// Sides of the crops that the first network sees: of the object, and of where it may be.
const TEMPLATE: usize = 127;
const SEARCH: usize = 255;
/// Channels and cells of the features of the first.
const TEMPLATE_SHAPE: [usize; 4] = [1, 48, 8, 8];
/// How much of its surroundings is seen with an object, as a share of its half circumference.
const CONTEXT: f32 = 0.5;
/// Objects do not become smaller, pixels.
const SMALLEST: f32 = 4.0;
/// The brightness of a picture is the mean of so many points each way.
const POINTS: usize = 32;

impl Learner for NanoTrack {
    const SPEC: Spec = Spec::new("nano_track", Task::ObjectTracking2d)
        .class("SiamRPNLearner")
        .about("NanoTrack follows one object of any kind from a box in the first frame.")
        .without_effect(&[
            ("n_epochs", Spec::OF_TRAINING),
            ("num_workers", Spec::OF_TRAINING),
            ("warmup_epochs", Spec::OF_TRAINING),
            ("lr", Spec::OF_TRAINING),
            ("weight_decay", Spec::OF_TRAINING),
            ("momentum", Spec::OF_TRAINING),
            ("cls_weight", Spec::OF_TRAINING),
            ("loc_weight", Spec::OF_TRAINING),
            ("batch_size", Spec::OF_TRAINING),
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
                "NanoTrack has a network from a picture to features and one that compares two of these",
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
        answer: &mut TrackingAnnotationList,
    ) -> Result<()> {
        let NanoTrackInputs { image, init_box } = input;
        let confidence = match init_box {
            Some(boxes) => {
                answer.classes.clone_from(&boxes.classes);
                self.begin(state, image, boxes)?;
                1.0
            }
            None => self.follow(state, image)?,
        };
        let Some(object) = &state.object else { return Ok(()) };
        let [width, height] = object.size;
        let [left, top] = [object.middle[0] - width / 2.0, object.middle[1] - height / 2.0];
        let bounding_box = BoundingBox::new(object.name.clone(), left, top, width, height, confidence);
        answer.action = None;
        answer.annotations.clear();
        answer.annotations.push(TrackingAnnotation { bounding_box, id: 0, frame: Some(object.frame) });
        Ok(())
    }
}

impl NanoTrack {
    /// Looks at what is to be followed.
    fn begin(&self, state: &mut NanoTrackState, image: &Image, boxes: &BoundingBoxList) -> Result<()> {
        let object = Object::of(image, boxes)?;
        state.object = None;
        let NanoTrackState { template, .. } = state;
        self.see(&self.template, image, &object, object.seen(), |features| {
            let features = features.values()?;
            let wanted: usize = TEMPLATE_SHAPE.iter().product();
            if features.len() != wanted {
                return Err(Error::format(format!(
                    "{} features of an object instead of {wanted}",
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

    /// Where it is now, and how sure that is.
    fn follow(&self, state: &mut NanoTrackState, image: &Image) -> Result<f32> {
        let NanoTrackState { object, template, choice } = state;
        let Some(object) = object else {
            return Err(Error::invalid_input(
                "nothing is followed yet: give init_box, a box around the object, with the first frame of a stream",
            ));
        };
        let seen = object.seen();
        // Pixels of the crop in one of the picture.
        let scale = TEMPLATE as f32 / seen;
        let template = TensorView::new(&TEMPLATE_SHAPE, &template[..])?;
        let mut found = None;
        self.see(&self.search, image, object, seen * SEARCH as f32 / TEMPLATE as f32, |features| {
            self.comparison.run(&[template, *features], |outputs| {
                let [classes, sides] = self.outputs.map(|output| outputs[output].values::<f32>());
                found = choice.best(classes?, sides?, object.size.map(|side| side * scale), &self.params)?;
                Ok(())
            })
        })?;
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

    /// Hands the features of a square of `side` pixels around an object to `sink`.
    fn see(
        &self,
        preprocess: &Preprocess,
        image: &Image,
        object: &Object,
        side: f32,
        mut sink: impl FnMut(&TensorView<'_>) -> Result<()>,
    ) -> Result<()> {
        let [crop_side, _] = preprocess.size();
        let crop = Similarity::rotated_square(object.middle, side, 0.0, crop_side);
        let preprocess = preprocess.clone().border(Border::Level(object.beside));
        let (shape, count) = (preprocess.shape(), preprocess.len());
        let mut input = self.inputs.take();
        input.resize(count, 0.0);
        preprocess.warp_into(image.view(), &crop, &mut input[..])?;
        self.features.run(&[TensorView::new(&shape, &input[..])?], |outputs| match outputs {
            [features] => sink(features),
            _ => Err(Error::format(format!("{} features of a picture", outputs.len()))),
        })
    }
}

impl Object {
    /// The first of `boxes`.
    fn of(image: &Image, boxes: &BoundingBoxList) -> Result<Self> {
        let found = boxes.boxes.first().ok_or_else(|| {
            Error::invalid_input("init_box has no box: give one around the object that is to be followed")
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
                "init_box is {left}, {top}, {right}, {bottom}: give a box with an area in the picture of {width}x{height}"
            )));
        }
        Ok(Self {
            name: found.name.clone(),
            middle: [(left + right) / 2.0, (top + bottom) / 2.0],
            size: [found.width.max(SMALLEST), found.height.max(SMALLEST)],
            frame: 1,
            beside: brightness(image),
        })
    }

    /// The side of the square that is seen of it.
    fn seen(&self) -> f32 {
        let [width, height] = self.size;
        let context = CONTEXT * (width + height);
        ((width + context) * (height + context)).sqrt()
    }
}

/// The mean level of a picture, 0..=255.
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

// The places of the answer lie within the crop.
const _: () = assert!(CELLS * 16 == SEARCH + 1);

#[cfg(test)]
mod tests;
