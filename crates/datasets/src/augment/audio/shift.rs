//! Time shift.

use opendr_engine::dataset::Sample;
use opendr_engine::params::Params;
use opendr_engine::{Random, Result};

use crate::augment::audio::sound::for_each_audio;
use crate::augment::{Augment, Augmentation, OtherSamples};

/// Shifts audio in time; the length is kept, and silence fills the gap.
#[derive(Debug, Clone, Params)]
pub struct AudioShift {
    /// Largest shift in either direction.
    #[param(default = 0.1, range = 0.0..=60.0, unit = "s")]
    pub max_shift: f32,
}

impl Augmentation for AudioShift {
    const NAME: &'static str = "audio_shift";
    const ABOUT: &'static str = "shifts audio in time";
}

impl Augment for AudioShift {
    fn apply(&self, sample: &mut Sample, random: &mut Random, _: &OtherSamples<'_>) -> Result<()> {
        let seconds = random.uniform(-self.max_shift, self.max_shift);
        for_each_audio(sample, |samples, audio| {
            let instants = (seconds * audio.sample_rate() as f32).round();
            let by = (instants.abs() as usize).saturating_mul(audio.channels()).min(samples.len());
            let kept = samples.len() - by;
            if instants > 0.0 {
                samples.copy_within(..kept, by);
                samples[..by].fill(0.0);
            } else {
                samples.copy_within(by.., 0);
                samples[kept..].fill(0.0);
            }
        })
    }
}
