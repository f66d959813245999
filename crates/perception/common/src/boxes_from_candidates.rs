//! Conversion of candidates after suppression to boxes in image pixels.

use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_vision::InputGeometry;

use crate::suppression::Candidate;

/// Replaces the boxes of `list` by `candidates`, mapped from the network's input to image pixels and clipped to the image.
///
/// Candidates that lie outside the image are dropped.
pub fn boxes_from_candidates(
    list: &mut BoundingBoxList,
    candidates: &[Candidate],
    geometry: &InputGeometry,
    classes: &Classes,
) {
    list.boxes.clear();
    list.classes.clone_from(classes);
    list.boxes.extend(candidates.iter().filter_map(|candidate| box_from_candidate(candidate, geometry)));
}

/// Returns the box of a candidate, mapped to image pixels and clipped to the image; `None` outside the image.
pub fn box_from_candidate(candidate: &Candidate, geometry: &InputGeometry) -> Option<BoundingBox> {
    let corners = geometry.image_box_from_input(candidate.corners);
    let inside = corners[2] > corners[0] && corners[3] > corners[1];
    inside.then(|| BoundingBox::from_corners(i64::from(candidate.class), corners, candidate.score))
}
