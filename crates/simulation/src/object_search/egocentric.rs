//! The map around the robot, turned so that it looks up.

use super::{Cell, KnownMap};
use crate::sine_cosine::sine_cosine;

/// Cells of an egocentric map in each direction.
pub(super) const WIDTH: usize = 32;
/// Channels: free, occupied, objects that are seen but not found.
pub(super) const CHANNELS: usize = 3;
/// Number of values.
pub(super) const VALUES: usize = WIDTH * WIDTH * CHANNELS;

/// Writes the map around a pose: rows from ahead to behind, columns from left to right, each cell of `side` metres seen at
/// `samples` x `samples` places. A cell is occupied if any place is, free if any is and none is occupied.
pub(super) fn write(
    map: &KnownMap,
    [x, y, yaw]: [f64; 3],
    objects: impl Iterator<Item = [f64; 2]>,
    (side, samples): (f64, usize),
    values: &mut [f32],
) {
    let (sine, cosine) = sine_cosine(yaw);
    values.fill(0.0);
    let half = WIDTH as f64 / 2.0;
    for (at, value) in values.chunks_exact_mut(CHANNELS).enumerate() {
        let (row, column) = (at / WIDTH, at % WIDTH);
        let (mut free, mut occupied) = (false, false);
        for part in 0..samples * samples {
            let [down, right] = [part / samples, part % samples].map(|at| (at as f64 + 0.5) / samples as f64);
            let ahead = (half - row as f64 - down) * side;
            let left = (half - column as f64 - right) * side;
            match map.at([x + cosine * ahead - sine * left, y + sine * ahead + cosine * left]) {
                Cell::Free => free = true,
                Cell::Occupied => occupied = true,
                Cell::Unknown => (),
            }
        }
        value[0] = f32::from(free && !occupied);
        value[1] = f32::from(occupied);
    }
    for [to_x, to_y] in objects {
        let [right, up] = [to_x - x, to_y - y];
        let (ahead, left) = (cosine * right + sine * up, cosine * up - sine * right);
        let [row, column] = [half - ahead / side, half - left / side];
        let inside = |at: f64| (0.0..WIDTH as f64).contains(&at).then_some(at as usize);
        if let (Some(row), Some(column)) = (inside(row), inside(column))
            && let Some(value) = values.get_mut((row * WIDTH + column) * CHANNELS + 2)
        {
            *value = 1.0;
        }
    }
}
