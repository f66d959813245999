use super::vector::{Vector2, norm, plus, turned};
use super::*;

fn block(mass: f64, friction: f64) -> Body {
    let part = Part { shape: Convex::rectangle([0.0; 2], [0.05, 0.02]), slides: 0.0 };
    let mut body =
        Body::fixed(&[part], 0.5).with_mass(mass, mass * (0.05_f64.powi(2) + 0.02_f64.powi(2)) / 3.0);
    body.drive = Drive::table_friction(friction, mass, 0.028);
    body
}

#[test]
fn distances_are_those_of_geometry() {
    let shape = Convex::rectangle([0.1, 0.0], [0.05, 0.02]);
    for (point, wanted) in
        [([0.2, 0.0], 0.05), ([0.1, 0.0], -0.02), ([0.18, 0.06], 0.05), ([0.1, -0.03], 0.01)]
            as [(Vector2, f64); 4]
    {
        assert!((shape.distance(point) - wanted).abs() < 1e-12, "{point:?}");
    }
    let (area, first, second) = shape.moments();
    assert!((area - 0.004).abs() < 1e-15 && (first[0] - 4e-4).abs() < 1e-15 && first[1].abs() < 1e-15);
    let own = 0.004 * (0.05_f64.powi(2) + 0.02_f64.powi(2)) / 3.0;
    assert!((second - own - 0.004 * 0.01).abs() < 1e-12);
}

/// A block with a speed slides v^2 / (2 mu g).
#[test]
fn a_block_slides_as_far_as_coulomb_lets_it() {
    let mut world = World::new(vec![block(0.5, 0.4)]);
    world.bodies[0].velocity = [0.6, 0.8, 0.0, 0.0];
    (0..4000).for_each(|_| world.advance(2e-4));
    let slid = norm(world.bodies[0].pose.place);
    assert!((slid - 1.0 / (2.0 * 0.4 * 9.81)).abs() < 1e-3, "{slid}");
    assert_eq!(world.bodies[0].velocity[0], 0.0);
}

/// A push through the centre of friction does not turn; one beside it turns to the other side, about the centre that the limit surface gives.
#[test]
fn pushes_beside_the_centre_turn() {
    for (offset, sign) in [(0.0, 0.0), (0.02, 1.0), (-0.02, -1.0)] {
        let disc = Part { shape: Convex::disc(0.01), slides: 0.0 };
        let mut pusher = Body::fixed(&[disc], 0.5).with_mass(1.0, 1e-4);
        pusher.pose.place = [offset, -0.0301];
        pusher.drive = Drive { target: [0.0, 0.05, 0.0, 0.0], force: 30.0, length: 0.01, slide_force: 0.0 };
        let mut world = World::new(vec![pusher, block(0.2, 0.4)]);
        (0..40).for_each(|_| world.advance(0.01));
        let pose = world.bodies[1].pose;
        assert!(pose.place[1] > 0.01, "{pose:?}");
        if sign == 0.0 {
            assert!(pose.angle.abs() < 1e-9);
        } else {
            assert!(pose.angle * sign > 0.1, "{pose:?}");
        }
    }
}

/// The ratio of turning to sliding in a slow push is that of the ellipsoid: omega / v = offset / length^2 (Lynch, 1992).
#[test]
fn the_limit_surface_is_the_ellipsoid() {
    let disc = Part { shape: Convex::disc(0.005), slides: 0.0 };
    let mut pusher = Body::fixed(&[disc], 0.0).with_mass(1.0, 1e-4);
    pusher.pose.place = [0.02, -0.025];
    pusher.drive = Drive { target: [0.0, 0.01, 0.0, 0.0], force: 30.0, length: 0.01, slide_force: 0.0 };
    let mut world = World::new(vec![pusher, block(0.2, 0.4)]);
    (0..10).for_each(|_| world.advance(0.005));
    let [_, speed, turn, _] = world.bodies[1].velocity;
    let wanted = 0.02 / 0.028_f64.powi(2);
    assert!((turn / speed / wanted - 1.0).abs() < 0.02, "{} {wanted}", turn / speed);
}

#[test]
fn bodies_do_not_pass_through_walls() {
    let wall = Body::fixed(&[Part { shape: Convex::rectangle([0.2, 0.0], [0.02, 0.3]), slides: 0.0 }], 0.3);
    let mut runner = block(0.2, 0.3);
    runner.drive = Drive { target: [0.5, 0.05, 0.4, 0.0], force: 20.0, length: 0.02, slide_force: 0.0 };
    let mut world = World::new(vec![runner, wall]);
    for _ in 0..300 {
        world.advance(0.01);
        let corners: Vec<Vector2> =
            world.bodies[0].placed().flat_map(|(shape, _)| shape.corners().to_vec()).collect();
        assert!(corners.iter().all(|corner| corner[0] < 0.182), "{corners:?}");
    }
}

/// Fingers that close hold a block, and carry it.
#[test]
fn a_gripper_holds_what_it_closes_on() {
    let finger =
        |side: f64| Part { shape: Convex::rectangle([side * 0.005, 0.0], [0.005, 0.012]), slides: side };
    let mut gripper = Body::fixed(&[finger(1.0), finger(-1.0)], 0.8).with_mass(1.0, 1e-3);
    gripper.slide_mass = 0.2;
    gripper.slide = 0.04;
    let mut peg = block(0.1, 0.3);
    peg.pose.angle = std::f64::consts::FRAC_PI_2 + 0.1;
    let mut world = World::new(vec![gripper, peg]);
    let drive = Drive { force: 60.0, length: 0.03, slide_force: 20.0, target: [0.0, 0.0, 0.0, -0.1] };
    world.bodies[0].drive = drive;
    (0..60).for_each(|_| world.advance(0.01));
    assert!((world.bodies[0].slide - 0.02).abs() < 1e-3, "{}", world.bodies[0].slide);
    let grip = |world: &World| {
        let Pose { place, angle } = world.bodies[0].pose;
        let back = crate::sine_cosine::sine_cosine(-angle);
        turned(plus(world.bodies[1].pose.place, place, -1.0), back)
    };
    let before = grip(&world);
    world.bodies[0].drive.target = [0.1, 0.1, 0.3, -0.1];
    (0..200).for_each(|_| world.advance(0.01));
    let after = grip(&world);
    assert!(norm(plus(after, before, -1.0)) < 2e-3, "{before:?} {after:?}");
}
