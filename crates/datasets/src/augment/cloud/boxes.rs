//! Geometry of 3D boxes: points inside, overlap.

use opendr_engine::target::BoundingBox3D;

/// Returns whether a point of the camera frame lies in a box.
pub(super) fn contains(object: &BoundingBox3D, place: [f64; 3]) -> bool {
    let [x, y, z] = [0, 1, 2].map(|axis| place[axis] - f64::from(object.location[axis]));
    let (sine, cosine) = f64::from(object.rotation_y).sin_cos();
    let [length, height, width] = object.dimensions.map(f64::from);
    let (along, across) = (cosine * x - sine * z, sine * x + cosine * z);
    along.abs() <= length / 2.0 && across.abs() <= width / 2.0 && (-height..=0.0).contains(&y)
}

/// Returns the corners in the camera frame, the lower four first.
pub(crate) fn corners(object: &BoundingBox3D) -> [[f64; 3]; 8] {
    let (sine, cosine) = f64::from(object.rotation_y).sin_cos();
    let [length, height, width] = object.dimensions.map(f64::from);
    let [x, y, z] = object.location.map(f64::from);
    std::array::from_fn(|corner| {
        let side =
            |bit: usize, extent: f64| if corner >> bit & 1 == 0 { extent / 2.0 } else { -extent / 2.0 };
        let (along, across) = (side(0, length), side(1, width));
        let up = if corner < 4 { 0.0 } else { height };
        [x + cosine * along + sine * across, y - up, z - sine * along + cosine * across]
    })
}

/// Returns whether two boxes overlap in bird's eye view: no side of either separates them.
pub(super) fn touch(one: &BoundingBox3D, other: &BoundingBox3D) -> bool {
    let axes = [one, other].map(|object| f64::from(object.rotation_y).sin_cos());
    let floors = [one, other].map(corners);
    axes.iter().flat_map(|(sine, cosine)| [[*cosine, -sine], [*sine, *cosine]]).all(|[x, z]| {
        let [[low, high], [other_low, other_high]] = floors.map(|floor| {
            let along = floor[..4].iter().map(|corner| x * corner[0] + z * corner[2]);
            along.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], at| [low.min(at), high.max(at)])
        });
        low < other_high && other_low < high
    })
}
