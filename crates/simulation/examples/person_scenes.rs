//! Renders images of persons into a folder and prints the images per minute:
//! `cargo run --release -p opendr-simulation --example person_scenes -- FOLDER [COUNT]`.

use std::path::PathBuf;
use std::time::Instant;

use opendr_engine::{Error, Result};
use opendr_simulation::person_scenes::{PersonScenes, PersonTarget};

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder: PathBuf = arguments.next().ok_or_else(|| Error::invalid_param("give a folder"))?.into();
    let count = arguments.next().and_then(|count| count.parse().ok()).unwrap_or(24);
    std::fs::create_dir_all(&folder)?;
    let scenes = PersonScenes::new(1, count, [640, 480], PersonTarget::Poses)?;
    let begin = Instant::now();
    for index in 0..count {
        let (scene, poses) = scenes.render(index)?;
        println!("{index:06}: {} persons", poses.len());
        opendr_vision::save(&scene.image, folder.join(format!("{index:06}.png")))?;
    }
    println!("{:.0} images a minute on one core", 60.0 * count as f64 / begin.elapsed().as_secs_f64());
    Ok(())
}
