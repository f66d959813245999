//! The networks of images and of texts in a model's files.

use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{ElementType, Session, TensorInfo, TensorView, declared_tensors};
use opendr_onnx::passes::reduce_to_outputs;
use opendr_onnx::{bytes_from_model, model_from_bytes};
use opendr_perception_common::exported_network::{
    Facts, IMAGE_EMBEDDINGS, TEXT_EMBEDDINGS, embedding_output, is_integer,
};

use super::params::ImportedZeroShotClassifierParams;
use super::tokenizer::ClipTokenizer;

/// The network of images, or that of both.
const NETWORK: &str = "model.onnx";
/// The network of texts, if it is another one.
const TEXT: &str = "text.onnx";
/// Output of the similarities of a network of both.
const LOGITS: &str = "logits_per_image";
/// Output of the factor on the similarities, as `open_clip` returns it.
const SCALE: &str = "logit_scale";
/// Number of tokens of a text of CLIP.
const CONTEXT: usize = 77;
/// What a user gives.
const USAGE: &str = "opendr import zero_shot_classifier NETWORK.onnx --part tokenizer=tokenizer.json --out mine, and --part text=TEXT.onnx if \
                     the texts have a network of their own";

/// An opened half of a model.
pub struct Half {
    /// The network.
    pub session: Session,
    /// What it states.
    pub facts: Facts,
    /// Index of the output with the vector.
    pub output: usize,
}

/// The opened networks of a model.
pub struct Networks {
    /// The network of images.
    pub image: Half,
    /// The network of texts.
    pub text: Half,
    /// Factor on the similarities, if the model states it.
    pub logit_scale: Option<f32>,
}

impl Networks {
    /// Opens the networks of a model: of a network of both, each half is a network without what only the other needs.
    ///
    /// # Errors
    /// `Unsupported` for a model without one of the halves, with the parameters to set.
    pub fn open(model: &Model, params: &ImportedZeroShotClassifierParams, device: Device) -> Result<Self> {
        let onnx = model.file(NETWORK)?;
        let facts = Facts::declared(&onnx)?;
        let image = named(&facts, params.image_output.as_deref(), IMAGE_EMBEDDINGS, "image_output")?;
        if has_file(model, TEXT) {
            let text_onnx = model.file(TEXT)?;
            let text_facts = Facts::declared(&text_onnx)?;
            let text = named(&text_facts, params.text_output.as_deref(), TEXT_EMBEDDINGS, "text_output")?;
            let [image, text] = [half(&onnx, &image, device)?, half(&text_onnx, &text, device)?];
            return Ok(Self { image, text, logit_scale: None });
        }
        if params.text_output.is_none() && embedding_output(&facts, TEXT_EMBEDDINGS).is_none() {
            return Err(Error::unsupported(format!(
                "the model has no network of texts; import it with its own: {USAGE} ({})",
                facts.describe()
            )));
        }
        let text = named(&facts, params.text_output.as_deref(), TEXT_EMBEDDINGS, "text_output")?;
        let logit_scale = logit_scale(&onnx, &facts, [&image, &text], device)?;
        let [image, text] = [half(&onnx, &image, device)?, half(&onnx, &text, device)?];
        Ok(Self { image, text, logit_scale })
    }
}

fn has_file(model: &Model, name: &str) -> bool {
    model.manifest().files.iter().any(|file| file.name == name)
}

/// Reads the tokenizer of a model: `tokenizer.json`, or `vocab.json` and `merges.txt`.
///
/// # Errors
/// `NotFound` if the model has neither, otherwise the errors of [`ClipTokenizer`].
pub fn tokenizer(model: &Model) -> Result<ClipTokenizer> {
    if has_file(model, "tokenizer.json") {
        return ClipTokenizer::from_json(&model.file("tokenizer.json")?);
    }
    if has_file(model, "vocab.json") && has_file(model, "merges.txt") {
        return ClipTokenizer::from_vocabulary(&model.file("vocab.json")?, &model.file("merges.txt")?);
    }
    Err(Error::not_found(format!(
        "the model has no tokenizer; import it with its tokenizer.json, or with --part vocab=vocab.json --part merges=merges.txt: {USAGE}"
    )))
}

