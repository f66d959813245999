//! From a scene to the pixels of a camera: colours, light, blur, noise.

use opendr_engine::{Random, Result};

use super::{Asset, Conditions};
use crate::raycast::{Camera, DepthBuffer, Pose, Scene, Vector, along, dot, unit};

/// A camera with its buffers.
#[derive(Debug, Clone)]
pub(super) struct ImageSensor {
    camera: Camera,
    depths: DepthBuffer,
    sharp: Vec<f32>,
}

/// The tangent of half the angle of view: a subject of radius 1 fills the image from 2.7 radii.
pub(super) const HALF_WIDTH: f32 = 0.38;
const RANGE: f32 = 8.0;
/// Shares of red, green and blue light that panels and poles reflect.
pub const OCCLUDER: [f32; 3] = [0.45, 0.42, 0.38];

impl ImageSensor {
    pub fn new(side: usize) -> Result<Self> {
        let camera = Camera::new(side, side, HALF_WIDTH)?;
        Ok(Self { camera, depths: DepthBuffer::default(), sharp: vec![0.0; 3 * side * side] })
    }

    /// Writes `[height, width, 3]` RGB bytes. `motion` is what the last movement shifted the image by, in pixels to the
    /// right and down, while the shutter was open.
    pub fn capture(
        &mut self,
        (scene, asset): (&Scene, &Asset),
        pose: &Pose,
        conditions: &Conditions,
        motion: [f32; 2],
        random: &mut Random,
        pixels: &mut [u8],
    ) {
        let Self { camera, depths, sharp } = self;
        camera.render_depth(scene, pose, RANGE, depths);
        let width = camera.width();
        let colours = sharp.as_chunks_mut::<3>().0;
        for (at, ((depth, body), colour)) in depths.depths().zip(depths.bodies()).zip(colours).enumerate() {
            let direction = pose.to_world(camera.direction(at % width, at / width));
            *colour = match body {
                None => background(conditions, unit(direction)),
                Some(number) => {
                    let point = along(pose.position, direction, depth);
                    match asset.texel(number, point) {
                        Some((texel, part)) => {
                            let toward = part.direction_in_body(conditions.light);
                            lit(texel.colour, dot(texel.normal, toward), conditions)
                        }
                        None => occluder(scene, number, point, conditions),
                    }
                }
            };
        }
        expose(sharp, width, motion, conditions.noise, random, pixels);
    }
}

fn background(conditions: &Conditions, direction: Vector) -> [f32; 3] {
    let [(mut colour, _), patches @ ..] = conditions.background;
    for (patch, at) in patches {
        let share = (0.6 * dot(at, direction) + 0.4).max(0.0);
        colour = std::array::from_fn(|part| colour[part] + share * (patch[part] - colour[part]));
    }
    colour
}

/// The colour of a surface that faces the light by this cosine.
fn lit(colour: [f32; 3], facing: f32, conditions: &Conditions) -> [f32; 3] {
    let light = conditions.ambient + (1.0 - conditions.ambient) * facing.max(0.0);
    colour.map(|part| part * light)
}

/// The colour of a panel or of the pole, which follow the parts of the subject in the scene.
fn occluder(scene: &Scene, number: usize, point: Vector, conditions: &Conditions) -> [f32; 3] {
    let facing = scene.bodies().get(number).map_or(0.0, |body| dot(body.normal(point), conditions.light));
    lit(OCCLUDER, facing, conditions)
}

/// Averages along the motion, adds noise and rounds.
fn expose(
    sharp: &[f32],
    width: usize,
    [right, down]: [f32; 2],
    noise: f32,
    random: &mut Random,
    pixels: &mut [u8],
) {
    const UNIT: f32 = 1.0 / 65_536.0;
    let height = sharp.len() / (3 * width);
    let taps = 1 + right.abs().max(down.abs()).round().min(6.0) as usize;
    let shifts: [[isize; 2]; 7] = std::array::from_fn(|tap| {
        let share = tap as f32 / (taps - 1).max(1) as f32;
        [(share * right).round() as isize, (share * down).round() as isize]
    });
    let scale = 255.0 / taps as f32;
    let nearest = |at: usize, shift: isize, end: usize| at.saturating_add_signed(shift).min(end - 1);
    for (at, pixel) in pixels.as_chunks_mut::<3>().0.iter_mut().enumerate() {
        let (column, row) = (at % width, at / width);
        let mut colour = [0.0; 3];
        for [right, down] in &shifts[..taps] {
            let from = nearest(row, *down, height) * width + nearest(column, *right, width);
            (0..3).for_each(|part| colour[part] += sharp[3 * from + part]);
        }
        let bits = random.bits();
        for (number, (level, part)) in pixel.iter_mut().zip(colour).enumerate() {
            let quarter = ((bits >> (16 * number)) & 0xffff) as f32 * UNIT;
            *level = (scale * part + noise * (2.0 * quarter - 1.0)) as u8;
        }
    }
}
