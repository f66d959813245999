//! The bodies: gripper, peg, post, and the wall with the slot.

use opendr_engine::Random;
use opendr_engine::environment::{Snapshot, StateReader};

use super::{
    CONTROL_PERIOD, DEPTH, MAX_SPEEDS, MOUTH, OBSERVATION_LEN, OPENING, PEG, POST, POST_RADIUS,
    PlanarPegParams, REACH,
};
use crate::planar::vector::{Vector2, limited, norm, plus, turned};
use crate::planar::{Body, Convex, Drive, Part, Pose, World};

/// Steps of the physics in one of the environment.
const SUBSTEPS: usize = 10;
/// Half length and half width of a finger, m.
const FINGER: [f64; 2] = [0.012, 0.005];
/// Half width and half length of the palm, m, and how far it is behind the fingers.
const PALM: ([f64; 2], f64) = ([0.042, 0.008], 0.035);
/// Friction of the fingers with something of the same surface.
const FINGER_FRICTION: f64 = 0.9;
/// Depth of the slot, and the rounding of its edges by a chamfer, m.
const SLOT: (f64, f64) = (0.06, 0.008);
/// Force of a closing finger, N.
const GRIP: f64 = 6.0;
const GRIPPER: usize = 0;
const PEG_BODY: usize = 1;

/// The physics of an episode.
#[derive(Debug, Clone)]
pub(super) struct Bench {
    world: World,
    slot: f64,
}

/// Returns a body of one rectangle.
fn part(centre: Vector2, half: Vector2, slides: f64) -> Part {
    Part { shape: Convex::rectangle(centre, half), slides }
}

impl Bench {
    pub fn new(params: &PlanarPegParams, gripper: Pose, peg: Pose, slot: f64) -> Self {
        let finger = |side: f64| part([side * FINGER[1], 0.0], [FINGER[1], FINGER[0]], side);
        let (palm, behind) = PALM;
        let parts = [finger(1.0), finger(-1.0), part([0.0, -behind], palm, 0.0)];
        let mut hand = Body::fixed(&parts, FINGER_FRICTION).with_mass(1.0, 1e-3);
        (hand.pose, hand.slide, hand.slide_mass) = (gripper, OPENING, 0.3);
        hand.drive = Drive { force: 30.0, length: 0.03, slide_force: GRIP, ..Drive::default() };
        let radius = ((PEG[0] * PEG[0] + PEG[1] * PEG[1]) / 3.0).sqrt();
        let mut block = Body::fixed(&[part([0.0; 2], [PEG[1], PEG[0]], 0.0)], params.friction)
            .with_mass(params.mass, params.mass * radius * radius);
        block.pose = peg;
        block.drive = Drive::table_friction(0.3, params.mass, 0.9 * radius);
        let mut post =
            Body::fixed(&[Part { shape: Convex::disc(POST_RADIUS), slides: 0.0 }], params.friction);
        post.pose.place = POST;
        let walls = walls(PEG[1] + params.clearance, slot);
        Self { world: World::new(vec![hand, block, post, Body::fixed(&walls, params.friction)]), slot }
    }

    /// Draws the start of an episode: the peg before the post, the gripper beside it.
    pub fn draw(params: &PlanarPegParams, random: &mut Random) -> Self {
        let mut spread = |most: f64| most * (2.0 * random.unit() - 1.0);
        let peg = Pose::new([spread(params.peg_spread), -0.16 + spread(0.015)], spread(params.turn));
        let slot = spread(params.slot_spread);
        loop {
            let gripper = Pose::new([spread(0.2), 0.03 + spread(0.05)], spread(0.4));
            let bench = Self::new(params, gripper, peg, slot);
            let hand = bench.gripper();
            let corners = hand.placed().flat_map(|(shape, _)| shape.corners().to_vec());
            let free =
                |corner: Vector2| bench.world.bodies[1..].iter().all(|body| body.distance(corner) > 0.01);
            let beside_post = gripper.place[0].abs() > 0.08 && hand.distance(POST) > POST_RADIUS + 0.01;
            if beside_post && corners.into_iter().all(free) {
                return bench;
            }
        }
    }

    pub fn world(&self) -> &World {
        &self.world
    }

    pub fn gripper(&self) -> &Body {
        &self.world.bodies[GRIPPER]
    }

