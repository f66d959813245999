//! Seq2Seq-NMS: learned non-maximum suppression by geometry and appearance of boxes.
//!
//! C. Symeonidis, I. Mademlis, I. Pitas, N. Nikolaidis, Neural Attention-Driven Non-Maximum Suppression for Person
//! Detection, IEEE Transactions on Image Processing 2023. The learner is a post-processing: its inputs are an image and the
//! boxes of any detector whose suppression is switched off (`iou_threshold` 1). Every box attends to the boxes that overlap
//! it (scaled dot-product attention, with a mask against boxes of lower scores) and gets a new score: the score of the one
//! box that matches an object stays, that of its duplicates falls.
//!
//! Two things differ from OpenDR: a box attends to its 16 nearest instead of all, which needs little memory; and the output
//! of the network is added to the logit of the detector's score, so an untrained network changes nothing.

#[cfg(feature = "training")]
mod candidates;
mod described;
mod edge_map;
#[cfg(feature = "training")]
mod fit;
mod moments;
#[cfg(feature = "training")]
mod network;
#[cfg(feature = "training")]
mod objective;
mod relations;
#[cfg(test)]
#[cfg(feature = "training")]
mod tests;

pub use described::NmsVariant;
#[cfg(feature = "training")]
pub use fit::Seq2SeqNmsFitParams;
use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::{Manifest, Model};
use opendr_engine::params::{Param as _, ParamValue, Params};
use opendr_engine::target::{BoundingBoxList, Classes};
use opendr_engine::{Device, Error, Pool, Result, Task};
use opendr_inference::{Session, TensorView};
use opendr_perception_common::suppression::Candidate;

use described::{Choice, Described};
use relations::{GEOMETRY, NEIGHBOURS};

/// Parameters of [`Seq2SeqNms`].
#[derive(Debug, Clone, Params)]
pub struct Seq2SeqNmsParams {
    /// New score below which boxes are dropped.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// IoU above which only the box with the highest score enters the network.
    #[param(default = 0.8, range = 0.0..=1.0, live)]
    pub iou_filtering: f32,
    /// Maximum number of boxes that enter the network, highest scores first.
    #[param(default = 400, range = 1..=1000, live, alias = "top_k")]
    pub max_dt_boxes: usize,
}

/// An image and the unsuppressed detections in it.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct Seq2SeqNmsInputs<'a> {
    /// Image.
    pub image: &'a Image,
    /// Boxes before suppression; boxes of classes that the model does not have are dropped.
    pub detections: &'a BoundingBoxList,
}

/// A loaded network.
pub struct Seq2SeqNms {
    params: Seq2SeqNmsParams,
    classes: Classes,
    session: Session,
    variant: NmsVariant,
    scratch: Pool<Scratch>,
}

#[derive(Default)]
struct Scratch {
    candidates: Vec<Candidate>,
    marks: Vec<bool>,
    described: Described,
}

/// File name of the network in a container. Inputs: `own` `[boxes, 14]`, `pairs` `[boxes, 16, 14]`, `neighbours`
/// `[boxes, 16]`, `mask` `[boxes, 16]`, `appearance` `[boxes, values]`. Output: `change` `[boxes, 1]`.
const FILE: &str = "model.onnx";
/// Key of the variant in the `inputs` of the manifest.
const VARIANT: &str = "variant";

