//! Parameters of the decoder.

/// Parameters of the decoder.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PartAffinity {
    /// Height below which peaks are ignored, 0..=1.
    pub peak_threshold: f32,
    /// Upsampling factor around peaks; 1 to [`PartAffinity::MAX_UPSAMPLE_RATIO`].
    pub upsample_ratio: usize,
    /// Distance below which peaks of one joint are merged, in pixels of the network's input.
    pub radius: f32,
    /// Value of the field along a limb below which a sample does not count; 0..=1.
    pub limb_threshold: f32,
    /// Minimum share of samples of a limb that count, 0..=1.
    pub limb_share: f32,
    /// Minimum number of joints of a person.
    pub min_joints: usize,
}

impl Default for PartAffinity {
    /// Returns Osokin's parameters.
    fn default() -> Self {
        Self {
            peak_threshold: 0.1,
            upsample_ratio: 4,
            radius: 12.0,
            limb_threshold: 0.05,
            limb_share: 0.8,
            min_joints: 3,
        }
    }
}

impl PartAffinity {
    /// Maximum upsampling factor.
    pub const MAX_UPSAMPLE_RATIO: usize = 8;
}
