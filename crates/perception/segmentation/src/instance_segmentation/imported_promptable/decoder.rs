//! The decoder of prompts.

use opendr_engine::{Device, Error, Result};
use opendr_inference::{ElementType, Session, TensorInfo, TensorView};
use opendr_perception_common::exported_network::{Facts, open_outputs};

use super::convention::{Convention, IMAGE_EMBEDDINGS, Role};
use super::encoder::Placed;
use super::params::MaskSelection;
use super::prompt::{NO_POINT, Prompt, PromptPoint};

/// Maximum number of inputs of a decoder.
const MAX_INPUTS: usize = 6;
/// Maximum number of logits of a mask.
const MAX_LOGITS: usize = 1 << 24;

/// The decoder, with the roles of its inputs in their order.
pub(super) struct Decoder {
    session: Session,
    pub(super) convention: &'static Convention,
    inputs: Vec<Input>,
    /// Indices of the outputs of predicted IoUs and of logits.
    outputs: [usize; 2],
}

/// What an input receives.
enum Input {
    /// An output of the encoder.
    Embedding(usize),
    Points,
    FloatLabels,
    IntegerLabels,
    /// A tensor that does not depend on the prompt.
    Constant(Vec<usize>, Vec<f32>),
}

/// Points of a prompt as inputs of a network.
#[derive(Default)]
pub(super) struct PromptScratch {
    positions: Vec<f32>,
    float_labels: Vec<f32>,
    labels: Vec<i64>,
}

/// The mask of a prompt.
pub(super) struct Logits<'a> {
    pub(super) values: &'a [f32],
    /// Numbers of columns and rows.
    pub(super) size: [usize; 2],
    /// Predicted IoU with the object.
    pub(super) iou: f32,
}

impl Decoder {
    /// Opens a decoder that takes the outputs of an encoder.
    ///
    /// # Errors
    /// `Unsupported` when the encoder has no such outputs or they have other shapes.
    pub(super) fn open(
        onnx: &[u8],
        facts: &Facts,
        encoder: &Facts,
        convention: &'static Convention,
        device: Device,
    ) -> Result<Self> {
        let session = open_outputs(onnx, &[convention.scores, convention.masks], device)?;
        let inputs = session.inputs().iter().map(|input| Input::of(input, convention, encoder));
        let inputs: Vec<_> = inputs.collect::<Option<_>>().ok_or_else(|| {
            Error::unsupported(format!(
                "encoder and decoder do not match; import those of one model (encoder: {}; decoder: {})",
                encoder.describe(),
                facts.describe()
            ))
        })?;
        let outputs = [session.output_index(convention.scores)?, session.output_index(convention.masks)?];
        Ok(Self { session, convention, inputs, outputs })
    }

