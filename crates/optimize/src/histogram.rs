//! Histograms of tensor values.

/// Number of bins.
const BINS: usize = 4096;
/// Maximum number of values counted per tensor; larger tensors are sampled evenly.
const COUNTED: usize = 1 << 15;

/// Counts of the values of a tensor in bins of equal width around zero. The width doubles when a value lies outside.
#[derive(Debug, Clone)]
pub struct Histogram {
    counts: Vec<u64>,
    /// Width of a bin; zero before the first value.
    width: f64,
    low: f32,
    high: f32,
}

impl Default for Histogram {
    fn default() -> Self {
        Self { counts: vec![0; BINS], width: 0.0, low: f32::INFINITY, high: f32::NEG_INFINITY }
    }
}

impl Histogram {
    /// Counts values, or a sample of very many; values that are not finite are ignored.
    pub fn add(&mut self, values: &[f32]) {
        let finite = || values.iter().copied().filter(|value| value.is_finite());
        let (low, high) =
            finite().fold((self.low, self.high), |(low, high), value| (low.min(value), high.max(value)));
        if low > high {
            return;
        }
        (self.low, self.high) = (low, high);
        self.make_room(f64::from(high.max(-low)).max(1e-30));
        let scale = 1.0 / self.width;
        // An odd step visits every column of an image.
        for value in finite().step_by((values.len() / COUNTED) | 1) {
            let bin = (f64::from(value) * scale).floor() as isize + (BINS / 2) as isize;
            if let Some(count) = self.counts.get_mut(bin.clamp(0, BINS as isize - 1) as usize) {
                *count += 1;
            }
        }
    }

    fn make_room(&mut self, most: f64) {
        if self.width == 0.0 {
            self.width = most / (BINS / 2) as f64;
        }
        while self.width * ((BINS / 2) as f64) < most {
            let mut merged = vec![0; BINS];
            for (pair, sum) in self.counts.chunks_exact(2).zip(merged.iter_mut().skip(BINS / 4)) {
                *sum = pair.iter().sum();
            }
            self.counts = merged;
            self.width *= 2.0;
        }
    }

    /// Returns the smallest and largest value; `None` before the first.
    pub fn range(&self) -> Option<(f32, f32)> {
        (self.low <= self.high).then_some((self.low, self.high))
    }

    /// Returns the range without the smallest and the largest values, `share` of all values each.
    pub fn range_without(&self, share: f64) -> Option<(f32, f32)> {
        let (low, high) = self.range()?;
        let most = (self.counts.iter().sum::<u64>() as f64 * share) as u64;
        let beyond = |counts: &mut dyn Iterator<Item = &u64>| {
            let mut sum = 0;
            counts
                .take_while(|count| {
                    sum += **count;
                    sum <= most
                })
                .count()
        };
        let first = beyond(&mut self.counts.iter()) as f64 - (BINS / 2) as f64;
        let last = (BINS / 2) as f64 - beyond(&mut self.counts.iter().rev()) as f64;
        Some((((first * self.width) as f32).max(low), ((last * self.width) as f32).min(high)))
    }

    /// Returns the centres and the counts of the bins that have values.
    pub fn bins(&self) -> impl Iterator<Item = (f64, u64)> {
        let middle = |bin: usize| (bin as f64 - (BINS / 2) as f64 + 0.5) * self.width;
        self.counts
            .iter()
            .enumerate()
            .filter(|(_, count)| **count > 0)
            .map(move |(bin, count)| (middle(bin), *count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn values_keep_their_bins_as_the_range_grows() {
        let mut histogram = Histogram::default();
        assert_eq!(histogram.range(), None);
        let small: Vec<f32> = (0..1000).map(|at| at as f32 / 1000.0).collect();
        histogram.add(&small);
        histogram.add(&[f32::NAN, -100.0, f32::INFINITY]);
        assert_eq!(histogram.range(), Some((-100.0, 0.999)));
        let mean = histogram.bins().map(|(middle, count)| middle * count as f64).sum::<f64>();
        assert!((mean - (499.5 - 100.0)).abs() < 40.0, "{mean}");
        assert_eq!(histogram.bins().map(|(_, count)| count).sum::<u64>(), 1001);
        let (low, high) = histogram.range_without(0.005).unwrap();
        assert!((-0.1..=0.1).contains(&low) && (0.9..=0.999).contains(&high), "{low} {high}");
        assert_eq!(histogram.range_without(0.0).unwrap(), (-100.0, 0.999));
    }

    #[test]
    fn large_tensors_are_sampled() {
        let mut histogram = Histogram::default();
        let many: Vec<f32> = (0..1_000_000).map(|at| (at % 640) as f32).collect();
        histogram.add(&many);
        assert_eq!(histogram.range(), Some((0.0, 639.0)));
        assert!(
            histogram.bins().count() == 640
                && histogram.bins().map(|(_, count)| count).sum::<u64>() < 100_000
        );
    }
}
