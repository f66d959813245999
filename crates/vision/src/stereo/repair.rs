//! Removal of speckles, and filling of holes.

use crate::components::{Components, Connectivity};

use super::winner::UNKNOWN;

/// Removes disparities in speckles of at most `most` pixels; neighbours are connected where they differ by at most
/// `step`.
pub(super) fn remove_speckles(
    map: &mut [f32],
    size: [usize; 2],
    most: u32,
    step: f32,
    components: &mut Components,
) {
    components.label(size, Connectivity::Four, |at| map[at] >= 0.0, |a, b| (map[a] - map[b]).abs() <= step);
    for (disparity, label) in map.iter_mut().zip(components.labels()) {
        if components.areas()[*label as usize] <= most {
            *disparity = UNKNOWN;
        }
    }
}

/// Fills unknown disparities with the smaller one of the nearest known neighbours in the row, because occluded areas
/// belong to the background. Rows without a known disparity are unchanged.
pub(super) fn fill_holes(map: &mut [f32], width: usize) {
    for row in map.chunks_exact_mut(width) {
        let mut at = 0;
        while at < width {
            if row[at] >= 0.0 {
                at += 1;
                continue;
            }
            let end = row[at..].iter().position(|disparity| *disparity >= 0.0).map(|count| at + count);
            let before = at.checked_sub(1).map(|before| row[before]);
            let after = end.map(|end| row[end]);
            let filled = match (before, after) {
                (Some(before), Some(after)) => before.min(after),
                (one, other) => one.or(other).unwrap_or(UNKNOWN),
            };
            let end = end.unwrap_or(width);
            row[at..end].fill(filled);
            at = end;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn speckles_are_removed_and_holes_filled_from_the_background() {
        let mut map = [9.0, 9.0, -1.0, 4.0, 4.0, 4.5, 9.0, 20.0, 4.0, 4.0];
        remove_speckles(&mut map, [5, 2], 1, 1.0, &mut Components::default());
        assert_eq!(map, [9.0, 9.0, -1.0, 4.0, 4.0, -1.0, 9.0, -1.0, 4.0, 4.0]);
        fill_holes(&mut map, 5);
        assert_eq!(map, [9.0, 9.0, 4.0, 4.0, 4.0, 9.0, 9.0, 4.0, 4.0, 4.0]);
        let mut nothing = [-1.0; 3];
        fill_holes(&mut nothing, 3);
        assert_eq!(nothing, [-1.0; 3]);
    }
}