/// Returns the name of the output with a vector: the given one, else that with one of the `known` names.
fn named(facts: &Facts, given: Option<&str>, known: &[&str], parameter: &str) -> Result<String> {
    let found = match given {
        Some(name) => embedding_output(facts, &[name]),
        None => embedding_output(facts, known),
    };
    let output = found.and_then(|output| facts.outputs.get(output)).map(|output| output.name.clone());
    output.ok_or_else(|| {
        let names = given.map_or_else(|| known.join(", "), str::to_owned);
        Error::unsupported(format!(
            "no output of the network is a vector [1, values] named {names}; set {parameter} to the output that texts and images are compared \
             by ({})",
            facts.describe()
        ))
    })
}

/// Returns the ONNX file of a network with one output only, with `values` as inputs.
fn reduced(onnx: &[u8], values: &[&str], output: &str) -> Result<Vec<u8>> {
    let mut model = model_from_bytes(onnx)?;
    if let Some(graph) = &mut model.graph {
        reduce_to_outputs(graph, values, &[output]);
    }
    Ok(bytes_from_model(&model))
}

fn half(onnx: &[u8], output: &str, device: Device) -> Result<Half> {
    let (session, facts) = Facts::open_network(&reduced(onnx, &[], output)?, device)?;
    Ok(Half { session, facts, output: 0 })
}

/// Reads the factor on the similarities from a network of both: its own output, or the similarity of two equal vectors.
///
/// # Errors
/// `Unsupported` for similarities with a bias, as those of SigLIP.
fn logit_scale(onnx: &[u8], facts: &Facts, vectors: [&str; 2], device: Device) -> Result<Option<f32>> {
    let has = |name: &str| facts.outputs.iter().any(|output| output.name == name);
    if has(SCALE) {
        let rest = reduced(onnx, &[], SCALE)?;
        return match declared_tensors(&rest)? {
            [inputs, _] if inputs.is_empty() => first_value(&Session::open(&rest, device)?, &[]).map(Some),
            _ => Ok(None),
        };
    }
    if !has(LOGITS) {
        return Ok(None);
    }
    let rest = reduced(onnx, &vectors, LOGITS)?;
    let [inputs, _] = declared_tensors(&rest)?;
    let widths: Option<Vec<usize>> = inputs.iter().map(|input| *input.dims.last()?).collect();
    let is_cut = inputs.len() == 2 && inputs.iter().all(|input| vectors.contains(&input.name.as_str()));
    let Some([width, other]) = widths.as_deref().filter(|_| is_cut).and_then(|widths| widths.as_array())
    else {
        return Ok(None);
    };
    if width != other {
        return Err(Error::format(format!("vectors of texts and images have {width} and {other} values")));
    }
    let session = Session::open(&rest, device)?;
    let mut vector = vec![0.0; *width];
    let mut similarity = |value: f32| {
        let unit: Vec<f32> = (0..*width).map(|place| if place == 0 { 1.0 } else { 0.0 }).collect();
        if let Some(first) = vector.first_mut() {
            *first = value;
        }
        let shape = [1, *width];
        first_value(&session, &[TensorView::new(&shape, &unit)?, TensorView::new(&shape, &vector)?])
    };
    let (equal, opposite) = (similarity(1.0)?, similarity(-1.0)?);
    if (equal + opposite).abs() > 1e-3 * equal.abs() {
        let bias = (equal + opposite) / 2.0;
        return Err(Error::unsupported(format!(
            "the similarities of the network have a bias of {bias}, as those of SigLIP, whose probabilities and tokenizer are not CLIP's"
        )));
    }
    Ok(Some(equal))
}

