//! A view of the flight from above and from the side, with the reference, the path so far and the wind.

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_vision::draw::{Colour, Point};

use super::CONTROL_PERIOD;
use super::episode::Episode;
use crate::drawing::{BLACK, Drawing};
use crate::multirotor::{Vector, plus};

/// Pixels: the view from above is square, the view from the side lies below it.
const WIDTH: usize = 480;
const TOP: usize = 480;
const SIDE: usize = 160;
/// Pixels of a metre, and the height in the middle of the view from the side.
const SCALE: f32 = 70.0;
const MIDDLE: f64 = 6.0;
/// How much of the reference and of the path is drawn, seconds.
const SHOWN: f64 = 8.0;
/// The rotors are drawn this far from the centre, metres: larger than they are.
const ARM: f64 = 0.25;

const REFERENCE: Colour = [150, 150, 150];
const PATH: Colour = [30, 90, 200];
const CHANGED: Colour = [210, 60, 40];

/// 480 x 640 pixels; the path is blue, and red from the moment when the plant changes.
pub(super) fn draw(episode: &Episode, path: &[Vector]) -> Result<Image> {
    let mut drawing = Drawing::new(WIDTH, TOP + SIDE)?;
    drawing.line([0.0, SIDE as f32], [WIDTH as f32, SIDE as f32], 1.0, [200; 3]);
    let places: [fn(Vector) -> Point; 2] = [from_above, from_aside];
    let now = episode.time();
    for place in places {
        let at = |step: i32| place(episode.reference.at(now + 0.05 * f64::from(step)).position);
        let ahead = (SHOWN / 0.05) as i32;
        (-ahead..0).for_each(|step| drawing.line(at(step), at(step + 1), 1.0, REFERENCE));
        let last = path.len().saturating_sub(1);
        let first = last.saturating_sub((SHOWN / CONTROL_PERIOD) as usize);
        let steps: Vec<usize> = (first..=last).rev().step_by(4).collect();
        for pair in steps.windows(2) {
            let begun = last as f64 - pair[0] as f64;
            let changed = now - CONTROL_PERIOD * begun >= episode.options.change_at;
            let colour = if changed { CHANGED } else { PATH };
            drawing.line(place(path[pair[0]]), place(path[pair[1]]), 2.0, colour);
        }
        drawing.disc(place(episode.reference.at(now).position), 5.0, REFERENCE);
        let axes = episode.plant.axes();
        for [x, y] in [[1.0, 1.0], [1.0, -1.0]] {
            let arm = plus(axes[0].map(|part| part * x), axes[1], y);
            let [one, other] = [ARM, -ARM].map(|side| place(plus(episode.plant.position, arm, side)));
            drawing.line(one, other, 3.0, BLACK);
            [one, other].into_iter().for_each(|rotor| drawing.disc(rotor, 5.0, BLACK));
        }
    }
    let [x, y, _] = episode.wind();
    let tail = [60.0, (SIDE + TOP) as f32 - 60.0];
    let tip = [tail[0] + 8.0 * x as f32, tail[1] + 8.0 * y as f32];
    drawing.disc(tail, 3.0, [90, 160, 90]);
    drawing.line(tail, tip, 3.0, [90, 160, 90]);
    Ok(drawing.finish())
}

fn from_above([x, y, _]: Vector) -> Point {
    [WIDTH as f32 / 2.0 + SCALE * x as f32, SIDE as f32 + TOP as f32 / 2.0 + SCALE * y as f32]
}

fn from_aside([x, _, z]: Vector) -> Point {
    let [column, _] = from_above([x, 0.0, z]);
    [column, SIDE as f32 / 2.0 + SCALE * (z - MIDDLE) as f32]
}
