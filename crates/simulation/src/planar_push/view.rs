//! The table from above.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_vision::draw::{Colour, Point};

use super::table::{GOAL, Table};
use super::{PUSHER_RADIUS, REACH};
use crate::drawing::Drawing;
use crate::planar::Body;
use crate::planar::vector::Vector2;

const SIDE: usize = 384;
const GOAL_COLOUR: Colour = [170, 225, 170];
const TEE: Colour = [120, 130, 150];
const PUSHER: Colour = [40, 90, 220];

/// 384 x 384 pixels: the goal green, the T grey, the pusher blue, below the share of the time that has passed.
pub(super) fn draw(table: &Table, passed: f64) -> Result<Image> {
    let mut drawing = Drawing::new(SIDE, SIDE)?;
    let mut goal = table.tee().clone();
    goal.pose = GOAL;
    fill(&mut drawing, &goal, GOAL_COLOUR);
    fill(&mut drawing, table.tee(), TEE);
    let radius = PUSHER_RADIUS / REACH * SIDE as f64 / 2.0;
    drawing.disc(place(table.pusher()), radius as f32, PUSHER);
    drawing.line([0.0, 2.0], [passed as f32 * SIDE as f32, 2.0], 4.0, PUSHER);
    Ok(drawing.finish())
}

fn fill(drawing: &mut Drawing, body: &Body, colour: Colour) {
    for (shape, _) in body.placed() {
        let corners: Vec<Point> = shape.corners().iter().map(|corner| place(*corner)).collect();
        drawing.polygon(&corners, colour);
    }
}

fn place([x, y]: Vector2) -> Point {
    [x, y].map(|part| ((part / REACH + 1.0) * SIDE as f64 / 2.0) as f32)
}
