//! Crops of the networks' inputs (MediaPipe's face and iris graphs).

use opendr_engine::target::{BoundingBox, Keypoint};
use opendr_face_detection::face_detector::{eye_angle, square_around};
use opendr_vision::Similarity;

/// Indices of the outer and inner corner of the eye on the image's left, and of the inner and outer one of the other eye.
pub(super) const EYES: [[usize; 2]; 2] = [[33, 133], [362, 263]];
/// Indices of the outer corners, whose line is the roll of the head.
const CORNERS: [usize; 2] = [33, 263];
/// Side of a crop in longer sides of the face.
const MARGIN: f32 = 1.5;
/// Side of an eye's crop in distances of its corners.
const EYE_MARGIN: f32 = 2.3;

/// Returns the angle of the x axis along the line between two points.
fn angle([from, to]: [[f32; 2]; 2]) -> f32 {
    (to[1] - from[1]).atan2(to[0] - from[0])
}

/// Returns the crop of a detected face, upright by its eyes, which are the detector's first two points.
pub(super) fn of_found(face: &BoundingBox, side: usize) -> Similarity {
    square_around(face, MARGIN, eye_angle(face), side)
}

/// Returns the crop of a face with points from the last frame; `None` when they are not a valid face.
pub(super) fn of_mesh(points: &[Keypoint], side: usize) -> Option<Similarity> {
    let corners = CORNERS.map(|corner| points.get(corner).map(|point| [point.x, point.y]));
    let [Some(left), Some(right)] = corners else { return None };
    let lean = angle([left, right]);
    // The box around all points in the axes of the face.
    let upright = Similarity::new(1.0, lean, [0.0, 0.0]);
    let (mut low, mut high) = ([f32::INFINITY; 2], [f32::NEG_INFINITY; 2]);
    for point in points {
        let turned = upright.crop_from_image([point.x, point.y]);
        for axis in 0..2 {
            low[axis] = low[axis].min(turned[axis]);
            high[axis] = high[axis].max(turned[axis]);
        }
    }
    let centre = upright.image_from_crop([0, 1].map(|axis| (low[axis] + high[axis]) / 2.0));
    let extent = (high[0] - low[0]).max(high[1] - low[1]);
    let crop = Similarity::rotated_square(centre, MARGIN * extent, lean, side);
    crop.is_regular().then_some(crop)
}

/// Returns the crop of an eye by its corners.
pub(super) fn of_eye(points: &[Keypoint], corners: [usize; 2], side: usize) -> Option<Similarity> {
    let [Some(from), Some(to)] = corners.map(|corner| points.get(corner).map(|point| [point.x, point.y]))
    else {
        return None;
    };
    let centre = [0, 1].map(|axis| (from[axis] + to[axis]) / 2.0);
    let width = (to[0] - from[0]).hypot(to[1] - from[1]);
    let crop = Similarity::rotated_square(centre, EYE_MARGIN * width, angle([from, to]), side);
    crop.is_regular().then_some(crop)
}

/// Returns whether the centre of `other` is in the inner half of `crop`: then both are of one face.
pub(super) fn is_same(crop: &Similarity, other: &Similarity, side: usize) -> bool {
    let middle = side as f32 / 2.0;
    let place = crop.crop_from_image(other.image_from_crop([middle, middle]));
    place.iter().all(|value| (value - middle).abs() < middle / 2.0)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_rolled_face_is_upright_in_its_crop() {
        let lean = 0.5_f32;
        let upright = Similarity::new(1.0, lean, [300.0, 200.0]);
        let mut points = vec![[0.0, 0.0]; 468];
        (points[33], points[263], points[10], points[152]) =
            ([-30.0, -20.0], [30.0, -20.0], [0.0, -70.0], [0.0, 50.0]);
        let points: Vec<_> = points
            .into_iter()
            .map(|point| upright.image_from_crop(point))
            .map(|[x, y]| Keypoint { x, y, confidence: 1.0 })
            .collect();
        let crop = of_mesh(&points, 192).unwrap();
        assert!((crop.angle() - lean).abs() < 1e-4);
        assert!((crop.scale() * 192.0 - 1.5 * 120.0).abs() < 1e-2);
        let [left, right] = CORNERS.map(|at| crop.crop_from_image([points[at].x, points[at].y]));
        assert!((left[1] - right[1]).abs() < 1e-2 && left[0] < right[0]);
        let eye = of_eye(&points, CORNERS, 64).unwrap();
        assert!((eye.scale() * 64.0 - 2.3 * 60.0).abs() < 1e-2);
        assert!(is_same(&crop, &crop, 192));
        assert!(!is_same(&crop, &Similarity::rotated_square([0.0, 0.0], 100.0, 0.0, 192), 192));
        assert!(of_mesh(&points[..100], 192).is_none());
        assert!(of_mesh(&[Keypoint { x: f32::NAN, y: 0.0, confidence: 1.0 }; 468], 192).is_none());
    }
}
