//! The two networks, and what the decoder remembers.

use opendr_engine::model::Model;
use opendr_engine::{Device, Error, Result};
use opendr_inference::{Session, TensorView};

use super::spectrogram::WINDOW;

/// Tokens that the decoder can attend to.
pub const CONTEXT: usize = 448;
/// Added to the score of what may not be attended to.
const MASKED: f32 = -1e9;
/// More than the largest Whisper has.
const MOST: usize = 1 << 20;

const ENCODER: &str = "encoder.onnx";
const DECODER: &str = "decoder.onnx";

/// Encoder and decoder, as `opendr-import` writes them.
pub struct Network {
    encoder: Session,
    decoder: Session,
    /// Bands of the spectrogram.
    pub bands: usize,
    /// Tokens that there are.
    pub tokens: usize,
    width: usize,
}

/// What the encoder made of a window: keys and values for each layer of the decoder.
#[derive(Debug, Default)]
pub struct Heard {
    cross: Vec<Vec<f32>>,
}

/// What the decoder remembers of the tokens so far: keys and values for each layer. The first row is masked: no runtime
/// need take empty tensors.
#[derive(Debug, Clone, Default)]
pub struct Memory {
    own: Vec<Vec<f32>>,
    rows: usize,
}

impl Memory {
    /// How many tokens it remembers.
    pub fn len(&self) -> usize {
        self.rows.saturating_sub(1)
    }
}

impl Network {
    /// # Errors
    /// `Format` when the container does not hold the two networks of a Whisper.
    pub fn load(model: &Model, device: Device) -> Result<Self> {
        let encoder = Session::open(&model.file(ENCODER)?, device)?;
        let decoder = Session::open(&model.file(DECODER)?, device)?;
        let wrong = |what: &str| Error::format(format!("{what}; import the Whisper anew"));
        let &[_, Some(bands), Some(WINDOW)] =
            encoder.inputs().first().map_or(&[][..], |input| &input.dims[..])
        else {
            return Err(wrong("encoder.onnx takes no spectrogram of 30 s"));
        };
        let layers = encoder.outputs().len() / 2;
        let names = decoder.inputs().iter().map(|input| input.name.as_str());
        let pairs = |first: &'static str, second: &'static str| {
            (0..layers).flat_map(move |layer| [first, second].map(|name| format!("{name}_{layer}")))
        };
        let wanted = ["tokens", "positions", "mask"].map(str::to_owned).into_iter();
        let crosses = || pairs("cross_key", "cross_value");
        if layers == 0
            || !names.eq(wanted.chain(pairs("key", "value")).chain(crosses()))
            || !encoder.outputs().iter().map(|output| output.name.as_str()).eq(crosses())
            || decoder.outputs().len() != 1 + 2 * layers
        {
            return Err(wrong("encoder.onnx and decoder.onnx do not fit each other"));
        }
        let sizes = (decoder.outputs().first(), decoder.outputs().get(1));
        let (Some(&[_, Some(tokens)]), Some(&[_, Some(width)])) =
            (sizes.0.map(|logits| &logits.dims[..]), sizes.1.map(|keys| &keys.dims[..]))
        else {
            return Err(wrong("decoder.onnx does not say how many tokens it tells apart"));
        };
        if [bands, tokens, width].iter().any(|size| !(1..=MOST).contains(size)) {
            return Err(wrong("a size of the networks cannot be"));
        }
        Ok(Self { encoder, decoder, bands, tokens, width })
    }

    /// Hears a window, `[bands, WINDOW]`.
    ///
    /// # Errors
    /// What the runtime meets.
    pub fn listen(&self, window: &[f32], heard: &mut Heard) -> Result<()> {
        let input = TensorView::new(&[1, self.bands, WINDOW], window)?;
        heard.cross.resize_with(self.encoder.outputs().len(), Vec::new);
        self.encoder.run(&[input], |outputs| {
            for (output, values) in outputs.iter().zip(&mut heard.cross) {
                values.clear();
                values.extend_from_slice(output.values()?);
            }
            Ok(())
        })
    }

    /// Forgets all tokens.
    pub fn forget(&self, memory: &mut Memory) {
        memory.own.resize_with(self.encoder.outputs().len(), Vec::new);
        for values in &mut memory.own {
            values.clear();
            values.resize(self.width, 0.0);
        }
        memory.rows = 1;
    }

    /// Reads `tokens` on, and replaces `logits` by those of the token that follows.
    ///
    /// # Errors
    /// `Internal` for more tokens than [`CONTEXT`], else what the runtime meets.
    pub fn read(
        &self,
        heard: &Heard,
        memory: &mut Memory,
        tokens: &[u32],
        logits: &mut Vec<f32>,
    ) -> Result<()> {
        let (count, rows, known) = (tokens.len(), memory.rows, memory.len());
        if count == 0 || known + count > CONTEXT {
            return Err(Error::internal(format!("{count} tokens after {known}: Whisper reads {CONTEXT}")));
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
        for values in &memory.own {
            inputs.push(TensorView::new(&[rows, self.width], &values[..])?);
        }
        let shapes = self.encoder.outputs().iter().map(|output| &output.dims);
        for (values, dims) in heard.cross.iter().zip(shapes) {
            let mut shape = [0; 3];
            shape.iter_mut().zip(dims).for_each(|(size, dim)| *size = dim.unwrap_or_default());
            inputs.push(TensorView::new(&shape, &values[..])?);
        }
        // The views above borrow what is remembered, so what is new waits here.
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
        for (values, new) in memory.own.iter_mut().zip(fresh) {
            values.extend(new);
        }
        memory.rows += count;
        Ok(())
    }
}
