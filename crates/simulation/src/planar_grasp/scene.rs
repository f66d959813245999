//! What the camera sees of an episode.

use opendr_engine::Random;

use super::camera::{Camera, Hit};
use super::{GRASP_HEIGHT, GraspObject, PlanarGraspParams};
use crate::planar::vector::dot;
use crate::planar::{Convex, Pose};
use crate::sine_cosine::sine_cosine;

/// Light and table of an episode.
#[derive(Debug, Clone, Copy)]
pub(super) struct Surroundings {
    table: [f32; 3],
    /// Direction to the light on the table, and its brightness.
    light: [f64; 2],
    brightness: f32,
    /// Change of the brightness across the view, along x and y.
    gradient: [f32; 2],
    grain: f32,
    texture: u64,
}

impl Surroundings {
    pub fn draw(variation: f32, random: &mut Random) -> Self {
        let mut around =
            |middle: f32, spread: f32| middle + spread * variation * (2.0 * random.unit() as f32 - 1.0);
        let grey = around(150.0, 110.0);
        let table = [(); 3].map(|()| around(grey, 40.0));
        let (brightness, gradient) = (around(1.0, 0.4), [around(0.0, 0.3), around(0.0, 0.3)]);
        let (grain, turn) = (around(6.0, 10.0).max(0.0), std::f64::consts::TAU * random.unit());
        let (sine, cosine) = sine_cosine(turn);
        Self { table, light: [cosine, sine], brightness, gradient, grain, texture: random.bits() }
    }

    /// Returns them with a table of these levels of red, green and blue.
    pub fn with_table(self, table: [f32; 3]) -> Self {
        Self { table, ..self }
    }

    /// Returns the texture of the table at a pixel: noise on a grid of 4 pixels.
    fn grain(&self, column: usize, row: usize) -> f32 {
        let cell = ((row as u64 / 4) << 32) | (column as u64 / 4);
        2.0 * self.grain * (hashed(self.texture ^ cell) - 0.5)
    }
}

/// Returns a number in [0, 1) for a key (the finaliser of SplitMix64; Steele, Lea and Flood, 2014): a generator per cell costs more than the
/// rest of the image.
fn hashed(key: u64) -> f32 {
    let key = (key ^ key >> 30).wrapping_mul(0xbf58_476d_1ce4_e5b9);
    let key = (key ^ key >> 27).wrapping_mul(0x94d0_49bb_1331_11eb);
    ((key ^ key >> 31) >> 40) as f32 / (1u64 << 24) as f32
}

/// Returns noise with mean 0 and about this deviation: a sum of uniform numbers, which cost a fraction of normal ones.
fn noise(random: &mut Random, deviation: f32) -> f32 {
    let bits = random.bits();
    let sum: u64 = (0..4).map(|part| bits >> (16 * part) & 0xffff).sum();
    // Four uniform numbers have a variance of 4 / 12.
    deviation * (sum as f32 / 65_536.0 - 2.0) * 1.732
}

/// Renders the colour, `[size, size, 3]` levels, and the depth, `[size, size]` m, of a view.
pub(super) fn render(
    params: &PlanarGraspParams,
    surroundings: &Surroundings,
    (object, pose): (GraspObject, Pose),
    random: &mut Random,
    (colours, depths): (&mut [f32], &mut [f32]),
) {
    let camera = Camera::new(params.size);
    let body = object.body(params.friction);
    let turn = pose.turn();
    let mut prisms = [Convex::disc(0.0); 4];
    let count = body.parts().len();
    prisms
        .iter_mut()
        .zip(body.parts())
        .for_each(|(prism, part)| *prism = part.shape.placed(pose.place, turn));
    let size = params.size;
    let pixels = colours.as_chunks_mut::<3>().0.iter_mut().zip(depths).enumerate();
    for (at, (colour, depth)) in pixels {
        let (column, row) = (at % size, at / size);
        let pixel = [column as f32 + 0.5, row as f32 + 0.5];
        let hits = prisms[..count]
            .iter()
            .enumerate()
            .filter_map(|(part, prism)| Some((part, camera.hit(pixel, prism, GRASP_HEIGHT)?)));
        let first = hits.fold(None, |best: Option<(usize, Hit)>, hit| match best {
            Some(best) if best.1.height >= hit.1.height => Some(best),
            _ => Some(hit),
        });
        let (shade, height, own) = match first {
            None => (1.0, 0.0, surroundings.table.map(|level| level + surroundings.grain(column, row))),
            Some((part, hit)) => (shade(hit, surroundings.light), hit.height, object.colour(part)),
        };
        let across = [pixel[0] / size as f32 - 0.5, pixel[1] / size as f32 - 0.5];
        let lit = surroundings.brightness
            * (1.0 + surroundings.gradient[0] * across[0] + surroundings.gradient[1] * across[1]);
        let mut noisy = |level: f32| level * lit * shade + noise(random, params.colour_noise);
        *colour = own.map(&mut noisy).map(|level| level.clamp(0.0, 255.0).round());
        *depth = Camera::depth(height) as f32 + noise(random, params.depth_noise);
    }
}

fn shade(hit: Hit, light: [f64; 2]) -> f32 {
    hit.side.map_or(1.0, |normal| (0.55 + 0.25 * dot(normal, light)) as f32)
}
