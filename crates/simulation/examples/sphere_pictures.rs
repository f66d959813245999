//! A sheet of generated subjects from all sides, as a PNG: `cargo run --release -p opendr-simulation --example sphere_pictures -- face OUT.png`.
//!
//! A row for each of eight classes; from left to right the camera goes round from the front in steps of 45 degrees.

use std::time::Instant;

use opendr_engine::rig::ViewRig as _;
use opendr_engine::target::Action;
use opendr_engine::{Error, Random, Result};
use opendr_simulation::sphere_view::{Asset, Conditions, SphereWorld, Subject};

const SIDE: usize = 96;
const COLUMNS: usize = 8;
const ROWS: usize = 8;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, path] = &arguments[..] else {
        return Err(Error::invalid_param("give face, object or pose, and the path of a PNG"));
    };
    let unknown = || Error::invalid_param(format!("no subject {name:?}; give face, object or pose"));
    let subject = Subject::ALL.into_iter().find(|subject| subject.name() == name).ok_or_else(unknown)?;
    let mut sheet = vec![0; 3 * SIDE * SIDE * COLUMNS * ROWS];
    let mut world = SphereWorld::new(SIDE)?;
    let mut pixels = vec![0; 3 * SIDE * SIDE];
    let begun = Instant::now();
    for row in 0..ROWS {
        let mut random = Random::from_key([7, row as u64]);
        let asset = Asset::generate(subject, row as u32, 0)?;
        let conditions =
            Conditions { azimuth: 0.0, elevation: 0.1, distance: 3.0, ..Conditions::draw(&mut random) };
        world.begin(&asset, &conditions, 1)?;
        for column in 0..COLUMNS {
            world.capture_into(&mut pixels);
            for line in 0..SIDE {
                let to = 3 * ((row * SIDE + line) * COLUMNS * SIDE + column * SIDE);
                sheet[to..to + 3 * SIDE].copy_from_slice(&pixels[3 * line * SIDE..3 * (line + 1) * SIDE]);
            }
            (0..2).try_for_each(|_| world.apply(&Action::new(&[22.5 / 35.0, 0.0, 0.0])?).map(drop))?;
        }
    }
    println!("{} pictures in {:.3} s", COLUMNS * ROWS, begun.elapsed().as_secs_f64());
    // The speed of pictures as environments take them.
    let mut world = SphereWorld::new(opendr_simulation::sphere_view::SIDE)?;
    let asset = Asset::generate(subject, 0, 0)?;
    world.begin(&asset, &Conditions::draw(&mut Random::new(1)), 1)?;
    pixels.truncate(3 * world.side() * world.side());
    let begun = Instant::now();
    for _ in 0..500 {
        world.apply(&Action::new(&[0.3, 0.0, 0.0])?)?;
        world.capture_into(&mut pixels);
    }
    println!("{:.0} pictures of 48 x 48 a second", 500.0 / begun.elapsed().as_secs_f64());
    let begun = Instant::now();
    (0..20).try_for_each(|number| Asset::generate(subject, number % 10, 1).map(drop))?;
    println!(
        "{:.1} ms to generate a subject, {} triangles",
        50.0 * begun.elapsed().as_secs_f64(),
        asset.triangles()
    );
    let image = opendr_engine::data::Image::from_rgb8(sheet, COLUMNS * SIDE, ROWS * SIDE)?;
    opendr_vision::save(&image, path)
}
