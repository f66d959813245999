use opendr_engine::learner::Learner;
use opendr_engine::target::BoundingBoxList;
use opendr_face_detection::face_detection::{UltraLightFace, Yunet};
use opendr_tiling::{Open, open_as};

use super::{CenterNet, FastestDet, ImportedDetector, Nanodet, SingleShotDetector, Yolox};

/// The learners that detect boxes in an image.
pub const DETECTORS: &[(&str, Open<BoundingBoxList>)] = &[
    (Nanodet::SPEC.name, open_as::<BoundingBoxList, Nanodet>),
    (CenterNet::SPEC.name, open_as::<BoundingBoxList, CenterNet>),
    (SingleShotDetector::SPEC.name, open_as::<BoundingBoxList, SingleShotDetector>),
    (Yolox::SPEC.name, open_as::<BoundingBoxList, Yolox>),
    (FastestDet::SPEC.name, open_as::<BoundingBoxList, FastestDet>),
    (ImportedDetector::SPEC.name, open_as::<BoundingBoxList, ImportedDetector>),
    (UltraLightFace::SPEC.name, open_as::<BoundingBoxList, UltraLightFace>),
    (Yunet::SPEC.name, open_as::<BoundingBoxList, Yunet>),
];