impl Learner for Seq2SeqNms {
    const SPEC: Spec = Spec::new("seq2seq_nms", Task::ObjectDetection2d)
        .class("Seq2SeqNMSLearner")
        .about(
            "Learned non-maximum suppression of a detector's boxes, by geometry and appearance; trainable.",
        )
        .without_effect(&[
            ("app_feats", "boxes are always described by FMoD"),
            ("fmod_map_type", "FMoD always describes edges"),
            ("fmod_map_bin", "the edge map is always binary"),
            ("app_input_dim", "it follows from the variant"),
            ("temp_path", "fit writes to its output folder"),
            ("checkpoint_load_iter", "fit resumes from the last checkpoint of its output folder"),
        ]);
    type Params = Seq2SeqNmsParams;
    type Input<'a> = Seq2SeqNmsInputs<'a>;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: Seq2SeqNmsParams, device: Device) -> Result<Self> {
        let variant = variant_of(model.manifest())?;
        let classes = model.classes().clone();
        if classes.is_empty() {
            return Err(Error::format("the model names no classes; train or download it again"));
        }
        let session = Session::open(&model.file(FILE)?, device)?;
        let expected: [&[usize]; 5] =
            [&[GEOMETRY], &[NEIGHBOURS, GEOMETRY], &[NEIGHBOURS], &[NEIGHBOURS], &[variant.moments().len()]];
        let fits = session.inputs().len() == expected.len()
            && session.inputs().iter().zip(expected).all(|(input, expected)| {
                let dims = input.dims.get(1..).unwrap_or_default();
                dims.len() == expected.len()
                    && dims.iter().zip(expected).all(|(dim, expected)| *dim == Some(*expected))
            });
        if !fits || session.outputs().len() != 1 {
            return Err(Error::format(format!(
                "{FILE} does not have the five inputs and the output of the variant {:?}; train or download it again",
                variant.name()
            )));
        }
        Ok(Self { params, classes, session, variant, scratch: Pool::default() })
    }

    fn params(&self) -> &Seq2SeqNmsParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut Seq2SeqNmsParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }

    fn infer_into(&self, _: &mut (), input: Seq2SeqNmsInputs<'_>, boxes: &mut BoundingBoxList) -> Result<()> {
        boxes.boxes.clear();
        boxes.classes.clone_from(&self.classes);
        let Scratch { candidates, marks, described } = &mut *self.scratch.take();
        let choice = Choice { overlap: self.params.iou_filtering, most: self.params.max_dt_boxes };
        choice.choose(input.detections, &self.classes, candidates, marks);
        if candidates.is_empty() {
            return Ok(());
        }
        described.clear();
        described.add(input.image, candidates, self.variant)?;
        let (count, relations) = (candidates.len(), &described.relations);
        let tensors = [
            TensorView::new(&[count, GEOMETRY], &relations.own[..])?,
            TensorView::new(&[count, NEIGHBOURS, GEOMETRY], &relations.pairs[..])?,
            TensorView::new(&[count, NEIGHBOURS], &relations.neighbours[..])?,
            TensorView::new(&[count, NEIGHBOURS], &relations.mask[..])?,
            TensorView::new(&[count, self.variant.moments().len()], &described.appearance[..])?,
        ];
        self.session.run(&tensors, |outputs| {
            let changes = outputs.first().map_or(Ok(&[][..]), TensorView::values::<f32>)?;
            if changes.len() != count {
                return Err(Error::format(format!(
                    "{FILE} has {} outputs for {count} boxes; train or download it again",
                    changes.len()
                )));
            }
            for (candidate, change) in candidates.iter_mut().zip(changes) {
                candidate.score = changed_score(candidate.score, *change);
            }
            Ok(())
        })?;
        candidates.retain(|candidate| candidate.score >= self.params.threshold);
        candidates.sort_unstable_by(|a, b| b.score.total_cmp(&a.score).then(a.index.cmp(&b.index)));
        boxes.boxes.extend(candidates.iter().filter_map(|candidate| {
            let mut found = input.detections.boxes.get(candidate.index as usize)?.clone();
            found.name = i64::from(candidate.class).into();
            found.confidence = candidate.score;
            Some(found)
        }));
        Ok(())
    }
}

/// Margin by which scores are kept from 0 and 1.
const MARGIN: f32 = 1e-4;

/// Returns the log-odds of a score.
fn logit(score: f32) -> f32 {
    let score = score.clamp(MARGIN, 1.0 - MARGIN);
    (score / (1.0 - score)).ln()
}

/// Returns a score whose logit is changed by `change`; 0 when that is NaN.
fn changed_score(score: f32, change: f32) -> f32 {
    let odds = logit(score) + change;
    if odds.is_nan() { 0.0 } else { 1.0 / (1.0 + (-odds).exp()) }
}

/// Returns the variant of a container.
fn variant_of(manifest: &Manifest) -> Result<NmsVariant> {
    let name = manifest.inputs.get(VARIANT).and_then(|name| name.as_str());
    name.and_then(|name| NmsVariant::from_value(&ParamValue::Text(name.to_owned()))).ok_or_else(|| {
        Error::format(format!("the model's \"inputs\" have no valid {VARIANT}; train or download it again"))
    })
}
