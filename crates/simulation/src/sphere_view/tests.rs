use opendr_engine::Random;
use opendr_engine::data::PixelFormat;
use opendr_engine::environment::{Environment, ResetOptions};
use opendr_engine::rig::{Limit, ViewRig as _};
use opendr_engine::target::Action;

use super::*;
use crate::raycast::{Vector, along};
use crate::{make, make_vec};

fn plain(azimuth: f64) -> Conditions {
    let conditions = Conditions::draw(&mut Random::new(5));
    Conditions {
        azimuth,
        elevation: 0.1,
        distance: 2.7,
        occluder: None,
        noise: 0.0,
        exposure: 0.0,
        ..conditions
    }
}

fn picture(asset: &Asset, conditions: &Conditions) -> Vec<u8> {
    let mut world = SphereWorld::new(SIDE).unwrap();
    world.begin(asset, conditions, 1).unwrap();
    let mut pixels = vec![0; 3 * SIDE * SIDE];
    world.capture_into(&mut pixels);
    pixels
}

/// Mean difference of levels.
fn difference(a: &[u8], b: &[u8]) -> f64 {
    a.iter().zip(b).map(|(a, b)| f64::from(a.abs_diff(*b))).sum::<f64>() / a.len() as f64
}

#[test]
fn classes_differ_from_the_front_alone() {
    for subject in Subject::ALL {
        // Of the same form and colours where the class is a label; heads and figures of neighbouring numbers.
        let assets = [0, 1].map(|class| Asset::generate(subject, class, 3).unwrap());
        let between = |azimuth: f64| {
            let [one, other] = assets.each_ref().map(|asset| picture(asset, &plain(azimuth)));
            difference(&one, &other)
        };
        let (front, back) = (between(0.0), between(std::f64::consts::PI));
        if subject == Subject::Face {
            assert!(front > 3.0 * back, "{subject:?}: {front} {back}");
        }
        assert!(front > 1.0, "{subject:?}: {front}");
    }
}

#[test]
fn subjects_fit_into_their_sphere() {
    for subject in Subject::ALL {
        for class in 0..subject.classes() {
            let asset = Asset::generate(subject, class, u64::from(class)).unwrap();
            let reach = asset.bodies().map(|body| {
                let middle = body.position().iter().map(|part| part * part).sum::<f32>().sqrt();
                middle + body.shape().reach()
            });
            let reach = reach.fold(0.0, f32::max);
            assert!((0.6..1.5).contains(&reach), "{subject:?} {class}: {reach}");
        }
        assert!(subject == Subject::Face || Asset::generate(subject, subject.classes(), 0).is_err());
    }
}

#[test]
fn light_pole_noise_and_blur_are_seen() {
    let asset = Asset::generate(Subject::Face, 1, 0).unwrap();
    let base = plain(0.0);
    let clear = picture(&asset, &base);
    assert_eq!(clear, picture(&asset, &base));
    for other in [
        Conditions { light: [0.0, 1.0, 0.0], ..base },
        Conditions { occluder: Some(0.1), ..base },
        Conditions { noise: 12.0, ..base },
    ] {
        assert!(difference(&clear, &picture(&asset, &other)) > 1.0, "{other:?}");
    }
    let moved = |exposure: f32| {
        let mut world = SphereWorld::new(SIDE).unwrap();
        world.begin(&asset, &Conditions { exposure, ..base }, 1).unwrap();
        world.apply(&Action::new(&[-1.0, 0.0, 0.0]).unwrap()).unwrap();
        let mut pixels = vec![0; 3 * SIDE * SIDE];
        world.capture_into(&mut pixels);
        pixels
    };
    assert!(difference(&moved(0.0), &moved(0.2)) > 0.5);
}

#[test]
fn the_rig_hides_the_front_and_reports_limits() {
    let mut world = SphereWorld::new(SIDE).unwrap();
    let asset = Asset::generate(Subject::Pose, 1, 0).unwrap();
    world.begin(&asset, &Conditions { distance: 2.8, ..plain(1.0) }, 1).unwrap();
    assert_eq!(world.pose().azimuth, 0.0);
    let achieved = world.apply(&Action::new(&[1.0, 0.0, 1.0]).unwrap()).unwrap();
    assert_eq!(achieved.limits, [None, None, Some(Limit::Low), None]);
    let step = 35f64.to_radians();
    assert!(
        (world.pose().azimuth - step).abs() < 1e-6 && (world.true_pose().azimuth - 1.0 - step).abs() < 1e-6
    );
}

