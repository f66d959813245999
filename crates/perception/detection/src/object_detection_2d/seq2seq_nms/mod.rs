//! Seq2Seq-NMS: a network that tells which of overlapping boxes to keep, by how they lie and how they look.
//!
//! C. Symeonidis, I. Mademlis, I. Pitas, N. Nikolaidis, Neural Attention-Driven Non-Maximum Suppression for Person
//! Detection, IEEE Transactions on Image Processing 2023. It is a post-processing of its own: give it the boxes of any
//! detector whose suppression is switched off (`iou_threshold` 1), and the picture. Every box asks the boxes that overlap it
//! (scaled dot-product attention; the less sure ones are nearly masked), and gets a new score: that of the one box that
//! should stand for an object stays, that of its doubles falls.
//!
//! Two things differ from OpenDR: a box asks its 16 nearest instead of all, which costs little memory; and the network says
//! what is added to the detector's score (in logits), so that one that learned nothing changes nothing.

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

/// What a user may set.
#[derive(Debug, Clone, Params)]
pub struct Seq2SeqNmsParams {
    /// Boxes whose new score is below this are dropped.
    #[param(default = 0.1, range = 0.0..=1.0, live)]
    pub threshold: f32,
    /// Of boxes that overlap more than this (intersection over union) only the best is looked at.
    #[param(default = 0.8, range = 0.0..=1.0, live)]
    pub iou_filtering: f32,
    /// So many of the best boxes are looked at.
    #[param(default = 400, range = 1..=1000, live, alias = "top_k")]
    pub max_dt_boxes: usize,
}

/// A picture and all that a detector took for objects in it.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct Seq2SeqNmsInputs<'a> {
    /// The picture.
    pub image: &'a Image,
    /// Its boxes before suppression; boxes of classes that the model does not know are left out.
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

/// The network in every container. Of `boxes` boxes: `own` `[boxes, 14]`, `pairs` `[boxes, 16, 14]`, `neighbours`
/// `[boxes, 16]`, `mask` `[boxes, 16]`, `appearance` `[boxes, numbers]`, to `change` `[boxes, 1]`.
const FILE: &str = "model.onnx";
/// Where a container says its variant.
const VARIANT: &str = "variant";

impl Learner for Seq2SeqNms {
    const SPEC: Spec = Spec::new("seq2seq_nms", Task::ObjectDetection2d)
        .class("Seq2SeqNMSLearner")
        .about("Tells which of a detector's overlapping boxes to keep, by how they lie and look; it trains.")
        .without_effect(&[
            ("app_feats", "boxes are always described by FMoD"),
            ("fmod_map_type", "FMoD always looks at edges"),
            ("fmod_map_bin", "a place has an edge or has none"),
            ("app_input_dim", "it follows from the variant"),
            ("temp_path", "what fit writes lies in its output folder"),
            ("checkpoint_load_iter", "fit goes on from the last checkpoint of its output folder"),
        ]);
    type Params = Seq2SeqNmsParams;
    type Input<'a> = Seq2SeqNmsInputs<'a>;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, params: Seq2SeqNmsParams, device: Device) -> Result<Self> {
        let variant = variant_of(model.manifest())?;
        let classes = model.classes().clone();
        if classes.is_empty() {
            return Err(Error::format("the model names no classes; train or get it anew"));
        }
        let session = Session::open(&model.file(FILE)?, device)?;
        let wanted: [&[usize]; 5] =
            [&[GEOMETRY], &[NEIGHBOURS, GEOMETRY], &[NEIGHBOURS], &[NEIGHBOURS], &[variant.moments().len()]];
        let fits = session.inputs().len() == wanted.len()
            && session.inputs().iter().zip(wanted).all(|(input, wanted)| {
                let dims = input.dims.get(1..).unwrap_or_default();
                dims.len() == wanted.len()
                    && dims.iter().zip(wanted).all(|(dim, wanted)| *dim == Some(*wanted))
            });
        if !fits || session.outputs().len() != 1 {
            return Err(Error::format(format!(
                "{FILE} does not take the five inputs of the variant {:?} and give one output; train or get it anew",
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
                    "{FILE} answers {} numbers to {count} boxes; train or get it anew",
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

/// Scores this near to 0 and 1 have the logits of these.
const MARGIN: f32 = 1e-4;

/// The logarithm of the odds of a score.
fn logit(score: f32) -> f32 {
    let score = score.clamp(MARGIN, 1.0 - MARGIN);
    (score / (1.0 - score)).ln()
}

/// A score of which the network says the change; 0 where that is no number.
fn changed_score(score: f32, change: f32) -> f32 {
    let odds = logit(score) + change;
    if odds.is_nan() { 0.0 } else { 1.0 / (1.0 + (-odds).exp()) }
}

/// The variant that a container says.
fn variant_of(manifest: &Manifest) -> Result<NmsVariant> {
    let name = manifest.inputs.get(VARIANT).and_then(|name| name.as_str());
    name.and_then(|name| NmsVariant::from_value(&ParamValue::Text(name.to_owned()))).ok_or_else(|| {
        Error::format(format!("the model's \"inputs\" do not tell its {VARIANT}; train or get it anew"))
    })
}
