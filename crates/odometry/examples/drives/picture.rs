//! A map of trajectories.

use std::path::Path;

use opendr_engine::Result;
use opendr_engine::data::Image;
use opendr_odometry::Trajectory;
use opendr_vision::draw::{Canvas, Colour};
use opendr_vision::save;

const SIDE: usize = 720;
const MARGIN: f32 = 90.0;
/// Truth, before and after loops were closed: grey, orange and blue.
const COLOURS: [Colour; 3] = [[150, 150, 150], [226, 124, 28], [30, 96, 200]];

/// Factor by which errors are enlarged.
const ENLARGED: f64 = 20.0;

/// Draws trajectories of the same poses from above, with squares of ten metres and errors enlarged.
pub fn draw_map(trajectories: &[&Trajectory; 3], path: &Path) -> Result<()> {
    let mut image = Image::from_rgb8(vec![255; 3 * SIDE * SIDE], SIDE, SIDE)?;
    let (mut low, mut high) = ([f64::INFINITY; 2], [f64::NEG_INFINITY; 2]);
    for stamped in trajectories.iter().flat_map(|trajectory| trajectory.poses()) {
        for axis in 0..2 {
            low[axis] = low[axis].min(stamped.pose.position[axis]);
            high[axis] = high[axis].max(stamped.pose.position[axis]);
        }
    }
    let scale = (SIDE as f32 - 2.0 * MARGIN) / (high[0] - low[0]).max(high[1] - low[1]).max(1.0) as f32;
    let place = |x: f64, y: f64| {
        [MARGIN + scale * (x - low[0]) as f32, SIDE as f32 - MARGIN - scale * (y - low[1]) as f32]
    };
    let mut canvas = Canvas::over(&mut image);
    for line in 0..((high[0] - low[0]).max(high[1] - low[1]) / 10.0) as usize + 1 {
        let at = 10.0 * line as f64;
        let ends = [0.0, SIDE as f32];
        let [x, y] = place(low[0] + at, low[1] + at);
        canvas.line([x, ends[0]], [x, ends[1]], 1.0, [228, 228, 228], 1.0);
        canvas.line([ends[0], y], [ends[1], y], 1.0, [228, 228, 228], 1.0);
    }
    for ((trajectory, colour), thickness) in trajectories.iter().zip(COLOURS).zip([7.0, 2.5, 2.5]) {
        let places: Vec<_> = trajectory
            .poses()
            .iter()
            .zip(trajectories[0].poses())
            .map(|(stamped, truth)| {
                let [own, exact] = [stamped, truth].map(|stamped| stamped.pose.position);
                let [x, y] = [0, 1].map(|axis| exact[axis] + ENLARGED * (own[axis] - exact[axis]));
                place(x, y)
            })
            .collect();
        for pair in places.windows(2) {
            let (from, to) = (pair[0], pair[1]);
            canvas.line(from, to, thickness, colour, 1.0);
        }
    }
    save(&image, path)
}
