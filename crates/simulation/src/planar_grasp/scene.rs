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

    /// Returns the texture of the table at a pixel: noise on a grid of 4 pixels.
    fn grain(&self, column: usize, row: usize) -> f32 {
        let cell =
            |x: usize, y: usize| Random::from_key([self.texture, x as u64, y as u64]).unit() as f32 - 0.5;
        2.0 * self.grain * cell(column / 4, row / 4)
    }
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
        let noisy = |level: f32| level * lit * shade + params.colour_noise * random.normal() as f32;
        *colour = own.map(noisy).map(|level| level.clamp(0.0, 255.0).round());
        *depth = Camera::depth(height) as f32 + params.depth_noise * random.normal() as f32;
    }
}

fn shade(hit: Hit, light: [f64; 2]) -> f32 {
    hit.side.map_or(1.0, |normal| (0.55 + 0.25 * dot(normal, light)) as f32)
}
