//! Renders frames of a drive: `cargo run --release -p opendr-simulation --example drive_frames -- FOLDER [SEED] [EVERY]`.

use opendr_engine::Result;
use opendr_simulation::drive::{Course, Drive, DriveOptions};
use opendr_vision::save;

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder = arguments.next().unwrap_or_else(|| "drive_frames".to_owned());
    let mut number = |default| arguments.next().and_then(|text| text.parse().ok()).unwrap_or(default);
    let (seed, every) = (number(0), number(50));
    std::fs::create_dir_all(&folder)?;
    for (name, course) in [("straight", Course::Straight), ("curves", Course::Curves), ("loop", Course::Loop)]
    {
        let drive = Drive::new(&DriveOptions { seed: seed as u64, course, ..DriveOptions::default() })?;
        println!("{name}: {} frames", drive.frames());
        for frame in (0..drive.frames()).step_by(every.max(1)) {
            save(&drive.render(frame)?.left, format!("{folder}/{name}_{frame:04}.jpg"))?;
        }
    }
    Ok(())
}
