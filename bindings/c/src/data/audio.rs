//! Audio.

use opendr::data::Audio;

use crate::handle::Out;
use crate::pointer::{place, slice};
use crate::status::{guard, opendr_status};
use crate::value::{AnyValue, opendr_audio, typed};

/// Creates audio from length samples in [-1, 1], with interleaved channels, which are copied.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_audio_create(
    samples: *const f32,
    length: usize,
    channels: usize,
    sample_rate: u32,
    audio: *mut *mut opendr_audio,
) -> opendr_status {
    guard(|| {
        // SAFETY: the rules at the top of opendr.h.
        let (out, samples) = unsafe { (Out::new(audio, "audio")?, slice(samples, length, "samples")?) };
        out.set(AnyValue::from(Audio::new(samples.to_vec(), channels, sample_rate)?));
        Ok(())
    })
}

/// Writes a pointer to the samples of audio, valid as long as the audio, and their format.
#[unsafe(no_mangle)]
pub unsafe extern "C" fn opendr_audio_read(
    audio: *const opendr_audio,
    samples: *mut *const f32,
    length: *mut usize,
    channels: *mut usize,
    sample_rate: *mut u32,
) -> opendr_status {
    guard(|| {
        let (samples, length) = (place(samples, "samples")?, place(length, "length")?);
        let (channels, sample_rate) = (place(channels, "channels")?, place(sample_rate, "sample_rate")?);
        // SAFETY: the rules at the top of opendr.h.
        unsafe {
            let audio = typed::<Audio, _>(audio, "audio")?;
            samples.write(audio.as_slice().as_ptr());
            length.write(audio.as_slice().len());
            channels.write(audio.channels());
            sample_rate.write(audio.sample_rate());
        }
        Ok(())
    })
}
