//! How often controllers without learning fly through the corridor, in 500 fixed worlds:
//! `cargo run --release -p opendr-simulation --example corridor_baselines [ID [WORLDS]]`.

use std::time::Instant;

use opendr_engine::environment::{Environment as _, ResetOptions};
use opendr_engine::params::Params as _;
use opendr_engine::{Error, Result};
use opendr_simulation::uav_corridor::{
    CorridorController, CorridorSight, PotentialField, Reactive, Straight, UavDepthCorridor,
    UavDepthCorridorParams,
};
use opendr_simulation::{Registered as _, Registry, make};

/// Seeds of the worlds that policies are evaluated in begin here.
const FIRST_SEED: u64 = 1_000_000;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let id = arguments.next().unwrap_or_else(|| "UavDepthCorridor-v1".to_owned());
    let worlds = arguments.next().map_or(Ok(500), |text| text.parse());
    let worlds = worlds.map_err(|_| Error::invalid_param("the number of worlds is no whole number"))?;
    println!("{id}: {} of {worlds} worlds have a way", passable(&id, worlds)?);
    let controllers: [(&str, &mut dyn CorridorController); 3] = [
        ("straight", &mut Straight),
        ("by hand", &mut Reactive::default()),
        ("potential field", &mut PotentialField::default()),
    ];
    for (name, controller) in controllers {
        let begin = Instant::now();
        let [successes, collisions, steps] = flown(&id, controller, worlds)?;
        let (low, high) = wilson(successes as f64, worlds as f64);
        let percent = |count: usize| 100.0 * count as f64 / worlds as f64;
        println!(
            "{name}: success {:.1} % (95 %: {:.1} to {:.1}), collisions {:.1} %, {steps} steps in {:.2} s",
            percent(successes),
            100.0 * low,
            100.0 * high,
            percent(collisions),
            begin.elapsed().as_secs_f64()
        );
    }
    Ok(())
}

fn passable(id: &str, worlds: u64) -> Result<usize> {
    let fields = Registry::builtin().get(id)?.fields();
    let defaults = fields.iter().map(|field| (field.name.to_owned(), field.default.value())).collect();
    let mut corridor = UavDepthCorridor::new(&UavDepthCorridorParams::from_map(&defaults)?)?;
    let mut seen = vec![0.0; corridor.spec().observation.len()];
    let mut count = 0;
    for world in 0..worlds {
        corridor.reset(Some(FIRST_SEED + world), &ResetOptions::new(), &mut seen)?;
        count += usize::from(corridor.world().is_passable());
    }
    Ok(count)
}

/// Successes, collisions, steps.
fn flown(id: &str, controller: &mut dyn CorridorController, worlds: u64) -> Result<[usize; 3]> {
    let mut environment = make(id)?;
    let space = environment.spec().observation.clone();
    let (mut seen, mut sight) = (vec![0.0; space.len()], CorridorSight::default());
    let mut counts = [0; 3];
    for world in 0..worlds {
        environment.reset(Some(FIRST_SEED + world), &ResetOptions::new(), &mut seen)?;
        controller.begin();
        loop {
            sight.read(&space, &seen)?;
            let step = environment.step(&controller.act(&sight), &mut seen)?;
            counts[2] += 1;
            if step.is_over() {
                counts[0] += usize::from(step.info.get("success") == Some(1.0));
                counts[1] += usize::from(step.info.get("collision") == Some(1.0));
                break;
            }
        }
    }
    Ok(counts)
}

/// The interval of Wilson (1927).
fn wilson(successes: f64, trials: f64) -> (f64, f64) {
    const Z: f64 = 1.96;
    let share = successes / trials;
    let middle = share + Z * Z / (2.0 * trials);
    let half = Z * (share * (1.0 - share) / trials + Z * Z / (4.0 * trials * trials)).sqrt();
    let scale = 1.0 + Z * Z / trials;
    ((middle - half) / scale, (middle + half) / scale)
}
