//! Random gain.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::audio::sound::for_each_audio;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Changes the volume of audio by a random gain; samples beyond -1 and 1 are clipped.
#[derive(Debug, Clone, Params)]
pub struct AudioGain {
    /// Smallest gain.
    #[param(default = -6.0, range = -60.0..=60.0, unit = "dB")]
    pub min_gain: f32,
    /// Largest gain.
    #[param(default = 6.0, range = -60.0..=60.0, unit = "dB")]
    pub max_gain: f32,
}

impl Augmentation for AudioGain {
    const NAME: &'static str = "audio_gain";
    const ABOUT: &'static str = "changes the volume of audio";
}

impl Augment for AudioGain {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let gain = 10f32.powf(random.uniform(self.min_gain, self.max_gain) / 20.0);
        for_each_audio(sample, |samples, _| samples.iter_mut().for_each(|sample| *sample *= gain))
    }
}
