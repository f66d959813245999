//! Skins: tubes around chains of bones by linear blend skinning, and rounded forms at their ends.

use std::f32::consts::{PI, TAU};

use opendr_engine::Result;

use super::frame::{AHEAD, Frame, LEFT, UP};
use crate::raycast::{Body, Mesh, Shape, Vector, along, minus, unit};

/// Vertices of a ring.
const AROUND: usize = 14;

/// Triangles under construction, in world coordinates.
#[derive(Debug, Clone, Default)]
pub(super) struct Skin {
    vertices: Vec<Vector>,
    faces: Vec<[u32; 3]>,
}

/// A cross-section of a tube: an ellipse.
#[derive(Debug, Clone, Copy)]
pub(super) struct Ring {
    /// Position along the chain from its begin, metres.
    pub at: f32,
    /// Radii to the side and to the front, metres.
    pub radii: [f32; 2],
}

/// Two bones of a limb that bends at their joint; both extend down from their frames.
#[derive(Debug, Clone, Copy)]
pub(super) struct Limb {
    pub upper: Frame,
    pub lower: Frame,
    /// Length of the upper bone, metres.
    pub length: f32,
    /// Half of the length over which the skin blends from one bone to the other, metres.
    pub blend: f32,
}

impl Limb {
    /// Returns the frame of the skin at a position along the limb: the blend of where both bones carry it.
    fn skin(&self, at: f32) -> Frame {
        let share = ((at - self.length) / (2.0 * self.blend) + 0.5).clamp(0.0, 1.0);
        let share = share * share * (3.0 - 2.0 * share);
        let (upper, lower) =
            (self.upper.moved([0.0, 0.0, -at]), self.lower.moved([0.0, 0.0, self.length - at]));
        blended(&upper, &lower, share)
    }
}

/// Returns the frame between two frames; `share` is that of the second.
pub(super) fn blended(first: &Frame, second: &Frame, share: f32) -> Frame {
    let mix = |a: Vector, b: Vector| along(a, minus(b, a), share);
    let axes = std::array::from_fn(|axis| unit(mix(first.axes[axis], second.axes[axis])));
    Frame { position: mix(first.position, second.position), axes }
}

impl Skin {
    /// Adds a tube around a limb, closed at both ends.
    pub fn limb(&mut self, limb: &Limb, rings: &[Ring]) {
        self.tube(rings.iter().map(|ring| (limb.skin(ring.at), ring.radii)));
    }

    /// Adds a tube through frames with the radii to the side and to the front, closed at both ends; upwards or downwards.
    pub fn tube(&mut self, rings: impl Iterator<Item = (Frame, [f32; 2])>) {
        let begin = self.vertices.len() as u32;
        let mut count = 0;
        for (frame, [aside, ahead]) in rings {
            for step in 0..AROUND {
                let (sine, cosine) = (TAU * step as f32 / AROUND as f32).sin_cos();
                self.vertices.push(frame.point([ahead * cosine, aside * sine, 0.0]));
            }
            count += 1;
        }
        let (around, rings) = (AROUND as u32, count);
        for ring in 1..rings {
            self.band(begin + (ring - 1) * around, begin + ring * around);
        }
        for cap in [0, rings - 1] {
            let first = begin + cap * around;
            self.faces.extend((2..around).map(|step| [first, first + step - 1, first + step]));
        }
    }

    /// Adds an ellipsoid with these half axes in a frame; only the part whose height, as a share of the half axis, is within
    /// `range`.
    pub fn ellipsoid(&mut self, frame: &Frame, half: Vector, [low, high]: [f32; 2]) {
        const RINGS: usize = 9;
        let angle = |height: f32| height.clamp(-1.0, 1.0).asin();
        let rings = (0..RINGS).map(|ring| {
            let share = ring as f32 / (RINGS - 1) as f32;
            let (sine, cosine) = (angle(low) + share * (angle(high) - angle(low))).sin_cos();
            let wide = cosine.max(1e-3);
            (frame.moved([0.0, 0.0, half[UP] * sine]), [half[LEFT] * wide, half[AHEAD] * wide])
        });
        self.tube(rings);
    }

    /// Adds the back of an ellipsoid, as hair over a head: the part behind a plane through the vertical axis, tilted by `tilt`.
    pub fn shell(&mut self, frame: &Frame, half: Vector, tilt: f32) {
        let turned = frame.turned(LEFT, -PI / 2.0 + tilt);
        // The turned frame's up points backwards, and its ahead up.
        self.ellipsoid(&turned, [half[UP], half[LEFT], half[AHEAD]], [-0.1, 1.0]);
    }

    fn band(&mut self, lower: u32, upper: u32) {
        let around = AROUND as u32;
        for step in 0..around {
            let next = (step + 1) % around;
            self.faces.push([lower + step, lower + next, upper + next]);
            self.faces.push([lower + step, upper + next, upper + step]);
        }
    }

    /// Returns whether nothing was added.
    pub fn is_empty(&self) -> bool {
        self.faces.is_empty()
    }

    /// Returns the skin as a body with this label.
    pub fn body(self, label: u16) -> Result<Body> {
        let count = self.vertices.len().max(1) as f32;
        let middle: Vector =
            std::array::from_fn(|axis| self.vertices.iter().map(|vertex| vertex[axis]).sum::<f32>() / count);
        let vertices: Vec<_> = self.vertices.iter().map(|vertex| minus(*vertex, middle)).collect();
        Body::upright(Shape::Mesh(Mesh::new(&vertices, &self.faces)?.into()), middle, label)
    }
}
