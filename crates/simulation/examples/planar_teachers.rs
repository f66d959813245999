//! Measures the scripted teachers of the planar worlds over 500 episodes, and the speed of the worlds.
//!
//! ```console
//! $ cargo run --release -p opendr-simulation --example planar_teachers [episodes [film.gif]]
//! ```

use std::time::Instant;

use opendr_engine::environment::{Controller, Environment, ResetOptions};
use opendr_engine::{Random, Result};
use opendr_simulation::planar_peg::PegTeacher;
use opendr_simulation::planar_push::PushTeacher;
use opendr_simulation::{Recording, make};

/// Seed of the first episode: that of evaluations.
const FIRST_SEED: u64 = 1_000_000;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let episodes = arguments.next().and_then(|text| text.parse().ok()).unwrap_or(500);
    let film = arguments.next();
    let teachers: [(&str, Box<dyn Controller>); 2] =
        [("PlanarPush-v1", Box::<PushTeacher>::default()), ("PlanarPeg-v1", Box::<PegTeacher>::default())];
    for (id, mut teacher) in teachers {
        let mut environment = make(id)?;
        let (mut successes, mut steps, mut failed) = (0, 0, Vec::new());
        let begun = Instant::now();
        for seed in FIRST_SEED..FIRST_SEED + episodes {
            let (success, length) = demonstrate(&mut *teacher, &mut *environment, seed, None)?;
            successes += u64::from(success);
            steps += length;
            if !success {
                failed.push(seed);
            }
        }
        let seconds = begun.elapsed().as_secs_f64();
        println!(
            "{id}: {successes} of {episodes} episodes, {:.1} steps on average, {:.1} ms an episode; failed {failed:?}",
            steps as f64 / episodes as f64,
            1e3 * seconds / episodes as f64
        );
        println!("{id}: {:.0} steps/s with random actions", speed(id)?);
        if let Some(film) = &film {
            let mut recording = Recording::create(format!("{id}-{film}"), 10.0)?;
            for seed in FIRST_SEED..FIRST_SEED + 3 {
                demonstrate(&mut *teacher, &mut *environment, seed, Some(&mut recording))?;
            }
            recording.finish()?;
        }
    }
    Ok(())
}

/// Returns success and length of an episode.
fn demonstrate(
    teacher: &mut dyn Controller,
    environment: &mut dyn Environment,
    seed: u64,
    mut recording: Option<&mut Recording>,
) -> Result<(bool, u64)> {
    let spec = environment.spec();
    let (mut seen, mut action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
    environment.reset(Some(seed), &ResetOptions::new(), &mut seen)?;
    teacher.reset();
    let mut length = 0;
    loop {
        teacher.act(&seen, &mut action)?;
        let step = environment.step(&action, &mut seen)?;
        length += 1;
        if let Some(recording) = &mut recording
            && let Some(image) = environment.render()?
        {
            recording.write(&image)?;
        }
        if step.is_over() {
            return Ok((step.info.success() == Some(true), length));
        }
    }
}

/// Returns the steps per second of wall clock.
fn speed(id: &str) -> Result<f64> {
    let mut environment = make(id)?;
    let spec = environment.spec().clone();
    let (mut seen, mut action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
    let mut random = Random::new(1);
    environment.reset(Some(1), &ResetOptions::new(), &mut seen)?;
    let begun = Instant::now();
    for _ in 0..10_000 {
        spec.action.sample_into(&mut random, &mut action);
        if environment.step(&action, &mut seen)?.is_over() {
            environment.reset(None, &ResetOptions::new(), &mut seen)?;
        }
    }
    Ok(1e4 / begun.elapsed().as_secs_f64())
}
