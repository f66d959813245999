//! The acceptance protocol of online fine-tuning on `QuadTrack-v1`:
//! `cargo run --release -p opendr-control --example quad_track [NAME=VALUE ...]`.
//!
//! Trains the base network by imitation of the tuned conventional law on the nominal plant, then flies every case with the frozen
//! network, the tuned PID and the adapted network. `episodes`, `seeds` and `plants` set the size of the protocol (500, 5 and 1000),
//! `video=FILE.gif` writes a video of one flight instead, `policy=FILE` the base network of seed 0; `plant.NAME` sets an option of the environment for
//! every flight, and every other name is a parameter of the adaptation.

mod base_policy;
mod cases;
mod flight;
mod report;
mod settings;
mod video;

use opendr_engine::Result;

fn main() -> Result<()> {
    let settings = settings::Settings::parse(std::env::args().skip(1))?;
    match (&settings.video, &settings.policy) {
        (Some(path), _) => video::write(path, &settings),
        (None, Some(path)) => base_policy::train(0)?.policy.policy().save(path.as_ref()),
        (None, None) => report::run(&settings),
    }
}
