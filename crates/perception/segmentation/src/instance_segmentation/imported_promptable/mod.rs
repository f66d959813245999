//! Promptable segmentation by the ONNX files of Segment Anything and its small variants: SAM, MobileSAM, EdgeSAM.
//!
//! Kirillov et al., "Segment Anything", ICCV 2023; Zhang et al., "Faster Segment Anything", 2023; Zhou et al., "EdgeSAM", 2023. An encoder
//! runs once per image, a decoder once per prompt: the points of an object, or a box around it. Which file is which, and the form of the
//! decoder, is recognised from the names and shapes of inputs and outputs.

mod convention;
mod decoder;
mod encoder;
mod mask;
mod params;
mod prompt;

use opendr_engine::data::Image;
use opendr_engine::learner::{Inputs, Learner, Spec};
use opendr_engine::model::Model;
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Device, Error, Pool, Result, ResultExt, Task};
use opendr_inference::TensorView;
use opendr_perception_common::exported_network::{Facts, NetworkKind};

use convention::Convention;
use decoder::{Decoder, PromptScratch};
use encoder::{Encoder, Placed};
use mask::Upsampling;
pub use params::{ImportedPromptableSegmenterParams, MaskSelection};
use prompt::{Prompt, PromptPoint, parse_points};

/// An image, and boxes around objects in it.
#[derive(Debug, Clone, Copy, Inputs)]
pub struct PromptableInputs<'a> {
    /// Image.
    pub image: &'a Image,
    /// Boxes around objects, each of which gets a mask.
    pub detections: Option<&'a BoundingBoxList>,
}

/// An image whose prompts are the points of the parameters.
impl<'a> From<&'a Image> for PromptableInputs<'a> {
    fn from(image: &'a Image) -> Self {
        Self { image, detections: None }
    }
}

/// A loaded promptable segmenter of another tool.
pub struct ImportedPromptableSegmenter {
    params: ImportedPromptableSegmenterParams,
    encoder: Encoder,
    decoder: Decoder,
    scratch: Pool<Scratch>,
}

/// Work memory.
#[derive(Default)]
struct Scratch {
    points: Vec<PromptPoint>,
    prompt: PromptScratch,
    upsampling: Upsampling,
}

impl Learner for ImportedPromptableSegmenter {
    const SPEC: Spec = Spec::new("promptable_segmenter", Task::InstanceSegmentation)
        .class("ImportedPromptableSegmenterLearner")
        .about("Runs Segment Anything and its small variants, exported to ONNX by another tool, on points or the boxes of a detector.")
        .recognises_network(|onnx| NetworkKind::PromptableSegmenter.recognises(onnx));
    type Params = ImportedPromptableSegmenterParams;
    type Input<'a> = PromptableInputs<'a>;
    type Target = BoundingBoxList;
    type State = ();

    fn load(model: &Model, mut params: ImportedPromptableSegmenterParams, device: Device) -> Result<Self> {
        parse_points(&params.points, &mut Vec::new())?;
        let Networks { encoder, decoder, convention } = Networks::of(model)?;
        if params.multimask == MaskSelection::Single && !convention.has_single {
            return Err(Error::unsupported(
                "the decoder has no single mask for unambiguous prompts; set multimask to auto or best",
            ));
        }
        let Network { onnx, facts } = &encoder;
        let opened = Encoder::open(onnx, facts, &mut params.levels, params.size, device);
        let opened = opened.context(|| "the encoder")?;
        let decoder = Decoder::open(&decoder.onnx, &decoder.facts, facts, convention, device);
        let decoder = decoder.context(|| "the decoder")?;
        Ok(Self { params, encoder: opened, decoder, scratch: Pool::default() })
    }

    fn params(&self) -> &ImportedPromptableSegmenterParams {
        &self.params
    }

    fn params_mut(&mut self) -> &mut ImportedPromptableSegmenterParams {
        &mut self.params
    }

