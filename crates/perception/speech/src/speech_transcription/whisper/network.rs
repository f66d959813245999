//! Encoder and decoder networks, and the decoder's key-value cache.

use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorView};

use super::spectrogram::WINDOW;

/// Maximum number of tokens of the decoder's context.
pub const CONTEXT: usize = 448;
/// Value added to the attention scores of masked positions.
const MASKED: f32 = -1e9;
/// Upper bound of sizes; above those of the largest Whisper.
const MOST: usize = 1 << 20;

const ENCODER: &str = "encoder.onnx";
const DECODER: &str = "decoder.onnx";

/// Encoder and decoder, as written by `opendr-import`.
pub struct Network {
    encoder: Session,
    decoder: Session,
    /// Number of mel bands of the spectrogram.
    pub bands: usize,
    /// Number of tokens of the vocabulary.
    pub tokens: usize,
    width: usize,
}

/// Encoder output of a window: cross-attention keys and values for each layer of the decoder.
#[derive(Debug, Default)]
pub struct EncoderOutput {
    cross: Vec<Vec<f32>>,
}

/// Self-attention keys and values of the tokens so far, for each layer of the decoder. The first row is masked, so that no
/// tensor is empty.
#[derive(Debug, Clone, Default)]
pub struct KeyValueCache {
    own: Vec<Vec<f32>>,
    rows: usize,
}

impl KeyValueCache {
    /// Returns the number of cached tokens.
    pub fn len(&self) -> usize {
        self.rows.saturating_sub(1)
    }
}

impl Network {
    /// Loads the networks of a container.
    ///
    /// # Errors
    /// `Format` when the container does not hold the two networks of a Whisper.
    pub fn load(model: &Model, device: Device) -> Result<Self> {
        let encoder = Session::open(&model.file(ENCODER)?, device)?;
        let decoder = Session::open(&model.file(DECODER)?, device)?;
        let wrong = |what: &str| Error::format(format!("{what}; import the Whisper model again"));
        let &[_, Some(bands), Some(WINDOW)] =
            encoder.inputs().first().map_or(&[][..], |input| &input.dims[..])
        else {
            return Err(wrong("the input of encoder.onnx is not a spectrogram of 30 s"));
        };
        let layers = encoder.outputs().len() / 2;
        let names = decoder.inputs().iter().map(|input| input.name.as_str());
        let pairs = |first: &'static str, second: &'static str| {
            (0..layers).flat_map(move |layer| [first, second].map(|name| format!("{name}_{layer}")))
        };
        let expected = ["tokens", "positions", "mask"].map(str::to_owned).into_iter();
        let crosses = || pairs("cross_key", "cross_value");
        if layers == 0
            || !names.eq(expected.chain(pairs("key", "value")).chain(crosses()))
            || !encoder.outputs().iter().map(|output| output.name.as_str()).eq(crosses())
            || decoder.outputs().len() != 1 + 2 * layers
        {
            return Err(wrong("encoder.onnx and decoder.onnx do not match"));
        }
        let sizes = (decoder.outputs().first(), decoder.outputs().get(1));
        let (Some(&[_, Some(tokens)]), Some(&[_, Some(width)])) =
            (sizes.0.map(|logits| &logits.dims[..]), sizes.1.map(|keys| &keys.dims[..]))
        else {
            return Err(wrong("decoder.onnx does not state the size of its vocabulary"));
        };
        if [bands, tokens, width].iter().any(|size| !(1..=MOST).contains(size)) {
            return Err(wrong("a size of the networks is out of range"));
        }
        Ok(Self { encoder, decoder, bands, tokens, width })
    }

    /// Encodes a window, `[bands, WINDOW]`.
    ///
    /// # Errors
    /// The errors of the runtime.
    pub fn encode(&self, window: &[f32], encoded: &mut EncoderOutput) -> Result<()> {
        let input = TensorView::new(&[1, self.bands, WINDOW], window)?;
        encoded.cross.resize_with(self.encoder.outputs().len(), Vec::new);
        self.encoder.run(&[input], |outputs| {
            for (output, values) in outputs.iter().zip(&mut encoded.cross) {
                values.clear();
                values.extend_from_slice(output.values()?);
            }
            Ok(())
        })
    }

    /// Clears the cache.
    pub fn clear_cache(&self, cache: &mut KeyValueCache) {
        cache.own.resize_with(self.encoder.outputs().len(), Vec::new);
        for values in &mut cache.own {
            values.clear();
            values.resize(self.width, 0.0);
        }
        cache.rows = 1;
    }

    /// Decodes `tokens` and replaces `logits` by those of the next token.
    ///
    /// # Errors
    /// `Internal` for more tokens than [`CONTEXT`]; the errors of the runtime.
    pub fn decode(
        &self,
        encoded: &EncoderOutput,
        cache: &mut KeyValueCache,
        tokens: &[u32],
        logits: &mut Vec<f32>,
    ) -> Result<()> {
        let (count, rows, known) = (tokens.len(), cache.rows, cache.len());
        if count == 0 || known + count > CONTEXT {
            return Err(Error::internal(format!(
                "{count} tokens after {known} exceed Whisper's context of {CONTEXT}"
            )));
        }
        let tokens: Vec<i64> = tokens.iter().map(|token| i64::from(*token)).collect();
        let positions: Vec<i64> = (known..known + count).map(|place| place as i64).collect();
        let attended = rows + count;
        let allowed = |at: usize| (1..=rows + at / attended).contains(&(at % attended));
        let mask: Vec<f32> = (0..count * attended).map(|at| if allowed(at) { 0.0 } else { MASKED }).collect();
        let mut inputs = vec![
            TensorView::new(&[count], &tokens[..])?,
            TensorView::new(&[count], &positions[..])?,
            TensorView::new(&[count, attended], &mask[..])?,
        ];
        for values in &cache.own {
            inputs.push(TensorView::new(&[rows, self.width], &values[..])?);
        }
        let shapes = self.encoder.outputs().iter().map(|output| &output.dims);
        for (values, dims) in encoded.cross.iter().zip(shapes) {
            let mut shape = [0; 3];
            shape.iter_mut().zip(dims).for_each(|(size, dim)| *size = dim.unwrap_or_default());
            inputs.push(TensorView::new(&shape, &values[..])?);
        }
        // The inputs borrow the cache, so the new keys and values are collected first.
        let mut fresh: Vec<Vec<f32>> = Vec::new();
        self.decoder.run(&inputs, |outputs| {
            let Some((own, new)) = outputs.split_first() else { return Ok(()) };
            logits.clear();
            logits.extend_from_slice(own.values()?);
            for output in new {
                fresh.push(output.values::<f32>()?.to_vec());
            }
            Ok(())
        })?;
        for (values, new) in cache.own.iter_mut().zip(fresh) {
            values.extend(new);
        }
        cache.rows += count;
        Ok(())
    }
}
