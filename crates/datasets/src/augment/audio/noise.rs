//! White noise.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::audio::sound::for_each_audio;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Adds white noise at a random signal-to-noise ratio; silence stays silent.
#[derive(Debug, Clone, Params)]
pub struct AudioNoise {
    /// Smallest signal-to-noise ratio.
    #[param(default = 10.0, range = -40.0..=120.0, unit = "dB")]
    pub min_snr: f32,
    /// Largest signal-to-noise ratio.
    #[param(default = 40.0, range = -40.0..=120.0, unit = "dB")]
    pub max_snr: f32,
}

impl Augmentation for AudioNoise {
    const NAME: &'static str = "audio_noise";
    const ABOUT: &'static str = "adds white noise at a random signal-to-noise ratio";
}

impl Augment for AudioNoise {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let ratio = random.uniform(self.min_snr, self.max_snr);
        for_each_audio(sample, |samples, _| {
            let power =
                samples.iter().map(|sample| f64::from(*sample).powi(2)).sum::<f64>() / samples.len() as f64;
            let deviation = (power / 10f64.powf(f64::from(ratio) / 10.0)).sqrt();
            samples.iter_mut().for_each(|sample| *sample += (random.normal() * deviation) as f32);
        })
    }
}
