//! A view of the robot from above and from the side, with the plan of the gripper.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_vision::draw::{Colour, Point};

use super::episode::Episode;
use crate::drawing::{BLACK, Drawing};
use crate::kinematics::Transform;
use crate::multirotor::Vector;

/// Pixels: the view from above is square, the view from the side lies below it.
const WIDTH: usize = 480;
const TOP: usize = 480;
const SIDE: usize = 160;
/// Pixels of a metre, from above and from the side.
const SCALE: f32 = 42.0;
const SIDE_SCALE: f32 = 90.0;
/// Half of the side of the base, metres.
const HALF_BASE: f64 = 0.325;

const BASE: Colour = [205, 210, 220];
const BASE_PATH: Colour = [150, 170, 210];
const PLAN: Colour = [150, 150, 150];
const ARM: Colour = [40, 70, 140];
const FAILED: Colour = [210, 60, 40];
const GOAL: Colour = [60, 150, 80];

/// Returns 480 x 640 pixels. The arm is blue, and red after a failure of the inverse kinematics; the goal is green.
pub(super) fn draw(episode: &Episode, path: &[[Vector; 2]]) -> Result<Image> {
    let mut drawing = Drawing::new(WIDTH, TOP + SIDE)?;
    let frame = Transform::on_floor(episode.base);
    // The view from the side shows the plane of the base's heading.
    let from_aside = |place: Vector| {
        let seen = frame.relative(&Transform::at(place)).position;
        [WIDTH as f32 / 2.0 + SIDE_SCALE * seen[0] as f32, 12.0 + SIDE_SCALE * seen[2] as f32]
    };
    let corner = |x: f64, y: f64| frame.then(&Transform::at([x * HALF_BASE, y * HALF_BASE, 0.0])).position;
    let corners = [[1.0, 1.0], [-1.0, 1.0], [-1.0, -1.0], [1.0, -1.0]].map(|[x, y]| corner(x, y));
    for pair in path.windows(2).step_by(2) {
        drawing.line(from_above(pair[0][0]), from_above(pair[1][0]), 2.0, BASE_PATH);
    }
    drawing.polygon(&corners.map(from_above), BASE);
    drawing.line(from_above(corner(0.6, 0.0)), from_above(corner(1.0, 0.0)), 3.0, BLACK);
    pose(&mut drawing, &episode.motion.goal, from_above, GOAL);
    let way: Vec<_> = episode.motion.way().map(|pose| pose.position).collect();
    for pair in way.windows(2) {
        drawing.line(from_above(pair[0]), from_above(pair[1]), 1.0, PLAN);
    }
    for pair in path.windows(2).step_by(2) {
        drawing.line(from_above(pair[0][1]), from_above(pair[1][1]), 1.0, ARM);
    }
    let colour = if episode.failures > 0 { FAILED } else { ARM };
    links(&mut drawing, episode, from_above, colour);
    pose(&mut drawing, &episode.gripper, from_above, BLACK);
    // The lower part, over what the view from above has drawn there.
    let (width, side) = (WIDTH as f32, SIDE as f32);
    drawing.polygon(&[[0.0, 0.0], [width, 0.0], [width, side], [0.0, side]], [255; 3]);
    drawing.line([0.0, side], [width, side], 1.0, [200; 3]);
    drawing.line([0.0, 12.0], [width, 12.0], 1.0, [200; 3]);
    let body = [[HALF_BASE, 0.05], [-HALF_BASE, 0.05], [-0.2, 0.8], [0.1, 0.8]];
    let body = body.map(|[x, z]| from_aside(frame.then(&Transform::at([x, 0.0, z])).position));
    drawing.polygon(&body, BASE);
    links(&mut drawing, episode, from_aside, colour);
    pose(&mut drawing, &episode.gripper, from_aside, BLACK);
    pose(&mut drawing, &episode.motion.goal, from_aside, GOAL);
    Ok(drawing.finish())
}

fn links(drawing: &mut Drawing, episode: &Episode, place: impl Fn(Vector) -> Point, colour: Colour) {
    let points: Vec<_> = episode.arm_points().map(place).collect();
    for pair in points.windows(2) {
        drawing.line(pair[0], pair[1], 5.0, colour);
    }
    points.iter().for_each(|point| drawing.disc(*point, 3.5, BLACK));
}

/// Draws a pose as a line in the direction of its tip.
fn pose(drawing: &mut Drawing, pose: &Transform, place: impl Fn(Vector) -> Point, colour: Colour) {
    let tip = pose.then(&Transform::at([0.18, 0.0, 0.0]));
    drawing.line(place(pose.position), place(tip.position), 3.0, colour);
    drawing.disc(place(pose.position), 4.0, colour);
}

fn from_above([x, y, _]: Vector) -> Point {
    [WIDTH as f32 / 2.0 + SCALE * x as f32, SIDE as f32 + TOP as f32 / 2.0 + SCALE * y as f32]
}
