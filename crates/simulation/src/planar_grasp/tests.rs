use opendr_engine::environment::{Environment as _, ResetOptions};

use super::*;
use crate::RegisteredEnvironment as _;

fn made(object: GraspObject, seed: u64) -> PlanarGrasp {
    let params = PlanarGraspParams { object: Some(object), ..PlanarGraspParams::default() };
    let mut environment = PlanarGrasp::new(&params).unwrap();
    let mut seen = vec![0.0; environment.spec().observation.len()];
    environment.reset(Some(seed), &ResetOptions::new(), &mut seen).unwrap();
    environment
}

/// The shown grasps hold; so do ones that are off by a few millimetres and degrees, and wrong ones do not.
#[test]
fn shown_grasps_hold_and_wrong_ones_do_not() {
    for object in GraspObject::ALL {
        let (mut held, mut near, mut wrong) = (0, 0, 0);
        for seed in 0..20 {
            let environment = made(object, seed);
            let shown = environment.shown_grasp().unwrap();
            let holds = |grasp: Grasp| environment.test_grasp(&grasp).unwrap() == Outcome::Held;
            held += usize::from(holds(shown));
            near += usize::from(holds(Grasp {
                place: shown.place.map(|part| part + 0.003),
                angle: shown.angle + 0.1,
                ..shown
            }));
            wrong += usize::from(holds(Grasp { place: shown.place.map(|part| part + 0.1), ..shown }));
        }
        assert_eq!((held, wrong), (20, 0), "{object:?}");
        assert!(near >= 18, "{object:?}: {near}");
    }
}

#[test]
fn slippery_objects_fall() {
    for object in [GraspObject::Hammer, GraspObject::Bracket] {
        let params = PlanarGraspParams { friction: 0.05, force: 0.5, ..PlanarGraspParams::default() };
        let mut pose = crate::planar::Pose::default();
        let grasp = object.shown_grasp(&pose);
        assert_eq!(attempt::attempt(&params, object, &grasp, &mut pose), Outcome::Slipped);
    }
}

/// Depths of the render agree with the distances of geometry, and pixels with places.
#[test]
fn images_are_those_of_a_pinhole() {
    let params = PlanarGraspParams { depth_noise: 0.0, colour_noise: 0.0, ..PlanarGraspParams::default() };
    let shown = GraspDemonstration::record(GraspObject::Hammer, &params).unwrap();
    let camera = Camera::new(params.size);
    let opendr_engine::data::Pixels::F32(depths) = shown.depth.pixels() else { panic!("floats") };
    let [column, row] = camera.pixel(shown.grasp.place, GRASP_HEIGHT);
    let at = |column: f32, row: f32| depths[row as usize * params.size + column as usize];
    assert!((at(column, row) - (0.7 - GRASP_HEIGHT as f32)).abs() < 1e-6);
    assert!((at(2.0, 2.0) - 0.7).abs() < 1e-6);
    let back = camera.place([column, row], GRASP_HEIGHT);
    assert!((back[0] - shown.grasp.place[0]).abs() < 1e-6 && (back[1] - shown.grasp.place[1]).abs() < 1e-6);
    let grasp = camera.grasp(shown.jaws);
    let (distance, angle) = grasp.difference(&shown.grasp);
    assert!(distance < 1e-6 && angle < 1e-4 && (grasp.width - shown.grasp.width).abs() < 1e-6);
}

#[test]
fn actions_are_grasps() {
    let grasp = Grasp { place: [0.03, -0.07], angle: 2.0, width: 0.05 };
    let (distance, angle) = Grasp::of_action(grasp.action()).difference(&grasp);
    assert!(distance < 1e-6 && angle < 1e-5);
}
