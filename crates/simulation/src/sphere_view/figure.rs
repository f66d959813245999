//! Figures: ten poses of the arms in front of the body, which all look alike from behind.

use opendr_engine::{Error, Random, Result};

use super::subject::POSES;
use super::surface::{Form, Plain, bump, ellipsoid, mix, step};
use super::{Asset, Subject};
use crate::raycast::{Vector, along, cross, dot, length, minus};

/// Positions of the left and the right hand in each pose: x to the front, y to the left, z up.
const HANDS: [[Vector; 2]; POSES as usize] = [
    // Folded, together low, together high, wide low, wide high.
    [[0.24, -0.13, 0.24], [0.21, 0.13, 0.2]],
    [[0.25, 0.05, -0.02], [0.25, -0.05, -0.02]],
    [[0.25, 0.05, 0.3], [0.25, -0.05, 0.3]],
    [[0.24, 0.19, -0.04], [0.24, -0.19, -0.04]],
    [[0.22, 0.18, 0.36], [0.22, -0.18, 0.36]],
    // One high, one low.
    [[0.24, 0.12, 0.34], [0.25, -0.14, -0.02]],
    [[0.25, 0.14, -0.02], [0.24, -0.12, 0.34]],
    // One at the chin, the other across.
    [[0.2, 0.06, 0.5], [0.24, 0.14, 0.12]],
    [[0.24, -0.14, 0.12], [0.2, -0.06, 0.5]],
    // Stretched out to the front.
    [[0.5, 0.2, 0.28], [0.5, -0.2, 0.28]],
];
const ELBOWS: [Vector; 2] = [[0.02, 0.31, 0.06], [0.02, -0.31, 0.06]];
const SHOULDERS: [Vector; 2] = [[0.0, 0.25, 0.38], [0.0, -0.25, 0.38]];
const SKIN: [f32; 3] = [0.85, 0.64, 0.5];
/// Factor by which a figure of these measures is scaled around its middle to fill a radius of 1.
const SCALE: f32 = 1.6;
const MIDDLE: f32 = 0.24;
const UPRIGHT: [f32; 4] = [1.0, 0.0, 0.0, 0.0];

/// A figure in a pose.
pub(super) fn generate(class: u32, instance: u64) -> Result<Asset> {
    let Some(hands) = HANDS.get(class as usize) else {
        return Err(Error::invalid_param(format!("there is no pose class {class}; give 0 to {}", POSES - 1)));
    };
    let mut random = Subject::Pose.random(u64::from(class), instance);
    let mut asset = Asset::empty();
    let tone = random.uniform(0.7, 1.1);
    let skin = SKIN.map(|part| (part * tone).min(1.0));
    let mut cloth = || [(); 3].map(|()| random.uniform(0.08, 0.8));
    let [shirt, trousers] = [cloth(), cloth()];
    let sleeves = mix(shirt, [0.5; 3], 0.35);
    let build = random.uniform(0.95, 1.05);
    add_body(&mut asset, build, [skin, shirt, trousers])?;
    for side in 0..2 {
        let hand: Vector = std::array::from_fn(|axis| hands[side][axis] + jitter(&mut random));
        let [shoulder, elbow] = [SHOULDERS[side], ELBOWS[side]];
        add_limb(&mut asset, [shoulder, elbow], 0.075, sleeves)?;
        add_limb(&mut asset, [elbow, hand], 0.06, sleeves)?;
        add(&mut asset, [6, 8], (hand, UPRIGHT), &Plain { half: [0.075 * SCALE; 3], colour: skin })?;
    }
    Ok(asset)
}

fn jitter(random: &mut Random) -> f32 {
    random.uniform(-0.025, 0.025)
}

/// Torso, head and hips.
fn add_body(asset: &mut Asset, build: f32, [skin, shirt, trousers]: [[f32; 3]; 3]) -> Result<()> {
    let torso = Plain { half: [0.17 * build * SCALE, 0.26 * SCALE, 0.4 * SCALE], colour: shirt };
    add(asset, [12, 24], ([0.0, 0.0, 0.16], UPRIGHT), &torso)?;
    add(asset, [12, 40], ([0.02, 0.0, 0.66], UPRIGHT), &Face { skin })?;
    let hips = Plain { half: [0.17 * SCALE, 0.24 * SCALE, 0.16 * SCALE], colour: trousers };
    add(asset, [8, 8], ([0.0, 0.0, -0.2], UPRIGHT), &hips)
}

/// An ellipsoid around the line between two points.
fn add_limb(asset: &mut Asset, [from, to]: [Vector; 2], radius: f32, colour: [f32; 3]) -> Result<()> {
    let way = minus(to, from);
    let half = [radius, radius, 0.5 * length(way) + 0.6 * radius].map(|part| part * SCALE);
    add(asset, [8, 8], (along(from, way, 0.5), turn_up_to(way)), &Plain { half, colour })
}

/// Adds a part at a position in the figure's own measures.
fn add(
    asset: &mut Asset,
    sizes: [usize; 2],
    (at, rotation): (Vector, [f32; 4]),
    form: &impl Form,
) -> Result<()> {
    let [x, y, z] = at;
    asset.add(sizes, ([x * SCALE, y * SCALE, (z - MIDDLE) * SCALE], rotation), form)
}

/// The head, whose face marks the front.
struct Face {
    skin: [f32; 3],
}

impl Form for Face {
    fn radius(&self, direction: Vector) -> f32 {
        ellipsoid([0.15 * SCALE, 0.13 * SCALE, 0.18 * SCALE], direction)
    }

    fn colour(&self, [x, y, z]: Vector) -> [f32; 3] {
        let face = step(x, 0.2, 0.4) * (1.0 - step(z, 0.45, 0.55));
        let eyes = step(bump([y.abs(), z], [0.35, 0.12], [0.16, 0.12]), 0.1, 0.4);
        let mouth = step(bump([y, z], [0.0, -0.4], [0.3, 0.1]), 0.1, 0.4);
        let front = mix(self.skin, [0.08, 0.05, 0.05], eyes.max(mouth));
        mix([0.15, 0.1, 0.07], front, face)
    }
}

/// The quaternion that turns the z axis into a direction.
fn turn_up_to(way: Vector) -> [f32; 4] {
    let up = [0.0, 0.0, 1.0];
    let [x, y, z] = cross(up, way);
    let w = length(way) + dot(up, way);
    // Straight down: half a turn about x.
    if w < 1e-6 * length(way) { [0.0, 1.0, 0.0, 0.0] } else { [w, x, y, z] }
}