fn first_value(session: &Session, inputs: &[TensorView<'_>]) -> Result<f32> {
    let mut value = None;
    session.run(inputs, |outputs| {
        value = outputs
            .first()
            .map(TensorView::values::<f32>)
            .transpose()?
            .and_then(|values| values.first().copied());
        Ok(())
    })?;
    value.filter(|value| value.is_finite()).ok_or_else(|| {
        Error::format(
            "the network's factor on similarities is not a number; set logit_scale in a network without it",
        )
    })
}

/// The network of texts.
pub struct TextNetwork {
    half: Half,
    /// The attention mask, if it is an input.
    mask: Option<usize>,
    /// Token of the padding; `None` for that of the end.
    padding: Option<u32>,
    /// Number of tokens.
    pub length: usize,
}

impl TextNetwork {
    /// Finds the inputs of the network; texts have `length` tokens, unless the network states their number.
    ///
    /// # Errors
    /// `Unsupported` for inputs other than tokens and an attention mask.
    pub fn new(half: Half, length: Option<usize>) -> Result<Self> {
        let inputs = &half.facts.inputs;
        let is_row = |input: &TensorInfo| {
            matches!(input.dims[..], [batch, _] if batch.is_none_or(|batch| batch == 1)) && is_integer(input)
        };
        let mask = inputs.iter().position(|input| input.name == "attention_mask");
        let tokens = inputs.iter().enumerate().find(|(index, _)| mask != Some(*index));
        let fits = inputs.len() == 1 + usize::from(mask.is_some()) && inputs.iter().all(is_row);
        let Some((_, input)) = tokens.filter(|_| fits) else {
            return Err(Error::unsupported(format!(
                "the inputs of the network of texts are not tokens [1, tokens], and perhaps an attention_mask; export it for one text ({})",
                half.facts.describe()
            )));
        };
        let fixed = input.dims.get(1).copied().flatten();
        if let (Some(given), Some(fixed)) = (length, fixed)
            && given != fixed
        {
            return Err(Error::invalid_param(format!(
                "context_length = {given}, but texts of the network have {fixed} tokens; leave it out"
            )));
        }
        let stated = half.facts.weight_dims("text_model.embeddings.position_embedding");
        let stated = stated.and_then(|dims| usize::try_from(*dims.first()?).ok());
        let length = fixed.or(length).or(stated).unwrap_or(CONTEXT);
        // Other packages than transformers pad with token 0.
        let padding = (input.name != "input_ids").then_some(0);
        Ok(Self { mask, padding, length, half })
    }

    /// Appends the vector of a text to `vectors`.
    ///
    /// # Errors
    /// `InvalidParam` for a text that has no tokens of CLIP; the errors of the network.
    pub fn embed(&self, tokenizer: &ClipTokenizer, text: &str, vectors: &mut Vec<f32>) -> Result<()> {
        let mut tokens: Vec<i64> = tokenizer.tokens(text, self.length)?.into_iter().map(i64::from).collect();
        let mut mask = vec![1; tokens.len()];
        mask.resize(self.length, 0);
        tokens.resize(self.length, self.padding.unwrap_or(tokenizer.end).into());
        let (shape, inputs) = ([1, self.length], &self.half.facts.inputs);
        let narrow = |values: &[i64]| values.iter().map(|value| *value as i32).collect::<Vec<_>>();
        let (narrow_tokens, narrow_mask) = (narrow(&tokens), narrow(&mask));
        let view = |index: usize| {
            let is_mask = self.mask == Some(index);
            match inputs.get(index).map(|input| input.element_type) {
                Some(ElementType::I32) => {
                    TensorView::new(&shape, if is_mask { &narrow_mask } else { &narrow_tokens })
                }
                _ => TensorView::new(&shape, if is_mask { &mask } else { &tokens }),
            }
        };
        let views = (0..inputs.len()).map(view).collect::<Result<Vec<_>>>()?;
        self.half.session.run(&views, |outputs| {
            let output = outputs.get(self.half.output).map(TensorView::values::<f32>).transpose()?;
            vectors.extend_from_slice(output.unwrap_or_default());
            Ok(())
        })
    }
}