    fn infer_into(&self, _: &mut (), input: PromptableInputs<'_>, found: &mut BoundingBoxList) -> Result<()> {
        let Scratch { points, prompt, upsampling } = &mut *self.scratch.take();
        parse_points(&self.params.points, points)?;
        let boxes = match input.detections {
            None if points.is_empty() => {
                return Err(Error::invalid_input(
                    "nothing says what to segment; give boxes (the input detections, e.g. of a detector) or set points, such as 320,240",
                ));
            }
            Some(_) if !self.decoder.convention.takes_boxes => {
                return Err(Error::unsupported(
                    "a decoder exported from transformers takes points, not boxes; set points, or export the decoder with \
                     scripts/export_onnx_model.py of segment-anything",
                ));
            }
            given => given.map_or(&[][..], |given| &given.boxes),
        };
        found.boxes.clear();
        found.classes.clone_from(input.detections.map_or(&Default::default(), |given| &given.classes));
        if points.is_empty() && boxes.is_empty() {
            return Ok(());
        }
        self.encoder.run(input.image.view(), |embeddings, placed| {
            let encoded = Encoded { embeddings, placed };
            if !points.is_empty() {
                let whole = self.decode(encoded, &Prompt::Points(points), prompt, upsampling)?;
                found.boxes.extend(whole);
            }
            for given in boxes {
                let Some(corners) = Prompt::of_box(given) else { continue };
                let Some(masked) = self.decode(encoded, &corners, prompt, upsampling)? else { continue };
                let BoundingBox { confidence, segment, .. } = masked;
                found.boxes.push(BoundingBox { confidence, segment, ..given.clone() });
            }
            Ok(())
        })
    }
}

/// An image that the encoder has encoded.
#[derive(Clone, Copy)]
struct Encoded<'a> {
    embeddings: &'a [TensorView<'a>],
    placed: &'a Placed,
}

impl ImportedPromptableSegmenter {
    /// Returns the mask of a prompt and the box around it; `None` for a mask without pixels or with too low a predicted IoU.
    fn decode(
        &self,
        Encoded { embeddings, placed }: Encoded<'_>,
        prompt: &Prompt<'_>,
        scratch: &mut PromptScratch,
        upsampling: &mut Upsampling,
    ) -> Result<Option<BoundingBox>> {
        let ImportedPromptableSegmenterParams { multimask, quality_threshold, mask_threshold, .. } =
            self.params;
        let mut found = None;
        self.decoder.run(embeddings, placed, prompt, multimask, scratch, |logits| {
            let confidence = logits.iou.clamp(0.0, 1.0);
            if confidence >= quality_threshold {
                let mask = upsampling.mask(logits.values, placed.sides(logits.size), mask_threshold)?;
                found = mask.map(|mask| BoundingBox {
                    segment: Some(Box::new(mask.segment)),
                    ..BoundingBox::from_corners(0, mask.corners, confidence)
                });
            }
            Ok(())
        })?;
        Ok(found)
    }
}

/// A network of a model.
struct Network {
    onnx: Vec<u8>,
    facts: Facts,
}

/// The two networks of a model.
struct Networks {
    encoder: Network,
    decoder: Network,
    convention: &'static Convention,
}

impl Networks {
    /// Reads the networks of a model and finds out which is which.
    ///
    /// # Errors
    /// `Unsupported` unless there are an encoder and a decoder.
    fn of(model: &Model) -> Result<Self> {
        let names = model.manifest().files.iter().map(|file| file.name.as_str());
        let mut networks = Vec::new();
        for name in names.filter(|name| name.to_lowercase().ends_with(".onnx")) {
            let onnx = model.file(name)?;
            networks.push(Network { facts: Facts::declared(&onnx)?, onnx });
        }
        let known = networks.iter().enumerate();
        let decoder = known.clone().find_map(|(at, network)| Some((at, Convention::of(&network.facts)?)));
        match (decoder, networks.len()) {
            (Some((at, convention)), 2) => {
                let decoder = networks.swap_remove(at);
                let encoder = networks.swap_remove(0);
                Ok(Self { encoder, decoder, convention })
            }
            (Some(_), count) => Err(Error::unsupported(format!(
                "the model has {count} networks, not the encoder of images and the decoder of prompts; give both: \
                 opendr import promptable_segmenter encoder.onnx decoder.onnx --out FOLDER"
            ))),
            (None, count) => {
                let found = networks.iter().map(|network| network.facts.describe());
                Err(Error::unsupported(format!(
                    "none of the {count} networks is the decoder of prompts of a known tool ({}); give an encoder and such a decoder: \
                     opendr import promptable_segmenter encoder.onnx decoder.onnx --out FOLDER (found: {})",
                    Convention::describe_all(),
                    found.collect::<Vec<_>>().join(" | ")
                )))
            }
        }
    }
}
