//! Audio in RIFF WAVE files: PCM of 8 to 32 bits, floats, A-law and mu-law.

use std::fs::File;
use std::io::Read;
use std::path::Path;

use opendr_engine::data::Audio;
use opendr_engine::{Error, Result, ResultExt};

/// Largest size of a file in bytes: an hour of stereo at 44.1 kHz and 16 bits takes 635 MB.
const MAX_BYTES: u64 = 1 << 30;
const PCM: u16 = 1;
const FLOAT: u16 = 3;
const A_LAW: u16 = 6;
const MU_LAW: u16 = 7;
const EXTENSIBLE: u16 = 0xfffe;
/// Length that a writer to a pipe states, since the length is unknown in advance.
const UNKNOWN_LENGTH: u32 = u32::MAX;

/// Encoding of the samples of a WAVE file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[non_exhaustive]
pub enum WavEncoding {
    /// Unsigned 8-bit integers.
    Pcm8,
    /// Signed 16-bit integers, the most common encoding of data sets.
    Pcm16,
    /// Signed 24-bit integers.
    Pcm24,
    /// Signed 32-bit integers.
    Pcm32,
    /// 32-bit floats.
    Float32,
    /// 64-bit floats.
    Float64,
    /// ITU-T G.711 A-law.
    ALaw,
    /// ITU-T G.711 mu-law.
    MuLaw,
}

impl WavEncoding {
    const fn bytes(self) -> usize {
        match self {
            Self::Pcm8 | Self::ALaw | Self::MuLaw => 1,
            Self::Pcm16 => 2,
            Self::Pcm24 => 3,
            Self::Pcm32 | Self::Float32 => 4,
            Self::Float64 => 8,
        }
    }

    const fn tag(self) -> u16 {
        match self {
            Self::Pcm8 | Self::Pcm16 | Self::Pcm24 | Self::Pcm32 => PCM,
            Self::Float32 | Self::Float64 => FLOAT,
            Self::ALaw => A_LAW,
            Self::MuLaw => MU_LAW,
        }
    }

    fn from_tag(tag: u16, bits: u16) -> Result<Self> {
        Ok(match (tag, bits) {
            (PCM, 8) => Self::Pcm8,
            (PCM, 16) => Self::Pcm16,
            (PCM, 24) => Self::Pcm24,
            (PCM, 32) => Self::Pcm32,
            (FLOAT, 32) => Self::Float32,
            (FLOAT, 64) => Self::Float64,
            (A_LAW, 8) => Self::ALaw,
            (MU_LAW, 8) => Self::MuLaw,
            _ => {
                return Err(Error::unsupported(format!(
                    "format {tag} with {bits} bits is not supported; convert the audio to 16-bit PCM"
                )));
            }
        })
    }

    /// Decodes one sample to [-1, 1].
    fn sample(self, bytes: &[u8]) -> f32 {
        match (self, bytes) {
            (Self::Pcm8, [byte]) => (f32::from(*byte) - 128.0) / 128.0,
            (Self::Pcm16, [a, b]) => f32::from(i16::from_le_bytes([*a, *b])) / 32768.0,
            // The bytes are placed in the upper three bytes, so that the sign is in its place.
            (Self::Pcm24, [a, b, c]) => (i32::from_le_bytes([0, *a, *b, *c]) >> 8) as f32 / 8_388_608.0,
            (Self::Pcm32, [a, b, c, d]) => {
                (f64::from(i32::from_le_bytes([*a, *b, *c, *d])) / 2_147_483_648.0) as f32
            }
            (Self::Float32, [a, b, c, d]) => f32::from_le_bytes([*a, *b, *c, *d]),
            (Self::Float64, bytes) => bytes.try_into().map_or(f32::NAN, |all| f64::from_le_bytes(all) as f32),
            (Self::ALaw, [byte]) => f32::from(pcm_from_a_law(*byte)) / 32768.0,
            (Self::MuLaw, [byte]) => f32::from(pcm_from_mu_law(*byte)) / 32768.0,
            _ => f32::NAN,
        }
    }
}

fn pcm_from_a_law(byte: u8) -> i16 {
    let byte = byte ^ 0x55;
    let (exponent, mantissa) = (i16::from(byte >> 4 & 7), i16::from(byte & 15) << 4);
    let size = if exponent == 0 { mantissa + 8 } else { (mantissa + 0x108) << (exponent - 1) };
    if byte & 0x80 == 0 { -size } else { size }
}

