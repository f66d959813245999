//! Thresholds, ranges of area and limits of detections of COCO's evaluation.

/// Number of thresholds of the overlap (intersection over union, or keypoint similarity).
pub const THRESHOLDS: usize = 10;
/// Number of levels of recall.
pub const RECALLS: usize = 101;
/// Maximum number of ranges of area.
pub(super) const AREAS: usize = 4;

/// Returns the thresholds .50, .55 to .95, equal to those of pycocotools (NumPy's `linspace`) to the last bit.
pub fn thresholds() -> [f64; THRESHOLDS] {
    let step = (0.95 - 0.5) / (THRESHOLDS - 1) as f64;
    let mut thresholds = std::array::from_fn(|index| index as f64 * step + 0.5);
    thresholds[THRESHOLDS - 1] = 0.95;
    thresholds
}

/// Returns the levels of recall 0, .01 to 1, equal to those of pycocotools to the last bit.
pub fn recalls() -> [f64; RECALLS] {
    let mut recalls = std::array::from_fn(|index| index as f64 * 0.01);
    recalls[RECALLS - 1] = 1.0;
    recalls
}

/// A range of area, `min..=max` square pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AreaRange {
    /// Name in keys: `small` in `map_small`.
    pub name: &'static str,
    /// Smallest area.
    pub min: f64,
    /// Largest area.
    pub max: f64,
}

impl AreaRange {
    const ALL: Self = Self { name: "all", min: 0.0, max: 1e10 };
    const SMALL: Self = Self { name: "small", min: 0.0, max: 1024.0 };
    const MEDIUM: Self = Self { name: "medium", min: 1024.0, max: 9216.0 };
    const LARGE: Self = Self { name: "large", min: 9216.0, max: 1e10 };

    pub(super) fn contains(&self, area: f64) -> bool {
        !(area < self.min || area > self.max)
    }
}

/// Rules of an evaluation.
#[derive(Debug, Clone, PartialEq)]
pub struct Protocol {
    /// Ranges of area, all sizes first.
    pub(super) areas: &'static [AreaRange],
    /// Limits of detections per image and class, ascending.
    pub(super) limits: Vec<u32>,
}

impl Protocol {
    /// Creates the rules for boxes and masks: areas all, small, medium, large; 1, 10 and `most` detections (COCO: 100).
    pub fn objects(most: u32) -> Self {
        const AREAS: [AreaRange; 4] = [AreaRange::ALL, AreaRange::SMALL, AreaRange::MEDIUM, AreaRange::LARGE];
        Self { areas: &AREAS, limits: vec![1, 10.min(most), most] }
    }

    /// Creates the rules for keypoints: areas all, medium, large; `most` detections (COCO: 20).
    pub fn keypoints(most: u32) -> Self {
        const AREAS: [AreaRange; 3] = [AreaRange::ALL, AreaRange::MEDIUM, AreaRange::LARGE];
        Self { areas: &AREAS, limits: vec![most] }
    }

    /// Returns the largest limit of detections.
    pub(super) fn most(&self) -> u32 {
        self.limits.last().copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The values are those of `numpy.linspace`.
    #[test]
    fn levels_are_exact() {
        let expected = [0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95];
        assert!(
            thresholds()
                .iter()
                .zip(expected)
                .all(|(threshold, expected)| (threshold - expected).abs() < 1e-15)
        );
        assert_eq!((thresholds()[0], thresholds()[5], thresholds()[9]), (0.5, 0.75, 0.95));
        assert_eq!((recalls()[29], recalls()[57], recalls()[100]), (0.29, 0.5700000000000001, 1.0));
    }
}
