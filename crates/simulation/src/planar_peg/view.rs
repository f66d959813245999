//! The table from above.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_vision::draw::{Colour, Point};

use super::bench::Bench;
use super::{POST, POST_RADIUS, REACH};
use crate::drawing::Drawing;
use crate::planar::vector::Vector2;

const SIDE: usize = 384;
const GRIPPER: Colour = [40, 90, 220];
const PEG: Colour = [225, 140, 40];
const WALL: Colour = [120, 130, 150];

/// 384 x 384 pixels: gripper blue, peg orange, walls and post grey, below the share of the time that has passed.
pub(super) fn draw(bench: &Bench, passed: f64) -> Result<Image> {
    let mut drawing = Drawing::new(SIDE, SIDE)?;
    let colours = [GRIPPER, PEG, WALL, WALL];
    for (body, colour) in bench.world().bodies.iter().zip(colours) {
        for (shape, _) in body.placed().filter(|(shape, _)| shape.corners().len() > 2) {
            let corners: Vec<Point> = shape.corners().iter().map(|corner| place(*corner)).collect();
            drawing.polygon(&corners, colour);
        }
    }
    drawing.disc(place(POST), (POST_RADIUS / REACH * SIDE as f64 / 2.0) as f32, WALL);
    drawing.line([0.0, 2.0], [passed as f32 * SIDE as f32, 2.0], 4.0, GRIPPER);
    Ok(drawing.finish())
}

fn place([x, y]: Vector2) -> Point {
    [x, y].map(|part| ((part / REACH + 1.0) * SIDE as f64 / 2.0) as f32)
}
