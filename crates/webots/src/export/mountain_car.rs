//! Mountain cars. Their equations are not those of a car on a slope, so a controller places the car.

use super::episode::Episode;
use super::node::Node;
use super::world::{Physics, UPRIGHT, World, cuboid, placed, robot, shape};

/// Ends of the track.
const TRACK: (f64, f64) = (-1.2, 0.6);
const STRIPS: usize = 90;
const HALF_WIDTH: f64 = 0.15;
const GOAL: f64 = 0.5;

fn height(x: f64) -> f64 {
    0.45 * (3.0 * x).sin() + 0.55
}

pub(super) fn world(episode: &Episode) -> World {
    let x = episode.number(0);
    let slope = (1.35 * (3.0 * x).cos()).atan();
    let car =
        vec![shape(cuboid([0.1, 0.06, 0.04]), [0.1, 0.1, 0.1]), Node::new("GPS").text("name", "position")];
    let robot = robot("car", car)
        .numbers("translation", &[x, 0.0, height(x) + 0.02])
        .numbers("rotation", &[0.0, 1.0, 0.0, -slope]);
    let flag = shape(cuboid([0.01, 0.01, 0.2]), [0.8, 0.1, 0.1]);
    let physics = Physics { step_ms: 32.0, gravity: 9.81 };
    World::new(episode, &physics, [-0.3, -3.0, 0.7], [0.0, 0.0, 1.0, std::f64::consts::FRAC_PI_2])
        .with(hill())
        .with(placed([GOAL, 0.1, height(GOAL) + 0.1], UPRIGHT, vec![flag]))
        .with(robot)
}

/// A strip of quadrilaterals along the track.
fn hill() -> Node {
    let at = |strip: usize| TRACK.0 + (TRACK.1 - TRACK.0) * strip as f64 / STRIPS as f64;
    let edge = |x: f64| [x, -HALF_WIDTH, height(x), x, HALF_WIDTH, height(x)];
    let points: Vec<_> = (0..=STRIPS).flat_map(|strip| edge(at(strip))).collect();
    let face =
        |strip: usize| [2 * strip, 2 * strip + 2, 2 * strip + 3, 2 * strip + 1].map(|corner| corner as f64);
    let faces: Vec<_> = (0..STRIPS).flat_map(|strip| face(strip).into_iter().chain([-1.0])).collect();
    let geometry = Node::new("IndexedFaceSet")
        .node("coord", Node::new("Coordinate").list("point", &points, 3))
        .list("coordIndex", &faces, 5);
    shape(geometry, [0.3, 0.6, 0.3])
}
