//! Pendulum: a rod of 1 m and 1 kg with a motor of 2 N m.

use opendr_simulation::classic_control::PendulumParams;

use super::episode::Episode;
use super::link::Link;
use super::world::{Physics, World, robot};

pub(super) fn world(episode: &Episode) -> World {
    let gravity = episode.params::<PendulumParams>().map_or(10.0, |params| params.g);
    let (cosine, sine, turning) = (episode.number(0), episode.number(1), episode.number(2));
    // The environment measures the angle from upright, a link from hanging; a positive torque increases both. The view is mirrored.
    let from_hanging = sine.atan2(cosine) + std::f64::consts::PI;
    let half = 0.5;
    let link = Link {
        name: "rod",
        anchor: [0.0; 3],
        angle: from_hanging,
        velocity: [-half * turning * from_hanging.cos(), 0.0, half * turning * from_hanging.sin()],
        turning,
        // Of a rod about its centre.
        inertia: 1.0 / 12.0,
        torque: Some(2.0),
        children: Vec::new(),
    };
    let physics = Physics { step_ms: 50.0, gravity };
    World::new(episode, &physics, [0.0, -5.0, 0.0], [0.0, 0.0, 1.0, std::f64::consts::FRAC_PI_2])
        .with(robot("pendulum", vec![link.joint()]))
}