fn pcm_from_mu_law(byte: u8) -> i16 {
    let byte = !byte;
    let size = (((i16::from(byte & 15) << 3) + 0x84) << (byte >> 4 & 7)) - 0x84;
    if byte & 0x80 == 0 { size } else { -size }
}

/// Reads the audio file at `path`.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read, and those of [`audio_from_wav`]; all with the path.
pub fn open_wav(path: impl AsRef<Path>) -> Result<Audio> {
    let path = path.as_ref();
    let read = || -> Result<Audio> {
        let mut bytes = Vec::new();
        File::open(path)?.take(MAX_BYTES + 1).read_to_end(&mut bytes)?;
        if bytes.len() as u64 > MAX_BYTES {
            return Err(Error::invalid_input(format!(
                "the file has over {MAX_BYTES} bytes; split the audio"
            )));
        }
        audio_from_wav(&bytes)
    };
    read().context(|| format!("opening {}", path.display()))
}

/// Parses a WAVE file: samples in [-1, 1], channels interleaved.
///
/// A data chunk of unknown length (written to a pipe) extends to the end of the file.
///
/// # Errors
/// `Format` with the byte offset if a file is not a WAVE file, truncated or inconsistent, or has a sample that is
/// not finite; `Unsupported` for compressed audio.
pub fn audio_from_wav(bytes: &[u8]) -> Result<Audio> {
    if bytes.get(..4) != Some(b"RIFF") || bytes.get(8..12) != Some(b"WAVE") {
        return Err(Error::format("the file does not start with RIFF and WAVE; use a WAVE file"));
    }
    let mut format = None;
    let mut at = 12usize;
    while let Some((name, length)) = chunk_head(bytes, at) {
        let start = at + 8;
        let body = bytes.get(start..).unwrap_or_default();
        let whole = usize::try_from(length).ok().and_then(|length| body.get(..length));
        match (name, whole) {
            (b"data", whole) => {
                let known = whole.or((length == UNKNOWN_LENGTH).then_some(body));
                let body = known.ok_or_else(|| truncated("data", at, length, body.len()))?;
                let format: WavFormat = format.ok_or_else(|| {
                    Error::format(format!(
                        "byte {at}: samples come before the chunk \"fmt \" with their format"
                    ))
                })?;
                return format.audio(body, start);
            }
            (b"fmt ", Some(body)) => format = Some(WavFormat::read(body, at)?),
            (_, Some(_)) => {}
            (name, None) => return Err(truncated(&name.escape_ascii().to_string(), at, length, body.len())),
        }
        // Chunks start at even offsets.
        at = start.saturating_add(length as usize).saturating_add(length as usize & 1);
    }
    Err(Error::format(format!(
        "ends at byte {} without a chunk \"data\"; the file is truncated",
        bytes.len()
    )))
}

fn chunk_head(bytes: &[u8], at: usize) -> Option<(&[u8; 4], u32)> {
    let (name, rest) = bytes.get(at..)?.split_first_chunk::<4>()?;
    Some((name, u32::from_le_bytes(*rest.first_chunk()?)))
}

#[cold]
fn truncated(name: &str, at: usize, length: u32, available: usize) -> Error {
    Error::format(format!(
        "byte {at}: chunk \"{name}\" of {length} bytes has {available}; the file is truncated"
    ))
}

/// The chunk `fmt `.
#[derive(Debug, Clone, Copy)]
struct WavFormat {
    encoding: WavEncoding,
    channels: usize,
    sample_rate: u32,
}

impl WavFormat {
    fn read(body: &[u8], at: usize) -> Result<Self> {
        let word = |index: usize| Some(u16::from_le_bytes(*body.get(index..)?.first_chunk()?));
        let fields = || {
            let rate = u32::from_le_bytes(*body.get(4..)?.first_chunk()?);
            Some((word(0)?, word(2)?, rate, word(12)?, word(14)?))
        };
        let (tag, channels, sample_rate, block, bits) = fields().ok_or_else(|| {
            Error::format(format!("byte {at}: chunk \"fmt \" has {} bytes instead of 16", body.len()))
        })?;
        // In the extensible format, the format tag is the start of a GUID.
        let tag = if tag == EXTENSIBLE { word(24).unwrap_or(tag) } else { tag };
        let encoding = WavEncoding::from_tag(tag, bits).context(|| format!("byte {at}"))?;
        let channels = usize::from(channels);
        if channels == 0 || sample_rate == 0 || usize::from(block) != channels * encoding.bytes() {
            return Err(Error::format(format!(
                "byte {at}: {channels} channels of {bits} bits at {sample_rate} Hz in blocks of {block} bytes are \
                inconsistent; fix the header"
            )));
        }
        Ok(Self { encoding, channels, sample_rate })
    }

