//! Moves a camera around an object of a simulated world, in a strip of its views. Needs no input.

use opendr::data::Image;
use opendr::environment::ResetOptions;
use opendr::{simulation, vision};

pub fn main() -> opendr::Result<()> {
    let mut env = simulation::make("SphereView-Object-v1")?;
    let mut seen = vec![0.0; env.spec().observation.len()];
    env.reset(Some(3), &ResetOptions::new(), &mut seen)?;
    let mut views: Vec<_> = env.render()?.into_iter().collect();
    let mut action = vec![0.0; env.spec().action.len()];
    action[..3].copy_from_slice(&[1.0, 0.2, 0.0]); // around the object and upwards, at the same distance
    for _ in 0..6 {
        env.step(&action, &mut seen)?;
        views.extend(env.render()?);
        // The parts of an observation are in the order of their names: image, pose.
        if let [.., azimuth, elevation, distance, _] = seen[..] {
            println!("azimuth {azimuth:.2}, elevation {elevation:.2}, distance {distance:.2}");
        }
    }
    // Each pixel four times as large.
    let mut pixels = Vec::new();
    for y in 0..4 * 48 {
        for view in &views {
            let row = (0..4 * 48)
                .flat_map(|x| [0, 1, 2].map(|channel| view.view().sample_u8(x / 4, y / 4, channel)));
            pixels.extend(row);
        }
    }
    vision::save(&Image::from_rgb8(pixels, 4 * 48 * views.len(), 4 * 48)?, "orbit_object.png")
}
