//! Zero-shot image classifier from ONNX files of a network like CLIP (Radford et al., "Learning Transferable Visual Models From Natural
//! Language Supervision", ICML 2021): classes are texts.
//!
//! Image and texts become vectors of one space; the probability of a class is the softmax of scaled cosine similarities. A network of
//! both is divided at load, so that an image runs its own half only; texts run when they change.

mod bicubic;
mod networks;
mod params;
mod prompts;
mod tokenizer;
mod words;

use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::data::{Image, ImageView};
use opendr_engine::learner::{Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{Category, Classes};
use opendr_engine::{Device, Error, Result, ResultExt, Task};
use opendr_perception_common::category_scores::category_from_logits;
use opendr_perception_common::exported_network::{
    ExportedNetwork, Facts, ImageInput, InputColour, InputConvention, InputLevels, InputResize, NetworkKind,
};

use super::cropped_input::settle_input;
use bicubic::Bicubic;
use networks::{Networks, TextNetwork};
pub use params::ImportedZeroShotClassifierParams;
use prompts::Prompts;
use tokenizer::ClipTokenizer;

/// Factor on the similarities of the original CLIP, at which its training limits it.
const LOGIT_SCALE: f32 = 100.0;

/// Input of CLIP.
const CLIP: InputConvention = InputConvention {
    resize: InputResize::Stretch,
    colour: InputColour::Rgb,
    levels: InputLevels::Clip,
    size: 224,
    ..InputConvention::UNKNOWN
};

/// A loaded zero-shot classifier of another tool.
pub struct ImportedZeroShotClassifier {
    params: ImportedZeroShotClassifierParams,
    /// Classes of the model, for parameters without labels.
    classes: Classes,
    network: ExportedNetwork,
    output: usize,
    /// Width and height of the network's input, in pixels.
    size: [usize; 2],
    logit_scale: f32,
    text: TextNetwork,
    tokenizer: ClipTokenizer,
    prompts: Mutex<Option<Arc<Prompts>>>,
}

/// Buffers of one stream.
#[derive(Default)]
pub struct Work {
    bicubic: Bicubic,
    similarities: Vec<f32>,
}

impl Learner for ImportedZeroShotClassifier {
    const SPEC: Spec = Spec::new("zero_shot_classifier", Task::ImageClassification)
        .class("ImportedZeroShotClassifierLearner")
        .about(
            "Classifies images by texts with your own CLIP, exported to ONNX by another tool; no training.",
        )
        .recognises_network(|onnx| NetworkKind::ZeroShotClassifier.recognises(onnx));
    type Params = ImportedZeroShotClassifierParams;
    type Input<'a> = &'a Image;
    type Target = Category;
    type State = Work;

    fn load(model: &Model, mut params: ImportedZeroShotClassifierParams, device: Device) -> Result<Self> {
        let Networks { image: half, text, logit_scale } = Networks::open(model, &params, device)?;
        let tokenizer = networks::tokenizer(model)?;
        let side = params.input.size.or_else(|| side_of(&half.facts)).unwrap_or(CLIP.size);
        let image = ImageInput::find(&half.facts, side)?;
        let known = is_of_clip(&half.facts).then_some(CLIP);
        let input = settle_input(&mut params.input, &mut params.crop, known, &half.facts)?;
        let logit_scale = logit_scale.unwrap_or(LOGIT_SCALE);
        params.logit_scale.get_or_insert(logit_scale);
        let text = TextNetwork::new(text, params.context_length)?;
        params.context_length = Some(text.length);
        let network = ExportedNetwork::new(half.session, image, &input)?;
        if image.is_dynamic {
            let [width, height] = image.size;
            let black = Image::from_rgb8(vec![0; 3 * width * height], width, height)?;
            network.run(black.view(), |_, _| Ok(())).context(|| {
                format!("the network does not take images of {width} x {height} pixels; set size to that of its training")
            })?;
        }
        let learner = Self {
            params,
            classes: model.classes().clone(),
            network,
            output: half.output,
            size: image.size,
            logit_scale,
            text,
            tokenizer,
            prompts: Mutex::default(),
        };
        if !learner.classes().is_empty() {
            learner.prompts()?;
        }
        Ok(learner)
    }

    fn params(&self) -> &ImportedZeroShotClassifierParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImportedZeroShotClassifierParams {
        &mut self.params
    }

    fn classes(&self) -> Classes {
        prompts::classes(&self.params.labels, &self.classes)
    }

    fn infer_into(&self, work: &mut Work, image: &Image, category: &mut Category) -> Result<()> {
        let prompts = self.prompts()?;
        let Work { bicubic, similarities } = work;
        let input: ImageView<'_> = match self.params.input.resize {
            InputResize::Stretch => {
                bicubic.run(image.view(), self.size, self.params.crop.unwrap_or_default())?.view()
            }
            _ => image.view(),
        };
        let scale = self.params.logit_scale.unwrap_or(self.logit_scale);
        self.network.run(input, |outputs, _| {
            let vector = outputs[self.output].values::<f32>()?;
            if vector.len() != prompts.width {
                return Err(Error::format(format!(
                    "vectors of images have {} values and those of texts {}; both networks have to be of one model",
                    vector.len(),
                    prompts.width
                )));
            }
            prompts.similarities(vector, scale, similarities);
            category_from_logits(category, similarities, &prompts.classes)?;
            if !self.params.probabilities {
                category.probabilities.clear();
            }
            Ok(())
        })
    }
}

impl ImportedZeroShotClassifier {
    /// Returns the vectors of the texts; computes them if the texts have changed.
    fn prompts(&self) -> Result<Arc<Prompts>> {
        let mut kept = self.prompts.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(prompts) = kept.as_ref().filter(|prompts| prompts.are_of(&self.params)) {
            return Ok(prompts.clone());
        }
        let prompts = Arc::new(Prompts::new(&self.params, &self.classes, &self.tokenizer, &self.text)?);
        Ok(kept.insert(prompts).clone())
    }
}

/// Returns whether the weights are named as those of CLIP's vision transformer, by transformers or by `open_clip`.
fn is_of_clip(facts: &Facts) -> bool {
    const MODULES: [&str; 4] = [
        "vision_model.embeddings.class_embedding",
        "vision_model.pre_layrnorm.",
        "visual.class_embedding",
        "visual.ln_pre.",
    ];
    MODULES.iter().any(|name| facts.has_weights_of(name))
}

/// Returns the side of the images of a vision transformer of CLIP, from its patches and their number.
fn side_of(facts: &Facts) -> Option<usize> {
    let positions = ["vision_model.embeddings.position_embedding", "visual.positional_embedding"];
    let dims = positions.iter().find_map(|name| facts.weight_dims(name))?;
    // One position is that of the class.
    let patches = usize::try_from(*dims.first()?).ok()?.checked_sub(1)?;
    let across = patches.isqrt();
    facts.patch_side().filter(|_| across * across == patches).map(|patch| patch.saturating_mul(across))
}
