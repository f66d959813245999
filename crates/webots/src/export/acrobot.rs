//! Acrobot: two links, with a motor of 1 N m at the joint between them.

use super::episode::Episode;
use super::link::Link;
use super::world::{Physics, World, robot};

/// Moment of inertia of a link about its centre of mass, as in Sutton and Barto.
const INERTIA: f64 = 1.0;
const LENGTH: f64 = 1.0;
const HALF: f64 = 0.5;

pub(super) fn world(episode: &Episode) -> World {
    let angle = |index: usize| episode.number(index + 1).atan2(episode.number(index));
    let [first, second] = [angle(0), angle(2)];
    let [turning, relative] = [episode.number(4), episode.number(5)];
    // Velocity of a point at `distance` below a joint, for a turn about y.
    let at = |angle: f64, turning: f64, distance: f64| {
        [-distance * turning * angle.cos(), 0.0, distance * turning * angle.sin()]
    };
    let (elbow, lower) = (at(first, turning, LENGTH), at(first + second, turning + relative, HALF));
    let lower = Link {
        name: "lower",
        anchor: [0.0, 0.0, -LENGTH],
        angle: second,
        velocity: std::array::from_fn(|axis| elbow[axis] + lower[axis]),
        turning: turning + relative,
        inertia: INERTIA,
        torque: Some(1.0),
        children: Vec::new(),
    };
    let upper = Link {
        name: "upper",
        anchor: [0.0; 3],
        angle: first,
        velocity: at(first, turning, HALF),
        turning,
        inertia: INERTIA,
        torque: None,
        children: vec![lower.joint()],
    };
    let physics = Physics { step_ms: 10.0, gravity: 9.8 };
    World::new(episode, &physics, [0.0, -7.0, 0.0], [0.0, 0.0, 1.0, std::f64::consts::FRAC_PI_2])
        .with(robot("acrobot", vec![upper.joint()]))
}
