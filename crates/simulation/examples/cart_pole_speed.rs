//! Steps of `CartPole-v1` per second, on one core: `cargo run --release -p opendr-simulation --example cart_pole_speed`.

use std::time::Instant;

use opendr_engine::environment::ResetOptions;
use opendr_engine::{Random, Result};
use opendr_simulation::make_vec;
use opendr_simulation::vector::{Batch, Seeds, VectorOptions};

fn main() -> Result<()> {
    for count in [1, 64, 1024, 16_384] {
        let mut vector = make_vec("CartPole-v1", VectorOptions::new(count))?;
        let mut batch = Batch::new(vector.spec(), count);
        vector.reset(Seeds::From(0), &ResetOptions::new(), None, &mut batch)?;
        let mut random = Random::new(1);
        let actions: Vec<Vec<f32>> =
            (0..61).map(|_| (0..count).map(|_| random.below(2) as f32).collect()).collect();
        let (steps, begin) = (8_000_000 / count, Instant::now());
        for action in actions.iter().cycle().take(steps) {
            vector.step(action, &mut batch)?;
        }
        let rate = (steps * count) as f64 / begin.elapsed().as_secs_f64();
        println!("{count} carts: {:.1} million steps per second", rate / 1e6);
    }
    Ok(())
}
