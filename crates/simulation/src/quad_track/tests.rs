use opendr_engine::environment::{Environment, ResetOptions};
use opendr_engine::params::ParamValue;

use super::*;
use crate::{RegisteredEnvironment as _, make};

fn options(pairs: &[(&str, f64)]) -> ResetOptions {
    pairs.iter().map(|(name, value)| ((*name).to_owned(), ParamValue::Float(*value))).collect()
}

/// A stiff law on the observed errors.
fn feedback(seen: &[f32]) -> [f32; 3] {
    std::array::from_fn(|axis| {
        (5.0 * seen[axis] + 5.0 * seen[3 + axis] + seen[9 + axis]).clamp(-MAX_ACCELERATION, MAX_ACCELERATION)
    })
}

/// The RMS error from 30 s on under the feedback law.
fn flown(pairs: &[(&str, f64)], seed: u64) -> f64 {
    let mut track = QuadTrack::new(&QuadTrackParams::default()).unwrap();
    let mut seen = [0.0; OBSERVATION_LEN];
    track.reset(Some(seed), &options(pairs), &mut seen).unwrap();
    let mut sum = 0.0;
    for step in 0..6000 {
        let outcome = track.step(&feedback(&seen), &mut seen).unwrap();
        assert!(!outcome.terminated, "lost at {step}");
        if step >= 3000 {
            sum += outcome.info.get("error").unwrap().powi(2);
        }
    }
    (sum / 3000.0).sqrt()
}

#[test]
fn disturbances_show_in_the_error() {
    let nominal = flown(&[], 1);
    assert!((0.03..0.2).contains(&nominal), "{nominal}");
    for (change, least) in [
        (("mass_factor", 1.3), 0.3),
        (("wind", 5.0), 0.15),
        (("drag_factor", 4.0), 0.12),
        (("motor_loss", 0.2), 0.15),
    ] {
        let disturbed = flown(&[change], 1);
        assert!(disturbed > least && disturbed < 1.0, "{change:?}: {disturbed}");
    }
    // A load of 0.3 g over a stiffness of 5, with 1.3 times the mass.
    let hover = options(&[("mass_factor", 1.3), ("breeze", 0.0)]);
    let mut track =
        QuadTrack::new(&QuadTrackParams { reference: ReferencePath::Hover, ..Default::default() }).unwrap();
    let mut seen = [0.0; OBSERVATION_LEN];
    track.reset(Some(2), &hover, &mut seen).unwrap();
    (0..5900).for_each(|_| drop(track.step(&feedback(&seen), &mut seen).unwrap()));
    let below = track.reference().unwrap()[2] - track.position().unwrap()[2];
    assert!((below - 0.3 * 9.81 / 5.0).abs() < 0.05, "{below}");
}

/// Before the change flights of all plants are the same.
#[test]
fn the_schedule_is_kept() {
    let trace = |pairs: &[(&str, f64)]| {
        let mut track = QuadTrack::new(&QuadTrackParams::default()).unwrap();
        let mut seen = [0.0; OBSERVATION_LEN];
        track.reset(Some(3), &options(pairs), &mut seen).unwrap();
        (0..300)
            .map(|_| track.step(&feedback(&seen), &mut seen).unwrap().reward.to_bits())
            .collect::<Vec<_>>()
    };
    let early = [("change_at", 1.0)];
    let (nominal, heavy) = (trace(&early), trace(&[early[0], ("mass_factor", 1.3)]));
    let same = nominal.iter().zip(&heavy).take_while(|(a, b)| a == b).count();
    // The change is in effect in the step that begins at 1 s.
    assert_eq!(same, 100);
}

#[test]
fn episodes_repeat_and_come_back() {
    let mut track = make("QuadTrack-v1").unwrap();
    let windy = options(&[("wind", 6.0), ("change_at", 0.5), ("motor_loss", 0.2)]);
    let mut seen = [0.0; OBSERVATION_LEN];
    let fly = |track: &mut Box<dyn Environment>, seen: &mut [f32; OBSERVATION_LEN], steps: usize| {
        (0..steps)
            .map(|_| track.step(&feedback(&seen[..]), seen).unwrap().reward.to_bits())
            .collect::<Vec<_>>()
    };
    track.reset(Some(4), &windy, &mut seen).unwrap();
    let first = fly(&mut track, &mut seen, 200);
    track.reset(Some(4), &windy, &mut seen).unwrap();
    assert_eq!(fly(&mut track, &mut seen, 200), first);
    let (snapshot, there) = (track.snapshot().unwrap(), seen);
    let ahead = fly(&mut track, &mut seen, 100);
    track.restore(&snapshot).unwrap();
    let mut again = there;
    assert_eq!(fly(&mut track, &mut again, 100), ahead);
    assert_eq!(again, seen);
}

/// A flight of this version: another one needs another version of the environment.
#[test]
fn the_golden_trajectory_is_the_same_on_every_machine() {
    let mut track = QuadTrack::new(&QuadTrackParams::default()).unwrap();
    let mut seen = [0.0; OBSERVATION_LEN];
    let disturbed = options(&[
        ("change_at", 1.0),
        ("wind", 5.0),
        ("mass_factor", 1.2),
        ("motor_loss", 0.1),
        ("drag_factor", 2.0),
    ]);
    track.reset(Some(42), &disturbed, &mut seen).unwrap();
    let mut hash = opendr_engine::model::Sha256Hasher::default();
    for _ in 0..500 {
        track.step(&feedback(&seen), &mut seen).unwrap();
        seen.iter().for_each(|number| hash.update(&number.to_le_bytes()));
    }
    assert_eq!(hash.finish().to_string(), "f897f2d0e962e199d2615a7da47382800b4301ffd33e90ad1050364a9d845116");
}

#[test]
fn wrong_options_are_refused() {
    let mut track = QuadTrack::new(&QuadTrackParams::default()).unwrap();
    let mut seen = [0.0; OBSERVATION_LEN];
    for wrong in
        [("mass_factor", 0.0), ("wind", -1.0), ("payload", 1.0), ("motor_loss", f64::NAN), ("duration", 5.0)]
    {
        assert!(track.reset(Some(1), &options(&[wrong]), &mut seen).is_err(), "{wrong:?}");
    }
    assert!(track.step(&[0.0; 3], &mut seen).is_err(), "never reset");
}
