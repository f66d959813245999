//! Synthetic images of the demonstrated object.

use opendr_engine::Random;

use super::cutout::Cutout;
use super::network::{SIDE, SQUARE};

/// Share of the images without the object, and with something that covers part of it.
const ABSENT: f32 = 0.12;
const COVERED: f32 = 0.3;
/// Range of scales.
const SCALES: [f32; 2] = [0.85, 1.18];
/// Farthest place of the grasp from the middle, pixels.
const SHIFT: f32 = 0.34 * SIDE as f32;
/// Share of the images with the background of the demonstration.
const OWN_BACKGROUND: f32 = 0.25;
/// Most things that lie around.
const CLUTTER: usize = 3;

/// An image of an augmentation, `[3, SIDE, SIDE]` levels about 0..=1, with its jaws; none without the object.
pub(super) fn augment(cutout: &Cutout, random: &mut Random, planes: &mut [f32]) -> Option<[[f32; 2]; 2]> {
    background(cutout, random, planes);
    for _ in 0..random.below(CLUTTER + 1) {
        rectangle(random, [4.0, 30.0], planes);
    }
    let jaws = if random.chance(ABSENT) { None } else { Some(place(cutout, random, planes)) };
    if random.chance(COVERED) {
        rectangle(random, [5.0, 16.0], planes);
    }
    relight(random, planes);
    jaws
}

/// Fills an image with a colour, a gradient and grain.
fn background(cutout: &Cutout, random: &mut Random, planes: &mut [f32]) {
    let grey = random.uniform(0.1, 0.95);
    let colour = match random.chance(OWN_BACKGROUND) {
        true => cutout.background,
        false => [(); 3].map(|()| grey + random.uniform(-0.2, 0.2)),
    };
    let (grain, cell) = (random.uniform(0.0, 0.08), 1 + random.below(8));
    let cells = SIDE / cell + 1;
    let texture: Vec<f32> = (0..cells * cells).map(|_| grain * random.uniform(-1.0, 1.0)).collect();
    for (channel, plane) in planes.chunks_exact_mut(SQUARE).enumerate() {
        for (at, level) in plane.iter_mut().enumerate() {
            *level = colour[channel] + texture[at / SIDE / cell * cells + at % SIDE / cell];
        }
    }
}

/// Pastes the object, turned, scaled and moved; returns its jaws.
fn place(cutout: &Cutout, random: &mut Random, planes: &mut [f32]) -> [[f32; 2]; 2] {
    let (sine, cosine) = random.uniform(0.0, std::f32::consts::TAU).sin_cos();
    let scale = random.uniform(SCALES[0], SCALES[1]);
    let [left, right] = cutout.jaws;
    let grasp = [0, 1].map(|axis| 0.5 * (left[axis] + right[axis]));
    let middle = [(); 2].map(|()| SIDE as f32 / 2.0 + random.uniform(-SHIFT, SHIFT));
    let gain = random.uniform(0.75, 1.25);
    for (at, (column, row)) in (0..SQUARE).map(|at| (at, (at % SIDE, at / SIDE))) {
        let [x, y] = [column as f32 + 0.5 - middle[0], row as f32 + 0.5 - middle[1]].map(|part| part / scale);
        let source = [grasp[0] + cosine * x + sine * y - 0.5, grasp[1] - sine * x + cosine * y - 0.5];
        let Some([red, green, blue, coverage]) = sample(&cutout.planes, source) else { continue };
        for (channel, level) in [red, green, blue].into_iter().enumerate() {
            let own = &mut planes[channel * SQUARE + at];
            *own = *own * (1.0 - coverage) + gain * level;
        }
    }
    cutout.jaws.map(|[x, y]| {
        let [x, y] = [x - grasp[0], y - grasp[1]].map(|part| part * scale);
        [middle[0] + cosine * x - sine * y, middle[1] + sine * x + cosine * y]
    })
}

/// Returns the four planes at a place, bilinearly; none where the object does not cover it.
fn sample(planes: &[f32], [x, y]: [f32; 2]) -> Option<[f32; 4]> {
    let inside = |part: f32| part >= 0.0 && part < (SIDE - 1) as f32;
    if !inside(x) || !inside(y) {
        return None;
    }
    let (column, row) = (x as usize, y as usize);
    let (across, down) = (x - column as f32, y - row as f32);
    let at = row * SIDE + column;
    let mixed = |plane: usize| {
        let level = |offset: usize| planes[plane * SQUARE + at + offset];
        let above = level(0) * (1.0 - across) + level(1) * across;
        let below = level(SIDE) * (1.0 - across) + level(SIDE + 1) * across;
        above * (1.0 - down) + below * down
    };
    let coverage = mixed(3);
    (coverage > 0.0).then(|| [mixed(0), mixed(1), mixed(2), coverage])
}

/// Draws a turned rectangle of one colour.
fn rectangle(random: &mut Random, sides: [f32; 2], planes: &mut [f32]) {
    let (sine, cosine) = random.uniform(0.0, std::f32::consts::TAU).sin_cos();
    let half = [(); 2].map(|()| 0.5 * random.uniform(sides[0], sides[1]));
    let middle = [(); 2].map(|()| random.uniform(0.0, SIDE as f32));
    let colour = [(); 3].map(|()| random.uniform(0.0, 1.0));
    let reach = half[0].hypot(half[1]);
    let span = |axis: usize| {
        let end = |part: f32| part.clamp(0.0, SIDE as f32) as usize;
        end(middle[axis] - reach)..end(middle[axis] + reach + 1.0)
    };
    for row in span(1) {
        for column in span(0) {
            let [x, y] = [column as f32 + 0.5 - middle[0], row as f32 + 0.5 - middle[1]];
            if (cosine * x + sine * y).abs() < half[0] && (cosine * y - sine * x).abs() < half[1] {
                for (channel, level) in colour.into_iter().enumerate() {
                    planes[channel * SQUARE + row * SIDE + column] = level;
                }
            }
        }
    }
}

/// Changes the light: brightness, tint, a gradient across the image, and noise of the camera.
fn relight(random: &mut Random, planes: &mut [f32]) {
    let brightness = random.uniform(0.5, 1.4);
    let slope = [(); 2].map(|()| random.uniform(-0.3, 0.3) / SIDE as f32);
    let noise = random.uniform(0.0, 0.04);
    for plane in planes.chunks_exact_mut(SQUARE) {
        let tint = brightness * random.uniform(0.9, 1.1);
        for (at, level) in plane.iter_mut().enumerate() {
            let across = [at % SIDE, at / SIDE].map(|part| part as f32 - SIDE as f32 / 2.0);
            let light = tint * (1.0 + slope[0] * across[0] + slope[1] * across[1]);
            // A sum of uniform numbers: a normal one costs several times as much.
            let grain = noise * (random.uniform(-1.0, 1.0) + random.uniform(-1.0, 1.0)) * 1.22;
            *level = (*level * light + grain).clamp(0.0, 1.0);
        }
    }
}
