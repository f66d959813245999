//! Sizes of a Whisper.

use opendr_engine::{Error, Result};

use super::weights::WhisperWeights;

/// Features of an attention head, in Whispers of every size.
pub const HEAD: usize = 64;
/// Frames of a spectrogram of 30 s.
pub const FRAMES: usize = 3000;
/// Positions of the encoder: half as many.
pub const PLACES: usize = FRAMES / 2;
/// Maximum context of the decoder, in tokens.
pub const CONTEXT: usize = 448;
/// Limits above the largest Whisper, of 32 layers and width 1280.
const MOST_LAYERS: usize = 128;
const MOST_WIDTH: usize = 1 << 14;

/// Sizes from which those of all weights follow.
pub struct Sizes {
    /// Bands of the mel spectrogram.
    pub bands: usize,
    /// Features of a position.
    pub width: usize,
    /// Features within a block's feed-forward network.
    pub inner: usize,
    pub encoder_layers: usize,
    pub decoder_layers: usize,
    /// Size of the vocabulary.
    pub tokens: usize,
}

impl Sizes {
    /// Reads the sizes from the shapes of the weights.
    ///
    /// # Errors
    /// `Format` for sizes that are not those of a Whisper.
    pub fn of(weights: &dyn WhisperWeights) -> Result<Self> {
        let two = |name: &str| match weights.get(name)?.dims() {
            &[rows, columns, ..] => Ok((rows, columns)),
            dims => {
                Err(Error::format(format!("{name} has the shape {dims:?}, which does not match a Whisper")))
            }
        };
        let (width, bands) = two("encoder.conv1.weight")?;
        let (tokens, _) = two("decoder.embed_tokens.weight")?;
        let (inner, _) = two("encoder.layers.0.fc1.weight")?;
        let (context, _) = two("decoder.embed_positions.weight")?;
        let layers = |side: &str| {
            let has = |layer: &usize| weights.has(&format!("{side}.layers.{layer}.fc1.weight"));
            (0..=MOST_LAYERS).take_while(has).count()
        };
        let sizes = Self {
            bands,
            width,
            inner,
            tokens,
            encoder_layers: layers("encoder"),
            decoder_layers: layers("decoder"),
        };
        let heads = ["encoder", "decoder"]
            .iter()
            .all(|side| weights.heads(side).is_none_or(|heads| heads.checked_mul(HEAD) == Some(width)));
        let layers = [sizes.encoder_layers, sizes.decoder_layers];
        let sound = heads
            && width.is_multiple_of(HEAD)
            && (HEAD..=MOST_WIDTH).contains(&width)
            && layers.iter().all(|count| (1..=MOST_LAYERS).contains(count))
            && context == CONTEXT
            && bands > 0
            && tokens > 0;
        match sound {
            true => Ok(sizes),
            false => Err(Error::format(format!(
                "{bands} bands, width {width}, {layers:?} layers and {context} tokens of context do not match a Whisper"
            ))),
        }
    }
}
