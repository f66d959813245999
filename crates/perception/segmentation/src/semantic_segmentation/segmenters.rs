use opendr_engine::learner::Learner;
use opendr_engine::target::Heatmap;
use opendr_tiling::{Open, open_as};

use super::Deeplab;

/// Semantic segmentation learners that run in tiles, one line each.
pub const SEGMENTERS: &[(&str, Open<Heatmap>)] = &[(Deeplab::SPEC.name, open_as::<Heatmap, Deeplab>)];
