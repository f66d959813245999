//! Rigid bodies.

use opendr_engine::Result;
use opendr_engine::environment::{Snapshot, StateReader};

use super::drive::Drive;
use super::shape::Convex;
use super::vector::{Vector2, Velocity, cross, dot, left, plus, turned};
use crate::multirotor::numbers;
use crate::sine_cosine::sine_cosine;

/// Most parts of a body.
const MAX_PARTS: usize = 4;

/// A place and a direction.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct Pose {
    pub place: Vector2,
    /// Radians to the left.
    pub angle: f64,
}

impl Pose {
    pub fn new(place: Vector2, angle: f64) -> Self {
        Self { place, angle }
    }

    /// Returns sine and cosine of the angle.
    pub fn turn(&self) -> (f64, f64) {
        sine_cosine(self.angle)
    }

    /// Returns the place in the world of a point of the body.
    pub fn outside(&self, point: Vector2) -> Vector2 {
        plus(self.place, turned(point, self.turn()), 1.0)
    }
}

/// A convex part of a body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Part {
    pub shape: Convex,
    /// Direction in which the slide moves this part along the x-axis of the body: 1, -1, or 0 for parts that do not slide.
    pub slides: f64,
}

/// A rigid body whose origin is its centre of mass; sliding parts add one degree of freedom.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Body {
    parts: [Part; MAX_PARTS],
    count: usize,
    pub pose: Pose,
    pub velocity: Velocity,
    /// How far sliding parts are from their place in the shape, m.
    pub slide: f64,
    /// Mass, kg; infinite for what never moves.
    pub mass: f64,
    /// Moment of inertia, kg m^2.
    pub inertia: f64,
    /// Mass of the sliding parts, kg.
    pub slide_mass: f64,
    /// Coefficient of friction; that of a contact is the geometric mean.
    pub friction: f64,
    pub drive: Drive,
}

impl Body {
    /// Creates a body that never moves.
    pub fn fixed(parts: &[Part], friction: f64) -> Self {
        let mut own = [Part { shape: Convex::disc(0.0), slides: 0.0 }; MAX_PARTS];
        own.iter_mut().zip(parts).for_each(|(own, part)| *own = *part);
        Self {
            parts: own,
            count: parts.len().min(MAX_PARTS),
            pose: Pose::default(),
            velocity: [0.0; 4],
            slide: 0.0,
            mass: f64::INFINITY,
            inertia: f64::INFINITY,
            slide_mass: f64::INFINITY,
            friction,
            drive: Drive::default(),
        }
    }

    /// Returns the same body, free to move.
    pub fn with_mass(self, mass: f64, inertia: f64) -> Self {
        Self { mass, inertia, ..self }
    }

    pub fn parts(&self) -> &[Part] {
        &self.parts[..self.count]
    }

    /// Returns the parts in the world.
    pub fn placed(&self) -> impl Iterator<Item = (Convex, f64)> + '_ {
        let turn = self.pose.turn();
        self.parts().iter().map(move |part| {
            let moved = turned([part.slides * self.slide, 0.0], turn);
            (part.shape.placed(plus(self.pose.place, moved, 1.0), turn), part.slides)
        })
    }

    /// Returns the signed distance of a point from the body.
    pub fn distance(&self, point: Vector2) -> f64 {
        self.placed().map(|(shape, _)| shape.distance(point)).fold(f64::INFINITY, f64::min)
    }

    /// Returns the velocity at a lever from the centre, on a part that slides.
    pub(super) fn velocity_at(&self, lever: Vector2, slide_axis: Vector2) -> Vector2 {
        let [x, y, turn, slide] = self.velocity;
        plus(plus([x, y], left(lever), turn), slide_axis, slide)
    }

    /// Returns how far a unit impulse changes the velocity along itself, per kg.
    pub(super) fn response(&self, lever: Vector2, slide_axis: Vector2, direction: Vector2) -> f64 {
        let (turn, slide) = (cross(lever, direction), dot(slide_axis, direction));
        1.0 / self.mass + turn * turn / self.inertia + slide * slide / self.slide_mass
    }

    pub(super) fn apply(&mut self, lever: Vector2, slide_axis: Vector2, impulse: Vector2) {
        self.velocity[0] += impulse[0] / self.mass;
        self.velocity[1] += impulse[1] / self.mass;
        self.velocity[2] += cross(lever, impulse) / self.inertia;
        self.velocity[3] += dot(slide_axis, impulse) / self.slide_mass;
    }

    pub(super) fn advance(&mut self, seconds: f64) {
        let [x, y, turn, slide] = self.velocity;
        self.pose.place = plus(self.pose.place, [x, y], seconds);
        self.pose.angle += turn * seconds;
        self.slide += slide * seconds;
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        snapshot.extend_numbers(self.pose.place);
        snapshot.extend_numbers([self.pose.angle, self.slide]);
        snapshot.extend_numbers(self.velocity);
    }

    pub fn load(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        let [x, y, angle, slide] = numbers(state)?;
        (self.pose, self.slide) = (Pose::new([x, y], angle), slide);
        self.velocity = numbers(state)?;
        Ok(())
    }
}
