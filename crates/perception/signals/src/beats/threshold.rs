//! Adaptive threshold between beats and noise.

/// A peak of the summed slopes.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Peak {
    /// Highest sum.
    pub height: f64,
    /// Steepest slope before it, squared.
    pub slope: f64,
    /// Position of the peak.
    pub at: u64,
    /// Sample of the beat.
    pub beat: u64,
}

/// Running estimates of beats and noise of a signal.
#[derive(Debug, Clone, Default)]
pub(super) struct Threshold {
    /// Heights of beats and of noise.
    beat: f64,
    noise: f64,
    last: Option<Peak>,
    /// Mean interval of about the last eight beats, in samples.
    interval: Option<f64>,
    /// Highest peak since the last beat that was classified as noise.
    passed: Option<Peak>,
    /// Peaks of the initialisation, and its start.
    learning: Vec<Peak>,
    since: u64,
    ready: bool,
}

/// Seconds of initialisation.
const LEARNING: f64 = 2.0;
/// Seconds without a beat after which the heights are initialised again.
const LOST: f64 = 5.0;
/// Seconds after a beat within which a peak of less than half its slope is its T wave.
const T_WAVE: f64 = 0.36;
/// Number of intervals without a beat after which a beat is searched among the noise.
const MISSING: f64 = 1.66;

impl Threshold {
    /// Processes the next peak and passes each beat to `each`, as its sample.
    pub fn next(&mut self, peak: Peak, rate: f64, mut each: impl FnMut(u64)) {
        if !self.ready {
            self.learning.push(peak);
            if (peak.at - self.since) as f64 >= LEARNING * rate {
                self.learn(rate, &mut each);
            }
            return;
        }
        self.judge(peak, rate, &mut each);
        let silent = peak.at - self.last.map_or(self.since, |last| last.at);
        if silent as f64 > LOST * rate {
            *self = Self { since: peak.at, last: self.last, ..Self::default() };
        }
    }

    /// Ends the signal: classifies the peaks of an unfinished initialisation.
    pub fn finish(&mut self, rate: f64, mut each: impl FnMut(u64)) {
        if !self.ready {
            self.learn(rate, &mut each);
        }
    }

    fn learn(&mut self, rate: f64, each: &mut impl FnMut(u64)) {
        let peaks = std::mem::take(&mut self.learning);
        let highest = peaks.iter().map(|peak| peak.height).fold(0.0, f64::max);
        // The first seconds may contain an artefact or a filter transient, so the second highest peak counts as a beat, too.
        let second =
            peaks.iter().map(|peak| peak.height).filter(|height| *height < highest).fold(0.0, f64::max);
        self.beat = if second > 0.2 * highest { second } else { highest };
        self.noise = 0.0;
        self.ready = true;
        peaks.into_iter().for_each(|peak| self.judge(peak, rate, each));
    }

    fn judge(&mut self, peak: Peak, rate: f64, each: &mut impl FnMut(u64)) {
        let after = self.last.map(|last| (peak.at - last.at) as f64);
        if let (Some(after), Some(interval), Some(passed)) = (after, self.interval, self.passed)
            && after > MISSING * interval
            && passed.height > 0.5 * self.level()
        {
            self.beat = 0.25 * passed.height + 0.75 * self.beat;
            self.accept(passed, each);
        }
        let is_t_wave = self.last.is_some_and(|last| {
            ((peak.at - last.at) as f64) < T_WAVE * rate && peak.slope < 0.5 * last.slope
        });
        if peak.height > self.level() && !is_t_wave {
            self.beat = 0.125 * peak.height + 0.875 * self.beat;
            self.accept(peak, each);
            return;
        }
        self.noise = 0.125 * peak.height + 0.875 * self.noise;
        if !is_t_wave && self.passed.is_none_or(|passed| peak.height > passed.height) {
            self.passed = Some(peak);
        }
    }

    /// Returns the minimum height of a beat.
    fn level(&self) -> f64 {
        self.noise + 0.25 * (self.beat - self.noise)
    }

    fn accept(&mut self, peak: Peak, each: &mut impl FnMut(u64)) {
        if let Some(last) = self.last {
            let interval = (peak.at - last.at) as f64;
            let mean = self.interval.unwrap_or(interval);
            self.interval = Some(mean + (interval.min(MISSING * mean) - mean) / 8.0);
        }
        (self.last, self.passed) = (Some(peak), None);
        each(peak.beat);
    }
}
