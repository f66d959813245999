//! Selection of the object's position and rotation from the comparisons.

use std::f32::consts::PI;

use super::layout::{PLACES, VpitLayout};
use super::params::VpitParams;
use super::template::Comparison;

/// Position and rotation of the object, relative to the centre of the best view.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Found {
    /// Index of that view.
    pub view: usize,
    /// Offset in its frame, in metres.
    pub offset: [f64; 2],
    /// Remaining rotation, in steps from one view to the next.
    pub turn: f64,
    /// Score, 0..=1.
    pub score: f32,
}

/// Returns the best position, from the comparisons of template and views, one view per rotation, the expected one in the
/// middle. `None` when no comparison is finite.
pub(super) fn best(comparisons: &[Comparison], layout: &VpitLayout, params: &VpitParams) -> Option<Found> {
    let straight = comparisons.len() / 2;
    let logit = |alike: f32| layout.scale * alike + layout.bias;
    let mut best: Option<(f32, usize, usize)> = None;
    for (view, comparison) in comparisons.iter().enumerate() {
        let penalty = if view == straight { 1.0 } else { params.rotation_penalty };
        for (place, alike) in comparison.iter().enumerate() {
            let score = penalty / (1.0 + (-logit(*alike)).exp());
            let near = window(place / PLACES) * window(place % PLACES);
            let rank = score * (1.0 - params.window_influence) + near * params.window_influence;
            if rank.is_finite() && best.is_none_or(|(other, ..)| rank > other) {
                best = Some((rank, view, place));
            }
        }
    }
    let (_, view, place) = best?;
    let comparison = comparisons.get(view)?;
    let at = |place: Option<usize>| place.and_then(|place| comparison.get(place)).copied();
    let (row, column) = (place / PLACES, place % PLACES);
    let is_inside = |at: usize| at > 0 && at + 1 < PLACES;
    let beside = |inside: bool, step: usize| {
        let [before, after] =
            [at(place.checked_sub(step)), at(place.checked_add(step))].map(|alike| alike.filter(|_| inside));
        peak(before, comparison[place], after)
    };
    let cell = f64::from(layout.cell());
    let middle = (PLACES / 2) as f64;
    let turned = |view: Option<usize>| Some(comparisons.get(view?)?[place]);
    Some(Found {
        view,
        offset: [
            (column as f64 - middle + beside(is_inside(column), 1)) * cell,
            (row as f64 - middle + beside(is_inside(row), PLACES)) * cell,
        ],
        turn: peak(turned(view.checked_sub(1)), comparison[place], turned(view.checked_add(1))),
        score: 1.0 / (1.0 + (-logit(comparison[place])).exp()),
    })
}

/// Returns Hann's window over the positions, which is 0 outside them.
fn window(at: usize) -> f32 {
    0.5 - 0.5 * (2.0 * PI * (at + 1) as f32 / (PLACES + 1) as f32).cos()
}

/// Returns the maximum of the parabola through three equidistant values, relative to the middle one, in steps.
fn peak(before: Option<f32>, here: f32, after: Option<f32>) -> f64 {
    let (Some(before), Some(after)) = (before, after) else { return 0.0 };
    let bend = f64::from(before) - 2.0 * f64::from(here) + f64::from(after);
    if bend < 0.0 { ((f64::from(before) - f64::from(after)) / 2.0 / bend).clamp(-0.5, 0.5) } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYOUT: VpitLayout = VpitLayout { pillar: 0.2, heights: [-0.5, 3.0], scale: 2.0, bias: -1.0 };

    /// Returns a comparison with its maximum at a row and column.
    fn hill(row: f32, column: f32, top: f32) -> Comparison {
        std::array::from_fn(|at| {
            let (dy, dx) = ((at / PLACES) as f32 - row, (at % PLACES) as f32 - column);
            top - 0.5 * (dx * dx + dy * dy)
        })
    }

    #[test]
    fn maxima_are_interpolated() {
        let params = VpitParams { window_influence: 0.0, ..VpitParams::default() };
        let comparisons = [hill(5.0, 9.25, 1.0), hill(5.0, 9.25, 3.0), hill(5.0, 9.25, 2.0)];
        let found = best(&comparisons, &LAYOUT, &params).unwrap();
        assert_eq!(found.view, 1);
        assert!((found.offset[0] - 1.25 * 0.4).abs() < 1e-5 && (found.offset[1] + 3.0 * 0.4).abs() < 1e-5);
        // The parabola through 1, 3 and 2.
        assert!((found.turn - 1.0 / 6.0).abs() < 1e-5, "{}", found.turn);
        assert!(found.score > 0.99);
    }

    #[test]
    fn invalid_comparisons_have_no_position() {
        let params = VpitParams::default();
        assert_eq!(best(&[[f32::NAN; PLACES * PLACES]; 3], &LAYOUT, &params), None);
        assert_eq!(best(&[], &LAYOUT, &params), None);
        let mut one = [f32::NAN; PLACES * PLACES];
        one[0] = 1.0;
        let found = best(&[one], &LAYOUT, &params).unwrap();
        assert_eq!((found.offset, found.turn), ([-8.0 * f64::from(LAYOUT.cell()); 2], 0.0));
    }
}
