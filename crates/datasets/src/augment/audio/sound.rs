//! Access to the audio of a sample.

use opendr_engine::data::Audio;
use opendr_engine::dataset::Sample;
use opendr_engine::{Error, Result, Value};

/// Calls `change` with the interleaved samples of every [`Audio`], and clips them to -1 and 1 afterwards.
pub(super) fn for_each_audio(sample: &mut Sample, mut change: impl FnMut(&mut [f32], &Audio)) -> Result<()> {
    let mut changed = false;
    for datum in &mut sample.data {
        let Value::Audio(audio) = datum else { continue };
        let mut samples = audio.as_slice().to_vec();
        change(&mut samples, audio);
        samples.iter_mut().for_each(|sample| *sample = sample.clamp(-1.0, 1.0));
        let header = audio.header.clone();
        *audio = Audio::new(samples, audio.channels(), audio.sample_rate())?.with_header(header);
        changed = true;
    }
    match changed {
        true => Ok(()),
        false => Err(Error::invalid_input("the sample has no audio; use an augmentation for its type")),
    }
}
