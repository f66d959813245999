//! Contacts between two bodies.

use super::body::Body;
use super::shape::Convex;
use super::vector::{Vector2, dot, left, plus, turned};

/// Distance below which a contact is solved for, m: none is crossed within a step.
const MARGIN: f64 = 0.01;
/// Share of a penetration that is removed in a step, and the fastest removal, m/s.
const CORRECTION: (f64, f64) = (0.2, 0.3);
/// Penetration that is left alone, m: a contact at rest stays one.
const SLOP: f64 = 2e-5;

/// A point where two bodies touch or nearly do, with the impulses of this step.
#[derive(Debug, Clone, Copy)]
pub(super) struct Contact {
    /// Indices of the bodies; the normal points to the first.
    pub bodies: [usize; 2],
    levers: [Vector2; 2],
    slides: [Vector2; 2],
    normal: Vector2,
    gap: f64,
    friction: f64,
    pressed: f64,
    rubbed: f64,
}

/// Adds the contacts of two bodies: corners of each near the other.
pub(super) fn find(bodies: &[Body], pair: [usize; 2], contacts: &mut Vec<Contact>) {
    let [first, second] = pair.map(|at| &bodies[at]);
    let axes = [first, second].map(|body| turned([1.0, 0.0], body.pose.turn()));
    for (one, one_slides) in first.placed() {
        for (other, other_slides) in second.placed() {
            let slides = [axes[0].map(|part| part * one_slides), axes[1].map(|part| part * other_slides)];
            let mut add = |point: Vector2, normal: Vector2, gap: f64| {
                contacts.push(Contact {
                    bodies: pair,
                    levers: [first, second].map(|body| plus(point, body.pose.place, -1.0)),
                    slides,
                    normal,
                    gap,
                    friction: (first.friction * second.friction).sqrt(),
                    pressed: 0.0,
                    rubbed: 0.0,
                });
            };
            let rounding = one.radius + other.radius;
            corners_near(&one, &other, rounding, &mut |point, normal, gap| add(point, normal, gap));
            // Two discs have one contact, not one from either side.
            if one.corners().len() + other.corners().len() > 2 {
                corners_near(&other, &one, rounding, &mut |point, normal, gap| {
                    add(point, normal.map(|part| -part), gap);
                });
            }
        }
    }
}

fn corners_near(of: &Convex, shape: &Convex, rounding: f64, add: &mut dyn FnMut(Vector2, Vector2, f64)) {
    for corner in of.corners() {
        let nearest = shape.nearest(*corner);
        let gap = nearest.distance - rounding;
        if gap < MARGIN {
            add(plus(nearest.point, nearest.normal, shape.radius + 0.5 * gap), nearest.normal, gap);
        }
    }
}

impl Contact {
    /// Performs one pass of Gauss-Seidel: the impulse along the normal presses only, that across is at most `friction` times as large.
    pub fn solve(&mut self, bodies: &mut [Body], seconds: f64) {
        let tangent = left(self.normal);
        let bias = if self.gap > 0.0 {
            -self.gap / seconds
        } else {
            (-(self.gap + SLOP).min(0.0) * CORRECTION.0 / seconds).min(CORRECTION.1)
        };
        let speed = dot(self.relative(bodies), self.normal);
        let pressed = (self.pressed - (speed - bias) * self.mass(bodies, self.normal)).max(0.0);
        self.push(bodies, self.normal, pressed - self.pressed);
        self.pressed = pressed;
        let limit = self.friction * pressed;
        let speed = dot(self.relative(bodies), tangent);
        let rubbed = (self.rubbed - speed * self.mass(bodies, tangent)).clamp(-limit, limit);
        self.push(bodies, tangent, rubbed - self.rubbed);
        self.rubbed = rubbed;
    }

    /// Returns the impulse along the normal, N s.
    pub fn pressed(&self) -> f64 {
        self.pressed
    }

    fn relative(&self, bodies: &[Body]) -> Vector2 {
        let [one, other] = self.bodies.map(|at| &bodies[at]);
        let velocity = one.velocity_at(self.levers[0], self.slides[0]);
        plus(velocity, other.velocity_at(self.levers[1], self.slides[1]), -1.0)
    }

    fn mass(&self, bodies: &[Body], direction: Vector2) -> f64 {
        let [one, other] = self.bodies.map(|at| &bodies[at]);
        1.0 / (one.response(self.levers[0], self.slides[0], direction)
            + other.response(self.levers[1], self.slides[1], direction))
    }

    fn push(&self, bodies: &mut [Body], direction: Vector2, impulse: f64) {
        for (side, sign) in [1.0, -1.0].into_iter().enumerate() {
            let impulse = direction.map(|part| part * impulse * sign);
            bodies[self.bodies[side]].apply(self.levers[side], self.slides[side], impulse);
        }
    }
}
