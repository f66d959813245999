//! The loss of a batch and its gradient.

use super::network::{CELL, CELLS, GRID, MAPS, OUTPUTS, probability};

/// Spread of the presence of a jaw over cells, in cells.
const SPREAD: f32 = 0.6;
/// Weight of a cell with a jaw against one without.
const PRESENT: f32 = 10.0;
/// Presence from which on a cell states the place, and the weight of the place.
const PLACED: f32 = 0.25;
const PLACE: f32 = 2.0;

/// Adds up the loss of an output, `[2, 3, 12, 12]`, and writes its gradient times `share`. Without jaws, none is present.
pub(super) fn loss(output: &[f32], jaws: Option<&[[f32; 2]; 2]>, share: f32, gradient: &mut [f32]) -> f32 {
    debug_assert_eq!(output.len(), OUTPUTS);
    gradient.fill(0.0);
    let mut sum = 0.0;
    for jaw in 0..2 {
        let range = jaw * MAPS * CELLS..(jaw + 1) * MAPS * CELLS;
        let (output, gradient) = (&output[range.clone()], &mut gradient[range]);
        let place = jaws.map(|jaws| jaws[jaw].map(|part| part / CELL as f32));
        for cell in 0..CELLS {
            let middle = [cell % GRID, cell / GRID].map(|at| at as f32 + 0.5);
            let off = place.map(|place| [place[0] - middle[0], place[1] - middle[1]]);
            let present = off.map_or(0.0, presence);
            let (logit, likely) = (output[cell], probability(output[cell]));
            let weight = 1.0 + (PRESENT - 1.0) * present;
            // Cross-entropy, in a form that does not overflow.
            sum += weight * (logit.max(0.0) - logit * present + (-logit.abs()).exp().ln_1p());
            gradient[cell] = share * weight * (likely - present);
            if let Some(off) = off.filter(|_| present > PLACED) {
                for (axis, off) in off.into_iter().enumerate() {
                    let at = (axis + 1) * CELLS + cell;
                    let error = output[at] - off;
                    sum += PLACE * smooth(error);
                    gradient[at] = share * PLACE * error.clamp(-SMOOTH, SMOOTH) / SMOOTH;
                }
            }
        }
    }
    sum * share
}

/// Distance from which on the loss of a place is linear, cells.
const SMOOTH: f32 = 0.1;

fn smooth(error: f32) -> f32 {
    let size = error.abs();
    if size < SMOOTH { 0.5 * size * size / SMOOTH } else { size - 0.5 * SMOOTH }
}

/// Returns the presence of a jaw at a place from the middle of a cell: 1 in the cell, less around it.
fn presence([x, y]: [f32; 2]) -> f32 {
    match x.abs() <= 0.5 && y.abs() <= 0.5 {
        true => 1.0,
        false => (-0.5 * (x * x + y * y) / (SPREAD * SPREAD)).exp(),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_gradient_is_that_of_the_loss() {
        let jaws = [[30.0, 41.0], [55.0, 20.0]];
        let output: Vec<f32> = (0..OUTPUTS).map(|at| ((at * 37 % 101) as f32 / 50.0 - 1.0) * 0.8).collect();
        let (mut gradient, mut unused) = (vec![0.0; OUTPUTS], vec![0.0; OUTPUTS]);
        loss(&output, Some(&jaws), 0.5, &mut gradient);
        for at in (0..OUTPUTS).step_by(13) {
            let mut at_side = |side: f32| {
                let mut moved = output.clone();
                moved[at] += side * 1e-2;
                f64::from(loss(&moved, Some(&jaws), 0.5, &mut unused))
            };
            let slope = (at_side(1.0) - at_side(-1.0)) / 2e-2;
            assert!((slope - f64::from(gradient[at])).abs() < 2e-2, "{at}: {slope} {}", gradient[at]);
        }
    }
}
