//! Colours of surfaces, limited in detail to what a pixel resolves.

use crate::raycast::Vector;

/// The finish of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Finish {
    pub kind: Kind,
    /// Colour, 0 to 1.
    pub colour: Vector,
    /// Contrast of its texture.
    pub contrast: f32,
    pub seed: u32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Kind {
    /// Asphalt with patches.
    Road,
    /// A facade with windows in cells of this width and height.
    Facade([f32; 2]),
    /// Stains and stickers.
    Paint,
}

/// Wavelengths in metres and amplitudes of the noise.
const ROAD: [(f32, f32); 4] = [(2.3, 0.5), (0.71, 0.55), (0.23, 0.55), (0.07, 0.5)];
const WALL: [(f32, f32); 3] = [(1.9, 0.3), (0.43, 0.35), (0.13, 0.3)];
const PAINT: [(f32, f32); 3] = [(0.9, 0.6), (0.31, 0.7), (0.09, 0.5)];

impl Finish {
    /// Returns the colour at a point in the body's frame; `normal` in that frame, `pixel` the size of a pixel there in metres.
    pub fn at(&self, point: Vector, normal: Vector, pixel: f32) -> Vector {
        let [u, v] = on_face(point, normal);
        let waves: &[(f32, f32)] = match self.kind {
            Kind::Road => &ROAD,
            Kind::Facade(_) => &WALL,
            Kind::Paint => &PAINT,
        };
        let mut light = 1.0;
        for ((wavelength, amplitude), seed) in waves.iter().zip(self.seed..) {
            let weight = resolved(*wavelength, pixel);
            if weight > 0.0 {
                let noise = noise(u / wavelength, v / wavelength, seed) - 0.5;
                light += self.contrast * weight * amplitude * noise;
            }
        }
        let colour = match self.kind {
            Kind::Facade(cell) if normal[2].abs() < 0.5 => self.with_windows([u, v], cell, pixel),
            Kind::Paint => self.with_stickers([u, v], pixel),
            _ => self.colour,
        };
        colour.map(|part| light.max(0.0) * part)
    }

    fn with_windows(&self, [u, v]: [f32; 2], [width, height]: [f32; 2], pixel: f32) -> Vector {
        let weight = self.contrast.min(1.0) * resolved(0.7 * width, pixel);
        let [x, y] = [u / width, v / height];
        let [column, row] = [x.floor(), y.floor()];
        let code = hash(column as i32, row as i32, self.seed ^ 0x51ed);
        let [x, y] = [x - column, y - row];
        let margin = 0.12 + 0.15 * part(code, 0);
        let pane = (x - 0.5).abs() < 0.5 - margin && (y - 0.55).abs() < 0.5 - margin;
        if weight == 0.0 || !pane {
            return self.colour;
        }
        // Curtains: the window's halves differ.
        let half = if x < 0.35 + 0.3 * part(code, 1) { 2 } else { 3 };
        let level = 0.06 + 0.6 * part(code, half) * part(code, half);
        std::array::from_fn(|channel| {
            let tint = [0.92, 1.0, 1.08][channel];
            self.colour[channel] + weight * (tint * level - self.colour[channel])
        })
    }

    fn with_stickers(&self, [u, v]: [f32; 2], pixel: f32) -> Vector {
        const CELL: f32 = 0.6;
        let weight = self.contrast.min(1.0) * resolved(0.5 * CELL, pixel);
        let [column, row] = [(u / CELL).floor(), (v / CELL).floor()];
        let code = hash(column as i32, row as i32, self.seed ^ 0x2f0b);
        let [x, y] = [u / CELL - column, v / CELL - row];
        let (low, size) = (0.5 * part(code, 0), 0.2 + 0.3 * part(code, 1));
        let is_inside = (low..low + size).contains(&x) && (low..low + size).contains(&y);
        if weight == 0.0 || !is_inside {
            return self.colour;
        }
        let level = part(code, 2);
        self.colour.map(|part| part + weight * (level - part))
    }
}

/// Returns how much of a wave a pixel of this size resolves, 0 to 1.
fn resolved(wavelength: f32, pixel: f32) -> f32 {
    ((wavelength / pixel - 1.5) * 0.5).clamp(0.0, 1.0)
}

/// Returns coordinates on the face of a body.
fn on_face([x, y, z]: Vector, normal: Vector) -> [f32; 2] {
    let [nx, ny, nz] = normal.map(f32::abs);
    if nz >= nx && nz >= ny {
        [x, y]
    } else if nx >= ny {
        [y, z]
    } else {
        [x + 61.7, z]
    }
}

/// Value noise, 0 to 1.
fn noise(u: f32, v: f32, seed: u32) -> f32 {
    let [column, row] = [u.floor(), v.floor()];
    let [x, y] = [u - column, v - row].map(|share| share * share * (3.0 - 2.0 * share));
    let [column, row] = [column as i32, row as i32];
    let corner = |dx: i32, dy: i32| {
        (hash(column.wrapping_add(dx), row.wrapping_add(dy), seed) >> 8) as f32 / (1 << 24) as f32
    };
    let [below, above] = [0, 1].map(|dy| {
        let first = corner(0, dy);
        first + x * (corner(1, dy) - first)
    });
    below + y * (above - below)
}

fn hash(column: i32, row: i32, seed: u32) -> u32 {
    let mut bits = (column as u32).wrapping_mul(0x85eb_ca6b)
        ^ (row as u32).wrapping_mul(0xc2b2_ae35)
        ^ seed.wrapping_mul(0x9e37_79b9);
    bits = (bits ^ (bits >> 15)).wrapping_mul(0x2c1b_3c6d);
    bits = (bits ^ (bits >> 12)).wrapping_mul(0x297a_2d39);
    bits ^ (bits >> 15)
}

/// Returns one of four numbers 0 to 1 of a hash.
fn part(code: u32, number: u32) -> f32 {
    ((code >> (8 * number)) & 0xff) as f32 / 255.0
}