    /// Decodes a prompt and passes the mask that is selected to `sink`.
    ///
    /// # Errors
    /// `Format` when the outputs have other shapes than those of masks, and the errors of the runtime and of `sink`.
    pub(super) fn run(
        &self,
        embeddings: &[TensorView<'_>],
        placed: &Placed,
        prompt: &Prompt<'_>,
        selection: MaskSelection,
        scratch: &mut PromptScratch,
        mut sink: impl FnMut(&Logits<'_>) -> Result<()>,
    ) -> Result<()> {
        scratch.fill(placed, prompt, self.convention.pads);
        let (count, first) = (scratch.labels.len(), 2 - self.convention.outer);
        let (dims, label_dims) = ([1, 1, count, 2], [1, 1, count]);
        let points = TensorView::new(&dims[first..], &scratch.positions[..])?;
        let mut views = [points; MAX_INPUTS];
        for (view, input) in views.iter_mut().zip(&self.inputs) {
            *view = match input {
                Input::Embedding(output) => embeddings[*output],
                Input::Points => points,
                Input::FloatLabels => TensorView::new(&label_dims[first..], &scratch.float_labels[..])?,
                Input::IntegerLabels => TensorView::new(&label_dims[first..], &scratch.labels[..])?,
                Input::Constant(dims, values) => TensorView::new(dims, &values[..])?,
            };
        }
        self.session.run(&views[..self.inputs.len()], |outputs| {
            let [scores, masks] = self.outputs.map(|output| outputs[output]);
            let wrong = || {
                Error::format(format!(
                    "the decoder returned predicted IoUs {scores:?} and masks {masks:?}, not one of each for every mask; export it again"
                ))
            };
            let &[.., height, width] = masks.shape() else { return Err(wrong()) };
            let (scores, logits) = (scores.values::<f32>()?, masks.values::<f32>()?);
            let pixels = height.saturating_mul(width);
            let is_one_each = Some(logits.len()) == scores.len().checked_mul(pixels);
            if !is_one_each || scores.is_empty() || !(1..=MAX_LOGITS).contains(&pixels) {
                return Err(wrong());
            }
            let chosen = select(scores, prompt, selection, self.convention.has_single);
            let values = &logits[chosen * pixels..(chosen + 1) * pixels];
            sink(&Logits { values, size: [width, height], iou: scores[chosen] })
        })
    }
}

impl Input {
    /// Returns what an input receives; `None` for one that does not fit the encoder.
    fn of(input: &TensorInfo, convention: &Convention, encoder: &Facts) -> Option<Self> {
        Some(match convention.role(&input.name)? {
            Role::Embedding => Self::Embedding(embedding(input, encoder)?),
            Role::Points => Self::Points,
            Role::Labels if input.element_type == ElementType::I64 => Self::IntegerLabels,
            Role::Labels => Self::FloatLabels,
            Role::Mask | Role::HasMask | Role::ImageSize => {
                let dims: Vec<usize> = input.dims.iter().map(|dim| dim.unwrap_or(1)).collect();
                let count = dims.iter().try_fold(1_usize, |count, dim| count.checked_mul(*dim))?;
                // An image of one pixel, in case that its mask is computed after all.
                let value = if convention.role(&input.name) == Some(Role::ImageSize) { 1.0 } else { 0.0 };
                let values = (count <= MAX_LOGITS).then(|| vec![value; count])?;
                Self::Constant(dims, values)
            }
        })
    }
}

/// Returns the output of the encoder that an input receives: the one with its name; embeddings of the image may be the only one.
fn embedding(input: &TensorInfo, encoder: &Facts) -> Option<usize> {
    let named = encoder.outputs.iter().position(|output| output.name == input.name);
    let only = || encoder.only_output(|_| input.name == IMAGE_EMBEDDINGS);
    let output = named.or_else(only)?;
    let TensorInfo { dims, element_type, .. } = &encoder.outputs[output];
    let is_same = |(one, other): (&Option<usize>, &Option<usize>)| {
        one.zip(*other).is_none_or(|(one, other)| one == other)
    };
    let fits = *element_type == ElementType::F32
        && dims.len() == input.dims.len()
        && dims.iter().zip(&input.dims).all(is_same);
    fits.then_some(output)
}

impl PromptScratch {
    fn fill(&mut self, placed: &Placed, prompt: &Prompt<'_>, pads: bool) {
        let Self { positions, float_labels, labels } = self;
        positions.clear();
        labels.clear();
        for PromptPoint { position, label } in prompt.points() {
            positions.extend(placed.input_from_image(*position));
            labels.push(*label);
        }
        if pads && matches!(prompt, Prompt::Points(_)) {
            positions.extend([0.0; 2]);
            labels.push(NO_POINT);
        }
        float_labels.clear();
        float_labels.extend(labels.iter().map(|label| *label as f32));
    }
}

/// Returns the index of the mask of a prompt.
fn select(scores: &[f32], prompt: &Prompt<'_>, selection: MaskSelection, has_single: bool) -> usize {
    let several = usize::from(has_single && scores.len() > 1);
    let is_single = match selection {
        MaskSelection::Auto => has_single && !prompt.is_ambiguous(),
        MaskSelection::Best => false,
        MaskSelection::Single => true,
    };
    if is_single {
        return 0;
    }
    let best =
        scores.iter().enumerate().skip(several).fold((several, f32::NEG_INFINITY), |best, (at, score)| {
            if *score > best.1 { (at, *score) } else { best }
        });
    best.0
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn masks_are_selected() {
        let point = PromptPoint { position: [0.0; 2], label: 1 };
        let [one, several, corners] =
            [Prompt::Points(&[point]), Prompt::Points(&[point; 2]), Prompt::Box([point; 2])];
        let scores = [0.9, 0.2, f32::NAN, 0.7];
        let chosen = |prompt, selection, has_single| select(&scores, prompt, selection, has_single);
        assert_eq!(chosen(&one, MaskSelection::Auto, true), 3);
        assert_eq!(chosen(&several, MaskSelection::Auto, true), 0);
        assert_eq!(chosen(&corners, MaskSelection::Auto, true), 0);
        assert_eq!(chosen(&corners, MaskSelection::Best, true), 3);
        assert_eq!(chosen(&one, MaskSelection::Single, true), 0);
        assert_eq!(chosen(&several, MaskSelection::Auto, false), 0);
        assert_eq!(select(&[0.1, 0.2], &several, MaskSelection::Auto, false), 1);
        assert_eq!(select(&[0.4], &one, MaskSelection::Auto, true), 0);
        assert_eq!(select(&[f32::NAN; 4], &one, MaskSelection::Auto, true), 1);
    }
}
