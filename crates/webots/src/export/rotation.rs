//! Rotations as Webots writes them.

use opendr_simulation::raycast::Vector;

use super::world::UPRIGHT;

/// Returns axis and angle of the rotation whose axes these are.
pub(super) fn axis_angle(axes: [Vector; 3]) -> [f64; 4] {
    // Column `j` of the matrix is axis `j`.
    let at = |row: usize, column: usize| f64::from(axes[column][row]);
    let twice = [at(2, 1) - at(1, 2), at(0, 2) - at(2, 0), at(1, 0) - at(0, 1)];
    let sine = twice.iter().map(|part| part * part).sum::<f64>().sqrt();
    let angle = sine.atan2(at(0, 0) + at(1, 1) + at(2, 2) - 1.0);
    if angle < 1e-9 {
        return UPRIGHT;
    }
    if sine > 1e-4 {
        return [twice[0] / sine, twice[1] / sine, twice[2] / sine, angle];
    }
    // Half a turn: the matrix is 2 a a^T - 1.
    let largest = (1..3).fold(0, |best, axis| if at(axis, axis) > at(best, best) { axis } else { best });
    let length = ((at(largest, largest) + 1.0) / 2.0).max(0.0).sqrt();
    let part = |axis: usize| if axis == largest { length } else { at(axis, largest) / (2.0 * length) };
    [part(0), part(1), part(2), angle]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn turns_are_read_from_axes() {
        let close = |one: [f64; 4], other: [f64; 4]| {
            one.iter().zip(other).all(|(one, other)| (one - other).abs() < 1e-6)
        };
        let quarter = [[0.0, 1.0, 0.0], [-1.0, 0.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(close(axis_angle(quarter), [0.0, 0.0, 1.0, std::f64::consts::FRAC_PI_2]));
        let half = [[-1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]];
        assert!(close(axis_angle(half), [0.0, 1.0, 0.0, std::f64::consts::PI]));
        let none = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, 1.0]];
        assert!(close(axis_angle(none), UPRIGHT));
    }
}