/// Scores that are sure of a class.
fn say(class: usize, classes: usize) -> Vec<f32> {
    let scores = (0..classes).map(|at| if at == class { 20.0 } else { 0.0 });
    [0.5, 0.0, 0.0].into_iter().chain(scores).collect()
}

#[test]
fn episodes_reward_a_better_answer_and_end_after_seven() {
    for subject in Subject::ALL {
        let mut environment = make(subject.id()).unwrap();
        let mut seen = vec![0.0; environment.spec().observation.len()];
        let classes = subject.classes() as usize;
        environment.reset(Some(3), &ResetOptions::new(), &mut seen).unwrap();
        // One of the classes is the true one, and only that succeeds.
        let mut successes = 0;
        for class in 0..classes {
            environment.reset(Some(3), &ResetOptions::new(), &mut seen).unwrap();
            let mut earned = 0.0;
            for number in 1..=MOVES + 1 {
                let step = environment.step(&say(class, classes), &mut seen).unwrap();
                earned += step.reward;
                assert_eq!(step.terminated, number == MOVES + 1);
                if step.terminated {
                    let success = step.info.success().unwrap();
                    successes += u32::from(success);
                    assert_eq!(success, earned > 0.5, "{earned}");
                }
            }
        }
        assert_eq!(successes, 1, "{subject:?}");
    }
}

#[test]
fn episodes_repeat_and_restore_bit_for_bit() {
    for subject in Subject::ALL {
        let mut environment = make(subject.id()).unwrap();
        let mut seen = vec![0.0; environment.spec().observation.len()];
        let action = say(0, subject.classes() as usize);
        environment.reset(Some(8), &ResetOptions::new(), &mut seen).unwrap();
        environment.step(&action, &mut seen).unwrap();
        let snapshot = environment.snapshot().unwrap();
        let step = environment.step(&action, &mut seen).unwrap();
        let mut other = make(subject.id()).unwrap();
        let mut again = vec![0.0; seen.len()];
        other.restore(&snapshot).unwrap();
        assert_eq!((other.step(&action, &mut again).unwrap(), &again), (step, &seen), "{subject:?}");
        assert!(environment.render().unwrap().is_some());
    }
}

#[test]
fn galleries_are_other_persons() {
    let first = |gallery: u32| {
        let mut environment = SphereView::new(Subject::Face, &SphereViewParams { gallery }).unwrap();
        let mut seen = vec![0.0; environment.spec().observation.len()];
        // Some of these views show the front, and only the front differs.
        let mut view = |seed| {
            environment.reset(Some(seed), &ResetOptions::new(), &mut seen).unwrap();
            seen.clone()
        };
        (0..12).map(&mut view).collect::<Vec<_>>()
    };
    let views = first(0).into_iter().zip(first(1));
    assert!(views.filter(|(one, other)| one != other).count() > 0);
    assert!(make_vec("SphereView-Face-v1", crate::vector::VectorOptions::new(2)).is_ok());
}

#[test]
fn textured_meshes_have_the_colours_of_the_subject() {
    for subject in Subject::ALL {
        let asset = Asset::generate(subject, 3, 0).unwrap();
        let [mut upright, mut inverted, mut all] = [0; 3];
        for (number, (body, mesh)) in asset.textured_parts().unwrap().iter().enumerate() {
            let side = mesh.texture.width() as f32;
            let pixels = mesh.texture.hwc_u8(PixelFormat::Rgb);
            for face in &mesh.faces {
                let mean =
                    |of: &dyn Fn(usize) -> f32| face.map(|at| of(at as usize)).iter().sum::<f32>() / 3.0;
                let point: Vector = std::array::from_fn(|axis| mean(&|at| mesh.vertices[at][axis]));
                let [right, up] = [0, 1].map(|axis| mean(&|at| mesh.texture_coordinates[at][axis]));
                let world =
                    (0..3).fold(body.position(), |sum, axis| along(sum, body.axes()[axis], point[axis]));
                let (texel, _) = asset.texel(number, world).unwrap();
                let is_near = |down: f32| {
                    let pixel = (down * side) as usize * side as usize + (right * side) as usize;
                    let level = |part: usize| f32::from(pixels[3 * pixel + part]) / 255.0;
                    (0..3).all(|part| (texel.colour[part] - level(part)).abs() < 0.02)
                };
                upright += usize::from(is_near(1.0 - up));
                inverted += usize::from(is_near(up));
                all += 1;
            }
        }
        // The middle of a triangle and the middle of its corners in the texture may be neighbours.
        assert!(upright * 20 > all * 19, "{subject:?}: {upright} of {all}");
        // Every part of a figure has one colour.
        assert!(inverted < upright || subject == Subject::Pose, "{subject:?}: {inverted}");
    }
}
