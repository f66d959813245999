//! Rendering of the classic environments, in the sizes, proportions and colours of Gymnasium.

use opendr_engine::Result;
use opendr_engine::data::Image;

use crate::drawing::{BLACK, Drawing};
use crate::sine_cosine::sine_cosine;

fn single((sine, cosine): (f64, f64)) -> (f32, f32) {
    (sine as f32, cosine as f32)
}

/// Renders a cart on a rail, 600 x 400 pixels.
pub(super) fn cart_pole([x, _, angle, _]: [f64; 4]) -> Result<Image> {
    const SCALE: f32 = 600.0 / 4.8;
    let mut drawing = Drawing::new(600, 400)?;
    let centre = [x as f32 * SCALE + 300.0, 100.0];
    drawing.line([0.0, 100.0], [600.0, 100.0], 1.0, BLACK);
    drawing.turned_box(centre, [25.0, 15.0], (0.0, 1.0), BLACK);
    let (sine, cosine) = single(sine_cosine(angle));
    let axle = [centre[0], centre[1] + 7.5];
    // The pole starts half its width below the axle.
    let middle = SCALE / 2.0 - 5.0;
    let pole = [axle[0] + middle * sine, axle[1] + middle * cosine];
    drawing.turned_box(pole, [5.0, SCALE / 2.0], (-sine, cosine), [202, 152, 101]);
    drawing.disc(axle, 5.0, [129, 132, 203]);
    Ok(drawing.finish())
}

/// Renders a rod around its axle, 500 x 500 pixels.
pub(super) fn pendulum([angle, _]: [f64; 2]) -> Result<Image> {
    const SCALE: f32 = 500.0 / 4.4;
    let mut drawing = Drawing::new(500, 500)?;
    let (sine, cosine) = single(sine_cosine(angle));
    let end = [250.0 - SCALE * sine, 250.0 + SCALE * cosine];
    drawing.line([250.0; 2], end, 0.2 * SCALE, [204, 77, 77]);
    drawing.disc([250.0; 2], 0.05 * SCALE, BLACK);
    Ok(drawing.finish())
}

/// Renders two links and the goal line, 500 x 500 pixels.
pub(super) fn acrobot([first, second, ..]: [f64; 4]) -> Result<Image> {
    const SCALE: f32 = 500.0 / 4.4;
    let mut drawing = Drawing::new(500, 500)?;
    drawing.line([0.0, 250.0 + SCALE], [500.0, 250.0 + SCALE], 1.0, BLACK);
    let mut joint = [250.0; 2];
    for angle in [first, first + second] {
        let (sine, cosine) = single(sine_cosine(angle));
        let end = [joint[0] + SCALE * sine, joint[1] - SCALE * cosine];
        let middle = [(joint[0] + end[0]) / 2.0, (joint[1] + end[1]) / 2.0];
        drawing.turned_box(middle, [0.1 * SCALE, SCALE / 2.0], (sine, cosine), [0, 204, 204]);
        drawing.disc(joint, 0.1 * SCALE, [204, 204, 0]);
        joint = end;
    }
    Ok(drawing.finish())
}

/// Renders a car between hills and a flag at the goal, 600 x 400 pixels.
pub(super) fn mountain_car(position: f64, goal: f64) -> Result<Image> {
    const SCALE: f32 = 600.0 / 1.8;
    let on_hill = |x: f64| {
        let height = sine_cosine(3.0 * x).0 * 0.45 + 0.55;
        [(x as f32 + 1.2) * SCALE, height as f32 * SCALE]
    };
    let mut drawing = Drawing::new(600, 400)?;
    for step in 0..99 {
        let [from, to] = [step, step + 1].map(|step| on_hill(-1.2 + 1.8 * f64::from(step) / 99.0));
        drawing.line(from, to, 1.0, BLACK);
    }
    // As in Gymnasium, the car is rotated by the cosine of the slope as if it were the angle.
    let (sine, cosine) = single(sine_cosine(sine_cosine(3.0 * position).1));
    let [x, y] = on_hill(position);
    let place = |ahead: f32, up: f32| [x + cosine * ahead - sine * up, y + 10.0 + sine * ahead + cosine * up];
    drawing.turned_box(place(0.0, 10.0), [20.0, 10.0], (sine, cosine), BLACK);
    for ahead in [-10.0, 10.0] {
        drawing.disc(place(ahead, 0.0), 8.0, [128; 3]);
    }
    let [x, y] = on_hill(goal);
    drawing.line([x, y], [x, y + 50.0], 1.0, BLACK);
    drawing.polygon(&[[x, y + 50.0], [x, y + 40.0], [x + 25.0, y + 45.0]], [204, 204, 0]);
    Ok(drawing.finish())
}
