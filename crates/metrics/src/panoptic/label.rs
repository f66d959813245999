//! Labels of panoptic maps.

use opendr_engine::target::Heatmap;

/// Factor of the class in a label: a label is this factor times the class index plus the index of the object in its class,
/// as in Cityscapes.
pub const LABEL_DIVISOR: u32 = 1000;

/// Label of pixels without class, for any [`ignore`](crate::PanopticParams::ignore).
pub(super) const VOID_LABEL: u32 = Heatmap::NO_CLASS;
