//! Records an episode: `cargo run --release -p opendr-simulation --example record [ID [FILE [SEED]]]`.
//!
//! The drone has a hand-written controller, other environments random actions. The file ends in `.gif`, `.mp4` or `.png`.

use opendr_engine::environment::ResetOptions;
use opendr_engine::{Error, Random, Result};
use opendr_simulation::uav_corridor::{CorridorController as _, CorridorObservation, ReactiveController};
use opendr_simulation::{Recording, make};

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let id = arguments.next().unwrap_or_else(|| "UavDepthCorridor-v1".to_owned());
    let file = arguments.next().unwrap_or_else(|| "episode.gif".to_owned());
    let seed = arguments.next().map_or(Ok(1_000_000), |text| text.parse());
    let seed = seed.map_err(|_| Error::invalid_param("the seed is not a whole number"))?;

    let mut environment = make(&id)?;
    let spec = environment.spec().clone();
    let (mut seen, mut action) = (vec![0.0; spec.observation.len()], vec![0.0; spec.action.len()]);
    let (mut random, mut pilot) = (Random::new(seed), ReactiveController::default());
    let mut sight = CorridorObservation::default();
    let mut film = Recording::create(&file, 10.0)?;
    environment.reset(Some(seed), &ResetOptions::new(), &mut seen)?;
    let mut steps = 0;
    loop {
        let image = environment.render()?;
        film.write(&image.ok_or_else(|| Error::unsupported(format!("{id} cannot be rendered")))?)?;
        match action.len() {
            2 => {
                sight.read(&spec.observation, &seen)?;
                action.copy_from_slice(&pilot.act(&sight));
            }
            _ => spec.action.sample_into(&mut random, &mut action),
        }
        let step = environment.step(&action, &mut seen)?;
        steps += 1;
        if step.is_over() {
            film.write(&environment.render()?.ok_or_else(|| Error::internal("an image is missing"))?)?;
            println!("{file}: {steps} steps of {id}, {:?}", step.info.iter().collect::<Vec<_>>());
            return film.finish();
        }
    }
}