    pub fn peg(&self) -> &Body {
        &self.world.bodies[PEG_BODY]
    }

    /// Advances by a control period with the velocities of an action as shares of [`MAX_SPEEDS`].
    pub fn advance(&mut self, action: [f64; 4]) {
        let [fast, turn, open] = MAX_SPEEDS;
        let velocity = limited([action[0], action[1]], 1.0).map(|part| part * fast);
        for _ in 0..SUBSTEPS {
            let hand = &mut self.world.bodies[GRIPPER];
            let inward = |axis: usize| match hand.pose.place[axis] * velocity[axis].signum() > REACH {
                true => 0.0,
                false => velocity[axis],
            };
            hand.drive.target = [inward(0), inward(1), action[2] * turn, action[3] * open];
            self.world.advance(CONTROL_PERIOD / SUBSTEPS as f64);
            // The stops of the slide.
            let hand = &mut self.world.bodies[GRIPPER];
            let stopped = hand.slide.clamp(0.0, OPENING);
            if stopped != hand.slide {
                (hand.slide, hand.velocity[3]) = (stopped, 0.0);
            }
        }
    }

    /// Returns the front of the peg: the end that points to the wall.
    pub fn tip(&self) -> Vector2 {
        let pose = self.peg().pose;
        let along = turned([0.0, PEG[0]], pose.turn());
        plus(pose.place, along, along[1].signum())
    }

    /// Returns how deep the tip is in the slot, m; none beside it.
    pub fn depth(&self) -> Option<f64> {
        let tip = self.tip();
        ((tip[0] - self.slot).abs() < 2.0 * PEG[1]).then_some(tip[1] - MOUTH)
    }

    pub fn succeeded(&self) -> bool {
        self.depth().is_some_and(|depth| depth > DEPTH)
    }

    /// Returns distance of the tip from the bottom of a successful insertion, m, and of the gripper from the peg.
    pub fn errors(&self) -> (f64, f64) {
        let (tip, peg) = (self.tip(), self.peg().pose.place);
        let goal = [self.slot, MOUTH + DEPTH];
        (norm(plus(tip, goal, -1.0)), norm(plus(peg, self.gripper().pose.place, -1.0)))
    }

    pub fn lost(&self) -> bool {
        self.peg().pose.place.iter().any(|part| part.abs() > REACH)
    }

    /// Writes gripper, opening, peg and slot: places over the reach, cosine and sine, the opening over the widest.
    pub fn observe(&self, observation: &mut [f32]) {
        let (hand, peg) = (self.gripper(), self.peg().pose);
        let ((hand_sine, hand_cosine), (peg_sine, peg_cosine)) = (hand.pose.turn(), peg.turn());
        let scaled = |number: f64| (number / REACH).clamp(-1.2, 1.2);
        let seen = [
            scaled(hand.pose.place[0]),
            scaled(hand.pose.place[1]),
            hand_cosine,
            hand_sine,
            hand.slide / OPENING,
            scaled(peg.place[0]),
            scaled(peg.place[1]),
            peg_cosine,
            peg_sine,
            scaled(self.slot),
        ];
        observation.iter_mut().zip(seen).for_each(|(own, number)| *own = number as f32);
    }

    pub fn save(&self, snapshot: &mut Snapshot) {
        self.world.save(snapshot);
    }

    pub fn load(&mut self, state: &mut StateReader<'_>) -> opendr_engine::Result<()> {
        self.world.load(state)
    }
}

const _: () = assert!(OBSERVATION_LEN == 10);

/// The wall left and right of the slot with chamfered edges, and the bottom of the slot.
fn walls(half: f64, slot: f64) -> [Part; 3] {
    let (depth, chamfer) = SLOT;
    let top = MOUTH + 2.0 * depth;
    let side = |sign: f64| {
        let (near, far) = (slot + sign * half, sign * 1.5 * REACH);
        let mut corners =
            [[near + sign * chamfer, MOUTH], [near, MOUTH + chamfer], [near, top], [far, top], [far, MOUTH]];
        // Counter-clockwise: the order above is that of the left side.
        if sign > 0.0 {
            corners.reverse();
        }
        Part { shape: Convex::polygon(&corners), slides: 0.0 }
    };
    [side(-1.0), side(1.0), part([slot, top - 0.5 * depth], [half, 0.5 * depth], 0.0)]
}
