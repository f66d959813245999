//! The bodies on the table: the T and the pusher.

use opendr_engine::Random;

use super::{
    CONTROL_PERIOD, MAX_SPEED, OBSERVATION_LEN, PUSHER_RADIUS, PlanarPushParams, REACH, TABLE, TOLERANCE,
};
use crate::planar::vector::{Vector2, limited, norm};
use crate::planar::{Body, Convex, Drive, Part, Pose, World};
use crate::sine_cosine::sine_cosine;

/// Steps of the physics in one of the environment.
const SUBSTEPS: usize = 10;
/// The bar and the stem of the T: centres and half sizes, m, the origin in the middle of their seam.
const BAR: (Vector2, Vector2) = ([0.0, 0.015], [0.06, 0.015]);
const STEM: (Vector2, Vector2) = ([0.0, -0.045], [0.015, 0.045]);
/// Mean distance of the area of the T from its centre, as a share of the radius of gyration (0.92 to 0.96 for compact areas).
const FRICTION_LENGTH: f64 = 0.93;
/// Places of the bodies in the world.
const PUSHER: usize = 0;
const TEE: usize = 1;

/// The pose that the T is pushed to: that of Push-T, turned by 45 degrees.
pub(super) const GOAL: Pose = Pose { place: [0.0, 0.0], angle: std::f64::consts::FRAC_PI_4 };

/// The physics of an episode.
#[derive(Debug, Clone)]
pub(super) struct Table {
    world: World,
}

impl Table {
    pub fn new(params: &PlanarPushParams, pusher: Vector2, tee: Pose) -> Self {
        let disc = Part { shape: Convex::disc(PUSHER_RADIUS), slides: 0.0 };
        let mut hand = Body::fixed(&[disc], params.contact_friction).with_mass(1.0, 1e-4);
        hand.pose.place = pusher;
        hand.drive = Drive { force: 30.0, length: 0.01, ..Drive::default() };
        let (parts, radius) = tee_parts();
        let mut body = Body::fixed(&parts, params.contact_friction)
            .with_mass(params.mass, params.mass * radius * radius);
        body.pose = tee;
        body.drive = Drive::table_friction(params.table_friction, params.mass, FRICTION_LENGTH * radius);
        Self { world: World::new(vec![hand, body]) }
    }

    /// Draws the start of an episode.
    pub fn draw(params: &PlanarPushParams, random: &mut Random) -> Self {
        let (sine, cosine) = sine_cosine(std::f64::consts::TAU * random.unit());
        let distance = params.distance * (0.5 + 0.5 * random.unit());
        let angle = GOAL.angle + params.turn * (2.0 * random.unit() - 1.0);
        let tee = Pose::new([distance * cosine, distance * sine], angle);
        loop {
            let pusher = [(); 2].map(|()| TABLE * (2.0 * random.unit() - 1.0));
            let table = Self::new(params, pusher, tee);
            if table.tee().distance(pusher) > PUSHER_RADIUS + 0.03 {
                return table;
            }
        }
    }

    pub fn world(&self) -> &World {
        &self.world
    }

    pub fn world_mut(&mut self) -> &mut World {
        &mut self.world
    }

    pub fn tee(&self) -> &Body {
        &self.world.bodies[TEE]
    }

    pub fn pusher(&self) -> Vector2 {
        self.world.bodies[PUSHER].pose.place
    }

    /// Advances by a control period with the pusher at a velocity as a share of [`MAX_SPEED`], cut to a length of 1 and to the reach.
    pub fn advance(&mut self, action: Vector2) {
        let velocity = limited(action, 1.0).map(|part| part * MAX_SPEED);
        for _ in 0..SUBSTEPS {
            let place = self.pusher();
            let inward = |axis: usize| match place[axis].abs() > REACH && place[axis] * velocity[axis] > 0.0 {
                true => 0.0,
                false => velocity[axis],
            };
            self.world.bodies[PUSHER].drive.target = [inward(0), inward(1), 0.0, 0.0];
            self.world.advance(CONTROL_PERIOD / SUBSTEPS as f64);
        }
    }

    /// Returns distance, m, and chord of the angle (2 sin(angle / 2)) of the T from the goal.
    pub fn errors(&self) -> (f64, f64) {
        let pose = self.tee().pose;
        let (_, cosine) = sine_cosine(pose.angle - GOAL.angle);
        (norm(pose.place), (2.0 - 2.0 * cosine).max(0.0).sqrt())
    }

    pub fn succeeded(&self) -> bool {
        let (distance, chord) = self.errors();
        // A chord of a small angle is the angle, less a 24th of its cube.
        distance < TOLERANCE.0 && chord < TOLERANCE.1 - TOLERANCE.1.powi(3) / 24.0
    }

    /// Returns errors in tolerances, as the reward counts them.
    pub fn cost(&self) -> f64 {
        let (distance, chord) = self.errors();
        let (near, turned) = TOLERANCE;
        ((distance / near).powi(2) + (chord / turned).powi(2)).sqrt()
    }

    pub fn off_the_table(&self) -> bool {
        self.tee().pose.place.iter().any(|part| part.abs() > TABLE)
    }

    /// Writes pusher and T: places over [`REACH`], cosine and sine.
    pub fn observe(&self, observation: &mut [f32]) {
        let (pusher, pose) = (self.pusher(), self.tee().pose);
        let (sine, cosine) = pose.turn();
        let scaled =
            [pusher[0], pusher[1], pose.place[0], pose.place[1]].map(|part| (part / REACH).clamp(-1.2, 1.2));
        let seen = scaled.into_iter().chain([cosine, sine]);
        observation.iter_mut().zip(seen).for_each(|(own, number)| *own = number as f32);
    }

    /// Returns the table that an observation shows, at rest.
    pub fn observed(params: &PlanarPushParams, observation: &[f32; OBSERVATION_LEN]) -> Self {
        let [px, py, x, y, cosine, sine] = observation.map(f64::from);
        let pusher = [px * REACH, py * REACH];
        Self::new(params, pusher, Pose::new([x * REACH, y * REACH], sine.atan2(cosine)))
    }

    /// Moves the pusher, as if it had been lifted.
    pub fn put_pusher(&mut self, place: Vector2) {
        let hand = &mut self.world.bodies[PUSHER];
        (hand.pose.place, hand.velocity) = (place, [0.0; 4]);
    }
}

/// Returns bar and stem about their centre of mass, and the radius of gyration.
fn tee_parts() -> ([Part; 2], f64) {
    let shapes = [BAR, STEM].map(|(centre, half)| Convex::rectangle(centre, half));
    let moments = shapes.map(|shape| shape.moments());
    let area: f64 = moments.iter().map(|(area, ..)| area).sum();
    let middle = [0, 1].map(|axis| moments.iter().map(|(_, first, _)| first[axis]).sum::<f64>() / area);
    let parts =
        shapes.map(|shape| Part { shape: shape.placed(middle.map(|part| -part), (0.0, 1.0)), slides: 0.0 });
    let second: f64 = parts.iter().map(|part| part.shape.moments().2).sum();
    (parts, (second / area).sqrt())
}
