//! Bodies together.

use opendr_engine::{Error, Result};

use super::packet::RayPacket;
use super::{Body, LANES, Vector, along, length, minus};

/// What a ray met.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Hit {
    /// How far it went.
    pub distance: f32,
    /// Away from the surface, also where it was met from inside.
    pub normal: Vector,
    /// The body's label.
    pub label: u16,
}

/// Bodies that rays and movements meet.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Scene {
    bodies: Vec<Body>,
}

impl Scene {
    /// Adds a body.
    pub fn add(&mut self, body: Body) {
        self.bodies.push(body);
    }

    /// Removes all bodies and keeps their memory.
    pub fn clear(&mut self) {
        self.bodies.clear();
    }

    /// The bodies, in the order in which they were added.
    pub fn bodies(&self) -> &[Body] {
        &self.bodies
    }

    /// Writes how far each ray from `origin` along a unit vector goes, at most `range`.
    ///
    /// # Errors
    /// `InvalidInput` when there is not one distance for each direction.
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

    /// Writes what each ray from `origin` along a unit vector meets within `range`.
    ///
    /// # Errors
    /// `InvalidInput` when there is not one place for each direction.
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
            return Err(Error::invalid_input(format!("{places} places for {rays} rays; give one for each")));
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

    /// The distance of a point from the nearest surface: negative inside a body, infinite without bodies.
    pub fn distance(&self, point: Vector) -> f32 {
        self.bodies.iter().map(|body| body.distance(point)).fold(f32::INFINITY, f32::min)
    }

    /// How far a ball of `radius` gets on the way from `from` to `to` before it touches a body; `None` when it arrives.
    ///
    /// It advances by what is certainly free (Hart, Sphere tracing, 1996), so that nothing thin is stepped over; a gap
    /// of less than a tenth of a millimetre, or a millionth of the way, counts as a touch.
    pub fn sweep(&self, from: Vector, to: Vector, radius: f32) -> Option<f32> {
        let way = minus(to, from);
        let far = length(way);
        let direction = if far > 0.0 { way.map(|part| part / far) } else { way };
        // Below the resolution of single precision nothing would move.
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