    fn audio(self, body: &[u8], start: usize) -> Result<Audio> {
        let width = self.encoding.bytes();
        if !body.len().is_multiple_of(width * self.channels) {
            return Err(Error::format(format!(
                "byte {start}: {} bytes are not a multiple of {}, the size of a frame; the file is truncated",
                body.len(),
                width * self.channels
            )));
        }
        let samples: Vec<f32> = body.chunks_exact(width).map(|bytes| self.encoding.sample(bytes)).collect();
        if let Some(wrong) = samples.iter().position(|sample| !sample.is_finite()) {
            let at = start + wrong * width;
            return Err(Error::format(format!(
                "byte {at}: sample {wrong} is not a finite number; fix the file"
            )));
        }
        Audio::new(samples, self.channels, self.sample_rate)
    }
}

/// Returns the bytes of a WAVE file. Samples outside [-1, 1] are clipped, except in floats.
///
/// # Errors
/// `InvalidInput` for audio of over 4 GB or 65535 channels; `Unsupported` for A-law and mu-law, which are read
/// only.
pub fn wav_from_audio(audio: &Audio, encoding: WavEncoding) -> Result<Vec<u8>> {
    if matches!(encoding, WavEncoding::ALaw | WavEncoding::MuLaw) {
        return Err(Error::unsupported("A-law and mu-law cannot be written; write 16-bit PCM"));
    }
    let (width, rate) = (encoding.bytes(), audio.sample_rate());
    let [_, channels] = audio.array().shape();
    let samples = audio.array().as_slice();
    let sizes = || {
        let length =
            u32::try_from(samples.len().checked_mul(width)?).ok().filter(|length| *length < u32::MAX - 64)?;
        let block = u16::try_from(channels.checked_mul(width)?).ok()?;
        Some((length, block, rate.checked_mul(u32::from(block))?))
    };
    let (length, block, bytes_per_second) = sizes().ok_or_else(|| {
        Error::invalid_input(format!(
            "{} samples of {channels} channels do not fit into a WAVE file",
            samples.len()
        ))
    })?;
    let mut bytes = Vec::with_capacity(46 + length as usize);
    bytes.extend(*b"RIFF");
    bytes.extend((36 + length + (length & 1)).to_le_bytes());
    bytes.extend(*b"WAVEfmt ");
    bytes.extend(16u32.to_le_bytes());
    bytes.extend(encoding.tag().to_le_bytes());
    bytes.extend((channels as u16).to_le_bytes());
    bytes.extend(rate.to_le_bytes());
    bytes.extend(bytes_per_second.to_le_bytes());
    bytes.extend(block.to_le_bytes());
    bytes.extend((width as u16 * 8).to_le_bytes());
    bytes.extend(*b"data");
    bytes.extend(length.to_le_bytes());
    samples.iter().for_each(|sample| write_sample(encoding, *sample, &mut bytes));
    bytes.extend((length & 1 == 1).then_some(0));
    Ok(bytes)
}

fn write_sample(encoding: WavEncoding, sample: f32, bytes: &mut Vec<u8>) {
    // A cast saturates at the range of the integer.
    let scaled = |scale: f64| (f64::from(sample) * scale).round();
    match encoding {
        WavEncoding::Pcm8 => bytes.push((scaled(128.0) + 128.0) as u8),
        WavEncoding::Pcm16 => bytes.extend((scaled(32768.0) as i16).to_le_bytes()),
        WavEncoding::Pcm24 => {
            let whole = scaled(8_388_608.0).clamp(-8_388_608.0, 8_388_607.0) as i32;
            bytes.extend(&whole.to_le_bytes()[..3]);
        }
        WavEncoding::Pcm32 => bytes.extend((scaled(2_147_483_648.0) as i32).to_le_bytes()),
        WavEncoding::Float64 => bytes.extend(f64::from(sample).to_le_bytes()),
        _ => bytes.extend(sample.to_le_bytes()),
    }
}

#[cfg(test)]
mod tests;
