//! Scenes: collections of bodies.

use opendr_engine::{Error, Result};

use super::packet::RayPacket;
use super::{Body, LANES, Vector, along, length, minus};

/// A ray's hit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// Distance from the ray's origin.
    pub distance: f32,
    /// Outward surface normal, also for a hit from inside.
    pub normal: Vector,
    /// Label of the body.
    pub label: u16,
}

/// Bodies for rays and collision tests.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    bodies: Vec<Body>,
}

impl Scene {
    /// Adds a body.
    pub fn add(&mut self, body: Body) {
        self.bodies.push(body);
    }

    /// Removes all bodies and keeps the allocation.
    pub fn clear(&mut self) {
        self.bodies.clear();
    }

    /// Returns the bodies in the order in which they were added.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Writes the length of each ray from `origin` along a unit vector, at most `range`.
    ///
    /// # Errors
    /// `InvalidInput` when the numbers of distances and directions differ.
    pub fn depths(
        &self,
        origin: Vector,
        directions: &[Vector],
        range: f32,
        depths: &mut [f32],
    ) -> Result<()> {
        self.cast(origin, directions, range, depths.len(), |at, packet, lane| {
            depths[at] = packet.distances[lane];
        })
    }

    /// Writes the hit of each ray from `origin` along a unit vector within `range`.
    ///
    /// # Errors
    /// `InvalidInput` when the numbers of hits and directions differ.
    pub fn hits(
        &self,
        origin: Vector,
        directions: &[Vector],
        range: f32,
        hits: &mut [Option<Hit>],
    ) -> Result<()> {
        self.cast(origin, directions, range, hits.len(), |at, packet, lane| {
            let distance = packet.distances[lane];
            hits[at] = self.bodies.get(packet.bodies[lane] as usize).map(|body| Hit {
                distance,
                normal: body.normal(along(origin, directions[at], distance)),
                label: body.label(),
            });
        })
    }

    fn cast(
        &self,
        origin: Vector,
        directions: &[Vector],
        range: f32,
        places: usize,
        mut each: impl FnMut(usize, &RayPacket, usize),
    ) -> Result<()> {
        if places != directions.len() {
            let rays = directions.len();
            return Err(Error::invalid_input(format!(
                "the output has {places} places for {rays} rays; give one per ray"
            )));
        }
        for (number, rays) in directions.chunks(LANES).enumerate() {
            let mut packet = RayPacket::new(origin, rays, range);
            for (body, number) in self.bodies.iter().zip(0..) {
                packet.meet(body, number);
            }
            (0..rays.len()).for_each(|lane| each(number * LANES + lane, &packet, lane));
        }
        Ok(())
    }

    /// Returns the distance of a point from the nearest surface: negative inside a body, infinite without bodies.
    pub fn distance(&self, point: Vector) -> f32 {
        self.bodies.iter().map(|body| body.distance(point)).fold(f32::INFINITY, f32::min)
    }

    /// Returns how far a ball of `radius` moves from `from` towards `to` before it touches a body; `None` if it arrives.
    ///
    /// It uses sphere tracing (Hart, 1996), so that no thin body is missed; a gap below a tenth of a millimetre, or
    /// a millionth of the way, counts as a touch.
    pub fn sweep(&self, from: Vector, to: Vector, radius: f32) -> Option<f32> {
        let way = minus(to, from);
        let far = length(way);
        let direction = if far > 0.0 { way.map(|part| part / far) } else { way };
        // Smaller steps are lost in single precision.
        let touch = 1e-4_f32.max(far * 1e-6);
        let mut travelled = 0.0;
        loop {
            let free = self.distance(along(from, direction, travelled)) - radius;
            if free <= touch || free.is_nan() {
                return Some(travelled);
            }
            if travelled >= far {
                return None;
            }
            travelled = (travelled + free).min(far);
        }
    }
}
