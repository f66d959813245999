//! Figures over episodes: accuracy, calibration, views until a confidence.

use std::fmt;

use opendr_engine::Error;
use opendr_metrics::{Calibration, Interval, wilson_interval};
use serde::Serialize;

use crate::episode::ActiveEpisode;

/// The confidence of [`ActiveReport::median_views`].
pub const CERTAIN: f32 = 0.9;

/// Figures over episodes.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ActiveReport {
    /// Share of correct predictions with its 95 % interval (Wilson).
    #[serde(serialize_with = "as_bounds")]
    pub accuracy: Interval,
    /// Expected calibration error of the beliefs at the end, 15 bins.
    pub calibration_error: f64,
    /// Median over episodes of the views until a probability of 0.9; episodes that never reach it count as infinite, and so
    /// may the median.
    pub median_views: f64,
    /// Mean number of views.
    pub mean_views: f64,
    /// Number of episodes.
    pub episodes: usize,
}

/// Writes value, low and high.
fn as_bounds<S: serde::Serializer>(interval: &Interval, serializer: S) -> Result<S::Ok, S::Error> {
    [interval.value, interval.low, interval.high].serialize(serializer)
}

impl ActiveReport {
    /// Computes the figures of episodes.
    ///
    /// # Errors
    /// Returns `InvalidInput` without episodes.
    pub fn of(episodes: &[ActiveEpisode]) -> opendr_engine::Result<Self> {
        let correct = episodes.iter().filter(|episode| episode.is_correct()).count();
        let mut calibration = Calibration::default();
        for episode in episodes {
            calibration.add(episode.is_correct(), f64::from(episode.confidence.min(1.0)))?;
        }
        let none = || Error::invalid_input("no episodes to report on; run at least one");
        let mut views: Vec<f64> = episodes
            .iter()
            .map(|episode| episode.views_to(CERTAIN).map_or(f64::INFINITY, |views| views as f64))
            .collect();
        views.sort_by(f64::total_cmp);
        let views_in_all = episodes.iter().map(|episode| episode.confidences.len()).sum::<usize>();
        Ok(Self {
            accuracy: wilson_interval(correct as u64, episodes.len() as u64).ok_or_else(none)?,
            calibration_error: calibration.expected_error().ok_or_else(none)?,
            median_views: views[(views.len() - 1) / 2],
            mean_views: views_in_all as f64 / episodes.len() as f64,
            episodes: episodes.len(),
        })
    }
}

/// Cells of a row of a table in Markdown.
impl fmt::Display for ActiveReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Interval { value, low, high } = self.accuracy;
        write!(
            f,
            "{:.1} % ({:.1} to {:.1}) | {:.3} | ",
            100.0 * value,
            100.0 * low,
            100.0 * high,
            self.calibration_error
        )?;
        match self.median_views.is_finite() {
            true => write!(f, "{:.0}", self.median_views)?,
            false => f.write_str("never")?,
        }
        write!(f, " | {:.1}", self.mean_views)
    }
}
