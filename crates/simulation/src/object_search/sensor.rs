//! A depth camera in the plane.

use super::grid::{column_row_of, index, middle};
use super::{CELL, Cell, FloorPlan, KnownMap, ObjectSearchParams};
use crate::arctangent::{arctangent2, wrapped};
use crate::sine_cosine::sine_cosine;

/// Angle between two rays, radians: a cell is not missed at the default range.
const RAY: f64 = 0.018;

/// Takes what the camera sees from a pose into the map: free cells and the first occupied one on each ray.
pub(super) fn reveal(
    plan: &FloorPlan,
    [x, y, yaw]: [f64; 3],
    params: &ObjectSearchParams,
    map: &mut KnownMap,
) {
    let width = params.field_of_view.to_radians();
    let rays = (width / RAY).ceil() as i32;
    for ray in 0..=rays {
        let (sine, cosine) = sine_cosine(yaw + width * (f64::from(ray) / f64::from(rays) - 0.5));
        cast([x, y], [cosine, sine], params.range, |cell| {
            let occupied = plan.occupies(cell);
            map.note(cell, occupied);
            !occupied
        });
    }
}

/// Returns whether the camera sees a place: in its field of view and range, with nothing before it.
pub(super) fn sees(
    plan: &FloorPlan,
    [x, y, yaw]: [f64; 3],
    place: [f64; 2],
    params: &ObjectSearchParams,
) -> bool {
    let way = [place[0] - x, place[1] - y];
    let distance = (way[0] * way[0] + way[1] * way[1]).sqrt();
    if distance < CELL {
        return true;
    }
    let bearing = wrapped(arctangent2(way[1], way[0]) - yaw);
    let mut clear = true;
    if distance <= params.range && bearing.abs() <= params.field_of_view.to_radians() / 2.0 {
        cast([x, y], way.map(|part| part / distance), distance, |cell| {
            clear &= !plan.occupies(cell);
            clear
        });
        return clear;
    }
    false
}

/// Returns whether the map has no obstacle between the middles of two cells.
pub(super) fn is_clear(map: &KnownMap, from: usize, to: usize) -> bool {
    let ([x, y], [to_x, to_y]) = (middle(from), middle(to));
    let way = [to_x - x, to_y - y];
    let distance = (way[0] * way[0] + way[1] * way[1]).sqrt();
    let mut clear = true;
    if distance > 0.0 {
        cast([x, y], way.map(|part| part / distance), distance, |cell| {
            clear &= map.cell(cell) != Cell::Occupied;
            clear
        });
    }
    clear
}

/// Calls `visit` for the cells along a ray (Amanatides and Woo, A fast voxel traversal algorithm, 1987) until it returns false.
fn cast(from: [f64; 2], direction: [f64; 2], range: f64, mut visit: impl FnMut(usize) -> bool) {
    let mut cell = column_row_of(from);
    let step = direction.map(|part| if part < 0.0 { -1 } else { 1 });
    let apart = direction.map(|part| CELL / part.abs().max(1e-12));
    let mut next: [f64; 2] = std::array::from_fn(|axis| {
        let edge = f64::from(cell[axis] + i32::from(step[axis] > 0)) * CELL;
        (edge - from[axis]).abs() / direction[axis].abs().max(1e-12)
    });
    loop {
        if !index(cell).is_some_and(&mut visit) {
            return;
        }
        let axis = usize::from(next[1] < next[0]);
        if next[axis] > range {
            return;
        }
        cell[axis] += step[axis];
        next[axis] += apart[axis];
    }
}
