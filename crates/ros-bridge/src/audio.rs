//! Audio: `opendr_msgs/AudioStamped`, which contains messages of `audio_common`.

use opendr_engine::data::Audio;
use opendr_engine::{Error, Result};
use opendr_messages::audio_common_msgs::{AudioData, AudioInfo};
use opendr_messages::opendr_msgs::AudioStamped;

use crate::{FromToMessage, RosBridge, header_from_message, message_from_header};

/// Written sample format of `audio_common`, in GStreamer's notation.
const FLOATS: &str = "F32LE";

/// Written losslessly as floats; also read as 8 (`U8`), 16 (`S16LE`) and 32 bits (`S32LE`).
impl FromToMessage<AudioStamped> for Audio {
    fn from_message(message: AudioStamped, _: &RosBridge) -> Result<Self> {
        let AudioInfo { channels, sample_rate, sample_format, coding_format, .. } = message.info;
        if !matches!(coding_format.as_str(), "" | "wave" | "WAVE" | "raw" | "pcm") {
            return Err(Error::unsupported(format!(
                "audio is coded as {coding_format:?}; send uncompressed samples (coding_format \"wave\")"
            )));
        }
        let data = message.audio.data;
        let channels = usize::from(channels);
        let audio = match sample_format.as_str() {
            FLOATS => Self::new(samples(&data, f32::from_le_bytes)?, channels, sample_rate),
            "S16LE" | "" => Self::from_pcm16(&samples(&data, i16::from_le_bytes)?, channels, sample_rate),
            "U8" => Self::from_pcm8(&data, channels, sample_rate),
            "S32LE" => {
                const ONE: f32 = 2_147_483_648.0;
                let floats = samples(&data, |bytes| i32::from_le_bytes(bytes) as f32 / ONE)?;
                Self::new(floats, channels, sample_rate)
            }
            other => {
                return Err(Error::unsupported(format!(
                    "samples have the format {other:?}; OpenDR reads F32LE, S16LE, S32LE and U8"
                )));
            }
        };
        Ok(audio?.with_header(header_from_message(&message.header)))
    }

    fn to_message(&self, _: &RosBridge) -> Result<AudioStamped> {
        let channels = u8::try_from(self.channels()).map_err(|_| {
            Error::invalid_input(format!(
                "audio has {} channels; a message holds at most 255",
                self.channels()
            ))
        })?;
        let info = AudioInfo {
            channels,
            sample_rate: self.sample_rate(),
            sample_format: FLOATS.to_owned(),
            bitrate: self.sample_rate().saturating_mul(u32::from(channels) * 32),
            coding_format: "wave".to_owned(),
        };
        let data = self.as_slice().iter().flat_map(|sample| sample.to_le_bytes()).collect();
        Ok(AudioStamped { header: message_from_header(&self.header)?, info, audio: AudioData { data } })
    }
}

fn samples<const N: usize, T>(data: &[u8], read: impl Fn([u8; N]) -> T) -> Result<Vec<T>> {
    let (samples, rest) = data.as_chunks::<N>();
    if !rest.is_empty() {
        return Err(Error::format(format!(
            "{} bytes are not a whole number of samples of {N} bytes",
            data.len()
        )));
    }
    Ok(samples.iter().map(|bytes| read(*bytes)).collect())
}
