//! The flat from above: what the robot knows, where it was, what it has found.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_vision::draw::{Colour, Point};

use super::episode::Episode;
use super::frontiers::Candidate;
use super::grid::{CELLS, middle};
use super::{CELL, Cell, SIDE};
use crate::drawing::{BLACK, Drawing};
use crate::sine_cosine::sine_cosine;

/// Pixels of a cell and of the whole view.
const PIXELS: f32 = 5.0;
const WIDTH: usize = SIDE * PIXELS as usize;

const UNKNOWN: Colour = [215, 218, 224];
const HIDDEN_WALL: Colour = [190, 194, 202];
const WALL: Colour = [60, 64, 72];
const ROBOT: Colour = [30, 90, 200];
const FOUND: Colour = [60, 160, 80];
const SEEN: Colour = [235, 160, 40];
const HIDDEN: Colour = [200, 110, 110];
const FRONTIER: Colour = [150, 60, 170];

/// Returns 500 x 500 pixels: known free places are white, objects green where found, orange where seen, else pale red.
pub(super) fn draw(episode: &Episode, path: &[[f64; 2]], candidates: Option<&[Candidate]>) -> Result<Image> {
    let mut drawing = Drawing::new(WIDTH, WIDTH)?;
    for cell in 0..CELLS {
        let colour = match (episode.map.cell(cell), episode.plan.occupies(cell)) {
            (Cell::Free, _) => continue,
            (Cell::Occupied, _) => WALL,
            (Cell::Unknown, true) => HIDDEN_WALL,
            (Cell::Unknown, false) => UNKNOWN,
        };
        drawing.turned_box(pixel(middle(cell)), [PIXELS / 2.0; 2], (0.0, 1.0), colour);
    }
    for pair in path.windows(2) {
        drawing.line(pixel(pair[0]), pixel(pair[1]), 2.0, ROBOT);
    }
    for (at, object) in episode.plan.objects().iter().enumerate() {
        let colour = match (episode.found[at], episode.seen[at]) {
            (true, _) => FOUND,
            (_, true) => SEEN,
            _ => HIDDEN,
        };
        drawing.turned_box(pixel(*object), [6.0; 2], (0.0, 1.0), colour);
    }
    for candidate in candidates.unwrap_or_default() {
        drawing.disc(pixel(middle(candidate.look)), 4.0, FRONTIER);
    }
    let [x, y, yaw] = episode.pose;
    let (sine, cosine) = sine_cosine(yaw);
    drawing.disc(pixel([x, y]), 10.0, ROBOT);
    drawing.line(pixel([x, y]), pixel([x + 0.3 * cosine, y + 0.3 * sine]), 3.0, BLACK);
    Ok(drawing.finish())
}

fn pixel(place: [f64; 2]) -> Point {
    place.map(|part| part as f32 / CELL as f32 * PIXELS)
}
