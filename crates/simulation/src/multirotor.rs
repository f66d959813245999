//! Rigid-body mechanics of a quadrotor and its attitude control, shared by the environments that fly one.
//!
//! The airframe is about a Holybro X500. The attitude is held by the geometric controller of Lee, Leok and McClamroch (Geometric
//! tracking control of a quadrotor UAV on SE(3), 2010). Metres, seconds, newtons; x ahead, y left, z up.

use opendr_engine::Result;
use opendr_engine::environment::StateReader;

pub(crate) type Vector = [f64; 3];
/// Columns are the body's axes in the world.
pub(crate) type Matrix = [Vector; 3];

pub(crate) const GRAVITY: f64 = 9.81;
/// Mass, kg.
pub(crate) const MASS: f64 = 1.5;
/// Moments of inertia, kg m^2.
pub(crate) const INERTIA: Vector = [0.02, 0.02, 0.035];
/// Distance of a rotor from the x and y axes, metres.
const ARM: f64 = 0.17;
/// Torque about z for each newton of thrust.
const YAW_PER_THRUST: f64 = 0.016;
/// Largest thrust of a rotor: twice the weight with all four.
const MAX_THRUST: f64 = 2.0 * MASS * GRAVITY / 4.0;
/// Drag in proportion to airspeed (N s/m) and to its square (N s^2/m^2).
pub(crate) const DRAG: [f64; 2] = [0.3, 0.03];
/// Positions of the rotors in arms, and the direction in which they turn the body.
const ROTORS: [[f64; 3]; 4] = [[1.0, 1.0, 1.0], [1.0, -1.0, -1.0], [-1.0, 1.0, -1.0], [-1.0, -1.0, 1.0]];
/// Stiffness and damping of the attitude about each axis, 1/s^2 and 1/s.
const ATTITUDE_GAINS: [[f64; 2]; 3] = [[60.0, 14.0], [60.0, 14.0], [12.0, 7.0]];

/// The body's axes (ahead, left, up) in the world for an attitude w, x, y, z.
pub(crate) fn axes([w, x, y, z]: [f64; 4]) -> Matrix {
    [
        [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y + w * z), 2.0 * (x * z - w * y)],
        [2.0 * (x * y - w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z + w * x)],
        [2.0 * (x * z + w * y), 2.0 * (y * z - w * x), 1.0 - 2.0 * (x * x + y * y)],
    ]
}

/// Advances attitude and body rates by `seconds` under the thrusts of the rotors (Euler's equations).
pub(crate) fn turn(attitude: &mut [f64; 4], rates: &mut Vector, thrusts: [f64; 4], seconds: f64) {
    let mut torque = [0.0; 3];
    for (thrust, [x, y, spin]) in thrusts.iter().zip(ROTORS) {
        torque = plus(torque, [y * ARM, -x * ARM, spin * YAW_PER_THRUST], *thrust);
    }
    let momentum: Vector = std::array::from_fn(|axis| INERTIA[axis] * rates[axis]);
    let torque = minus(torque, cross(*rates, momentum), 1.0);
    *rates = std::array::from_fn(|axis| rates[axis] + seconds * torque[axis] / INERTIA[axis]);
    let ([w, x, y, z], [p, q, r]) = (*attitude, rates.map(|rate| rate * seconds / 2.0));
    let turned = [
        w - x * p - y * q - z * r,
        x + w * p + y * r - z * q,
        y + w * q + z * p - x * r,
        z + w * r + x * q - y * p,
    ];
    let size = turned.iter().map(|part| part * part).sum::<f64>().sqrt();
    *attitude = turned.map(|part| part / size);
}

/// Commanded thrusts that turn the body towards `force` (m/s^2, gravity included) with a heading given by its cosine and sine.
pub(crate) fn thrusts_towards(
    force: Vector,
    [cosine, sine]: [f64; 2],
    axes: &Matrix,
    rates: Vector,
) -> [f64; 4] {
    let up = unit(force);
    let left = unit(cross(up, [cosine, sine, 0.0]));
    let wanted = [cross(left, up), left, up];
    // Half of the skew part of (wanted^T axes), as a vector.
    let error = |a: usize, b: usize| (dot(wanted[a], axes[b]) - dot(axes[a], wanted[b])) / 2.0;
    let errors = [error(2, 1), error(0, 2), error(1, 0)];
    let torque: Vector = std::array::from_fn(|axis| {
        let [stiffness, damping] = ATTITUDE_GAINS[axis];
        -INERTIA[axis] * (stiffness * errors[axis] + damping * rates[axis])
    });
    let total = MASS * dot(force, axes[2]);
    ROTORS.map(|[x, y, spin]| {
        let thrust = total + (y * torque[0] - x * torque[1]) / ARM + spin * torque[2] / YAW_PER_THRUST;
        (thrust / 4.0).clamp(0.0, MAX_THRUST)
    })
}

/// The next numbers of a snapshot.
pub(crate) fn numbers<const N: usize>(state: &mut StateReader<'_>) -> Result<[f64; N]> {
    let mut numbers = [0.0; N];
    for number in &mut numbers {
        *number = state.finite()?;
    }
    Ok(numbers)
}

pub(crate) fn dot(a: Vector, b: Vector) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub(crate) fn cross(a: Vector, b: Vector) -> Vector {
    [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
}

pub(crate) fn plus(a: Vector, b: Vector, times: f64) -> Vector {
    std::array::from_fn(|axis| a[axis] + times * b[axis])
}

pub(crate) fn minus(a: Vector, b: Vector, times: f64) -> Vector {
    plus(a, b, -times)
}

/// `vector` is not zero.
pub(crate) fn unit(vector: Vector) -> Vector {
    let size = dot(vector, vector).sqrt();
    vector.map(|part| part / size)
}
