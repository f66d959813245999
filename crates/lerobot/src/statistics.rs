//! Statistics of features, as in `meta/stats.json`.

use serde::{Deserialize, Serialize};

/// Statistics of the numbers of a feature over frames, one of each per number.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FeatureStatistics {
    /// Smallest values.
    pub min: Vec<f64>,
    /// Largest values.
    pub max: Vec<f64>,
    /// Means.
    pub mean: Vec<f64>,
    /// Standard deviations.
    pub std: Vec<f64>,
    /// Number of frames; a list of one.
    pub count: Vec<u64>,
    /// Quantiles of 1 %.
    #[serde(default)]
    pub q01: Vec<f64>,
    /// Quantiles of 10 %.
    #[serde(default)]
    pub q10: Vec<f64>,
    /// Medians.
    #[serde(default)]
    pub q50: Vec<f64>,
    /// Quantiles of 90 %.
    #[serde(default)]
    pub q90: Vec<f64>,
    /// Quantiles of 99 %.
    #[serde(default)]
    pub q99: Vec<f64>,
}

impl FeatureStatistics {
    /// Computes the statistics of rows of `width` numbers; quantiles are interpolated as NumPy does.
    pub fn of(numbers: &[f64], width: usize) -> Self {
        let count = numbers.len().checked_div(width).unwrap_or(0);
        let mut statistics = Self { count: vec![count as u64], ..Self::default() };
        if count == 0 {
            return statistics;
        }
        for column in 0..width {
            let mut values: Vec<f64> = numbers.iter().skip(column).step_by(width).copied().collect();
            values.sort_by(f64::total_cmp);
            let mean = values.iter().sum::<f64>() / count as f64;
            let variance = values.iter().map(|x| (x - mean) * (x - mean)).sum::<f64>() / count as f64;
            statistics.min.push(values[0]);
            statistics.max.push(values[count - 1]);
            statistics.mean.push(mean);
            statistics.std.push(variance.sqrt());
            for (share, to) in [0.01, 0.1, 0.5, 0.9, 0.99].into_iter().zip(statistics.quantiles_mut()) {
                to.push(quantile(&values, share));
            }
        }
        statistics
    }

    fn quantiles_mut(&mut self) -> [&mut Vec<f64>; 5] {
        [&mut self.q01, &mut self.q10, &mut self.q50, &mut self.q90, &mut self.q99]
    }

    /// Returns the rows of the format by name, the number of frames excluded.
    pub(crate) fn rows(&self) -> [(&'static str, &Vec<f64>); 9] {
        let Self { min, max, mean, std, q01, q10, q50, q90, q99, .. } = self;
        [
            ("min", min),
            ("max", max),
            ("mean", mean),
            ("std", std),
            ("q01", q01),
            ("q10", q10),
            ("q50", q50),
            ("q90", q90),
            ("q99", q99),
        ]
    }

    /// Adds the statistics of further frames. Quantiles become weighted means, as in LeRobot.
    pub(crate) fn merge(&mut self, other: &Self) {
        let [own, added] = [&*self, other].map(|s| s.count.first().copied().unwrap_or(0) as f64);
        if own == 0.0 {
            *self = other.clone();
            return;
        }
        let share = added / (own + added).max(1.0);
        for (at, (mean, std)) in self.mean.iter_mut().zip(&mut self.std).enumerate() {
            let (Some(other_mean), Some(other_std)) = (other.mean.get(at), other.std.get(at)) else { break };
            let apart = other_mean - *mean;
            let variance = *std * *std * (1.0 - share)
                + other_std * other_std * share
                + apart * apart * share * (1.0 - share);
            *mean += share * apart;
            *std = variance.sqrt();
        }
        self.min.iter_mut().zip(&other.min).for_each(|(own, other)| *own = own.min(*other));
        self.max.iter_mut().zip(&other.max).for_each(|(own, other)| *own = own.max(*other));
        let mut further = other.clone();
        for (own, other) in self.quantiles_mut().into_iter().zip(further.quantiles_mut()) {
            own.iter_mut().zip(other.iter()).for_each(|(own, other)| *own += share * (other - *own));
        }
        self.count = vec![(own + added) as u64];
    }
}

/// Returns a quantile of sorted values.
fn quantile(sorted: &[f64], share: f64) -> f64 {
    let place = share * (sorted.len() - 1) as f64;
    let (below, above) = (place.floor() as usize, place.ceil() as usize);
    sorted[below] + (place - place.floor()) * (sorted[above] - sorted[below])
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn statistics_of_parts_are_those_of_all() {
        let numbers: Vec<f64> = (0..60).map(|at| (f64::from(at) * 0.7).sin() * f64::from(at)).collect();
        let all = FeatureStatistics::of(&numbers, 2);
        let mut merged = FeatureStatistics::default();
        for part in [&numbers[..10], &numbers[10..36], &numbers[36..]] {
            merged.merge(&FeatureStatistics::of(part, 2));
        }
        assert_eq!((&merged.min, &merged.max, &merged.count), (&all.min, &all.max, &vec![30]));
        for (own, other) in merged.mean.iter().chain(&merged.std).zip(all.mean.iter().chain(&all.std)) {
            assert!((own - other).abs() < 1e-9, "{own} {other}");
        }
        assert_eq!(quantile(&[0.0, 1.0, 4.0], 0.75), 2.5);
    }
}
