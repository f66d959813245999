//! A film of the adapted flight beside the frozen one.

use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::environment::{Controller, Environment as _};
use opendr_engine::{Error, Result};
use opendr_simulation::quad_track::{QuadTrack, QuadTrackParams};
use opendr_simulation::{Recording, RegisteredEnvironment as _};

use crate::base::{Frozen, train};
use crate::cases::{CASES, options};
use crate::settings::Settings;

/// Seconds of the film; the plant changes at 4 s.
const SECONDS: usize = 16;
/// Steps from picture to picture.
const EVERY: usize = 10;

/// Writes `case` (mass +30 % by default), frozen to the left and adapted to the right.
pub fn write(path: &str, settings: &Settings) -> Result<()> {
    let base = train(0, settings)?;
    let (_, pairs) = CASES.get(settings.case.unwrap_or(1)).copied().unwrap_or(CASES[1]);
    let pairs = [pairs, &[("change_at", 4.0)]].concat();
    let mut controllers: [Box<dyn Controller>; 2] =
        [Box::new(Frozen(base.policy.clone())), Box::new(base.adapter(settings)?)];
    let mut flights = Vec::new();
    for _ in 0..2 {
        let mut track = QuadTrack::new(&QuadTrackParams::default())?;
        let mut seen = [0.0; 17];
        track.reset(Some(3), &options(&pairs), &mut seen)?;
        flights.push((track, seen));
    }
    let mut film = Recording::create(path, 10.0)?;
    let mut action = [0.0; 3];
    for step in 0..100 * SECONDS {
        for ((track, seen), controller) in flights.iter_mut().zip(&mut controllers) {
            controller.act(&seen[..], &mut action)?;
            track.step(&action, seen)?;
        }
        if step % EVERY == 0 {
            let images = flights.iter_mut().map(|(track, _)| track.render()).collect::<Result<Vec<_>>>()?;
            let images: Option<Vec<_>> = images.into_iter().collect();
            film.write(&beside(&images.ok_or_else(|| Error::internal("a picture was lost"))?)?)?;
        }
    }
    film.finish()
}

/// Images of one size beside each other.
fn beside(images: &[Image]) -> Result<Image> {
    let (width, height) = (images[0].width(), images[0].height());
    let bytes: Vec<_> = images.iter().map(|image| image.hwc_u8(PixelFormat::Rgb)).collect();
    let rows = (0..height)
        .flat_map(|row| bytes.iter().flat_map(move |own| &own[3 * width * row..3 * width * (row + 1)]));
    Image::from_rgb8(rows.copied().collect(), width * images.len(), height)
}
