//! What COCO's evaluation is made of: thresholds of overlap, ranges of area, limits of detections.

/// Thresholds of overlap (intersection over union, or key point similarity).
pub const THRESHOLDS: usize = 10;
/// Levels of recall at which precision is read off.
pub const RECALLS: usize = 101;
/// At most so many ranges of area.
pub(super) const AREAS: usize = 4;

/// The thresholds .50, .55 to .95, to the last bit those of pycocotools (NumPy's `linspace`).
pub fn thresholds() -> [f64; THRESHOLDS] {
    let step = (0.95 - 0.5) / (THRESHOLDS - 1) as f64;
    let mut thresholds = std::array::from_fn(|index| index as f64 * step + 0.5);
    thresholds[THRESHOLDS - 1] = 0.95;
    thresholds
}

/// The levels of recall 0, .01 to 1, to the last bit those of pycocotools.
pub fn recalls() -> [f64; RECALLS] {
    let mut recalls = std::array::from_fn(|index| index as f64 * 0.01);
    recalls[RECALLS - 1] = 1.0;
    recalls
}

/// Objects of an area within `min..=max` square pixels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct AreaRange {
    /// As it stands in keys: `map_small`.
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

/// How objects are counted.
#[derive(Debug, Clone, PartialEq)]
pub struct Protocol {
    /// Ranges of area, all sizes first.
    pub(super) areas: &'static [AreaRange],
    /// Limits of detections a picture and class, ascending.
    pub(super) limits: Vec<u32>,
}

impl Protocol {
    /// For boxes and masks: all, small, medium, large; 1, 10 and `most` detections (COCO: 100).
    pub fn objects(most: u32) -> Self {
        const AREAS: [AreaRange; 4] = [AreaRange::ALL, AreaRange::SMALL, AreaRange::MEDIUM, AreaRange::LARGE];
        Self { areas: &AREAS, limits: vec![1, 10.min(most), most] }
    }

    /// For key points: all, medium, large; `most` detections (COCO: 20).
    pub fn keypoints(most: u32) -> Self {
        const AREAS: [AreaRange; 3] = [AreaRange::ALL, AreaRange::MEDIUM, AreaRange::LARGE];
        Self { areas: &AREAS, limits: vec![most] }
    }

    /// The largest limit of detections.
    pub(super) fn most(&self) -> u32 {
        self.limits.last().copied().unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Compared with `numpy.linspace`.
    #[test]
    fn to_the_last_bit() {
        let wanted = [0.5, 0.55, 0.6, 0.65, 0.7, 0.75, 0.8, 0.85, 0.9, 0.95];
        assert!(
            thresholds().iter().zip(wanted).all(|(threshold, wanted)| (threshold - wanted).abs() < 1e-15)
        );
        assert_eq!((thresholds()[0], thresholds()[5], thresholds()[9]), (0.5, 0.75, 0.95));
        assert_eq!((recalls()[29], recalls()[57], recalls()[100]), (0.29, 0.5700000000000001, 1.0));
    }
}
