//! Swings up a pendulum with a trained policy, in a strip of images of the episode. Needs no input.

use opendr::data::{Image, Observation};
use opendr::environment::ResetOptions;
use opendr::learner::Ports;
use opendr::{Value, simulation, vision};

pub fn main() -> opendr::Result<()> {
    let mut policy = opendr::learner("sac")?;
    let mut env = simulation::make("Pendulum-v1")?;
    let mut seen = [0.0; 3];
    env.reset(Some(3), &ResetOptions::new(), &mut seen)?;
    let (mut images, mut total) = (Vec::new(), 0.0);
    for step in 0..100 {
        if step % 10 == 0 {
            images.extend(env.render()?);
        }
        let observation = Observation::from_data(seen.to_vec())?;
        let outputs = policy.infer(&Ports::one(&observation))?;
        let Some(Value::RlTarget(action)) = outputs.first() else { break };
        total += env.step(&action.values, &mut seen)?.reward;
    }
    println!("return {total:.1}, at the end the cosine of the angle is {:.3}", seen[0]);
    // The middle of every image, and of it every second pixel.
    let mut pixels = Vec::new();
    for y in (100..400).step_by(2) {
        for image in &images {
            let row = (100..400)
                .step_by(2)
                .flat_map(|x| [0, 1, 2].map(|channel| image.view().sample_u8(x, y, channel)));
            pixels.extend(row);
        }
    }
    vision::save(&Image::from_rgb8(pixels, 150 * images.len(), 150)?, "swing_up.png")
}
