//! The noise schedule of diffusion.

/// The cosine schedule (Nichol and Dhariwal, 2021): share of the signal, squared, that is left at each noise level.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct NoiseSchedule {
    kept: Vec<f32>,
}

impl NoiseSchedule {
    /// Creates the schedule of this many levels.
    pub fn new(levels: usize) -> Self {
        let remaining = |level: usize| {
            let angle = (level as f64 / levels as f64 + 0.008) / 1.008 * std::f64::consts::FRAC_PI_2;
            angle.cos().powi(2)
        };
        let mut product = 1.0;
        let kept = (0..levels).map(|level| {
            let beta = (1.0 - remaining(level + 1) / remaining(level)).min(0.999);
            product *= 1.0 - beta;
            product as f32
        });
        Self { kept: kept.collect() }
    }

    /// Returns the number of levels.
    pub fn levels(&self) -> usize {
        self.kept.len()
    }

    /// Returns the factors of signal and noise at a level.
    pub fn factors(&self, level: usize) -> [f32; 2] {
        [self.kept[level].sqrt(), (1.0 - self.kept[level]).sqrt()]
    }

    /// Returns the levels of a sampling in `steps` steps, from the noisiest, as the paper spaces them.
    pub fn sampled(&self, steps: usize) -> impl Iterator<Item = usize> + use<> {
        let steps = steps.clamp(1, self.levels());
        let stride = self.levels() / steps;
        (0..steps).rev().map(move |step| step * stride)
    }

    /// Takes a step of DDIM (Song et al., 2021, without added noise) in place of the noisy `sample`: from `level` to `next`, or to no
    /// noise. The predicted signal is kept in [-1, 1].
    pub fn step(&self, [level, next]: [Option<usize>; 2], noise: &[f32], sample: &mut [f32]) {
        let factors = |level: Option<usize>| level.map_or([1.0, 0.0], |level| self.factors(level));
        let ([signal, spread], [next_signal, next_spread]) = (factors(level), factors(next));
        for (sample, noise) in sample.iter_mut().zip(noise) {
            let clean = ((*sample - spread * noise) / signal).clamp(-1.0, 1.0);
            let noise = (*sample - signal * clean) / spread.max(1e-6);
            *sample = next_signal * clean + next_spread * noise;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn levels_go_from_signal_to_noise() {
        let schedule = NoiseSchedule::new(100);
        assert!(schedule.kept.windows(2).all(|pair| pair[0] > pair[1]));
        // Values of diffusers 0.31, squaredcos_cap_v2.
        assert!((schedule.kept[0] - 0.999_362_3).abs() < 1e-4 && schedule.kept[99] < 1e-3, "{schedule:?}");
        assert_eq!(schedule.sampled(10).collect::<Vec<_>>(), [90, 80, 70, 60, 50, 40, 30, 20, 10, 0]);
    }

    #[test]
    fn the_true_noise_leads_to_the_signal() {
        let schedule = NoiseSchedule::new(50);
        let (signal, noise) = ([0.5, -0.25], [1.0, -0.7]);
        let [kept, spread] = schedule.factors(40);
        let mut sample = [0, 1].map(|at| kept * signal[at] + spread * noise[at]);
        let levels: Vec<_> = [40, 20, 0].into_iter().map(Some).chain([None]).collect();
        for pair in levels.windows(2) {
            schedule.step([pair[0], pair[1]], &noise, &mut sample);
        }
        assert!((0..2).all(|at| (sample[at] - signal[at]).abs() < 1e-3), "{sample:?}");
    }
}
