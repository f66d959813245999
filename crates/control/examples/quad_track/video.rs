//! A video of the adapted flight beside the frozen one.

use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::environment::{Controller, Environment as _};
use opendr_engine::{Error, Result};
use opendr_simulation::quad_track::{QuadTrack, QuadTrackParams};
use opendr_simulation::{Recording, RegisteredEnvironment as _};

use crate::base_policy::train;
use crate::cases::{CASES, options};
use crate::settings::Settings;

/// Seconds of the video; the plant changes at 4 s.
const SECONDS: usize = 12;
/// Steps from frame to frame.
const EVERY: usize = 20;

/// Writes `case` (mass +30 % by default), frozen to the left and adapted to the right.
pub fn write(path: &str, settings: &Settings) -> Result<()> {
    let base = train(0)?;
    let (_, pairs) = CASES.get(settings.case.unwrap_or(1)).copied().unwrap_or(CASES[1]);
    let pairs = [pairs, &[("change_at", 4.0)]].concat();
    let mut controllers: [Box<dyn Controller>; 2] =
        [Box::new(base.policy.clone()), Box::new(base.adapter(settings)?)];
    let mut flights = Vec::new();
    for _ in 0..2 {
        let mut track = QuadTrack::new(&QuadTrackParams::default())?;
        let mut seen = [0.0; 17];
        track.reset(Some(3), &options(&pairs), &mut seen)?;
        flights.push((track, seen));
    }
    let mut video = Recording::create(path, 5.0)?;
    let mut action = [0.0; 3];
    for step in 0..100 * SECONDS {
        for ((track, seen), controller) in flights.iter_mut().zip(&mut controllers) {
            controller.act(&seen[..], &mut action)?;
            track.step(&action, seen)?;
        }
        if step % EVERY == 0 {
            let images = flights.iter_mut().map(|(track, _)| track.render()).collect::<Result<Vec<_>>>()?;
            let images: Option<Vec<_>> = images.into_iter().collect();
            video.write(&beside(&images.ok_or_else(|| Error::internal("QuadTrack-v1 does not render"))?)?)?;
        }
    }
    video.finish()
}

/// Images of one size beside each other.
fn beside(images: &[Image]) -> Result<Image> {
    let (width, height) = (images[0].width(), images[0].height());
    let bytes: Vec<_> = images.iter().map(|image| image.hwc_u8(PixelFormat::Rgb)).collect();
    let rows = (0..height)
        .flat_map(|row| bytes.iter().flat_map(move |own| &own[3 * width * row..3 * width * (row + 1)]));
    Image::from_rgb8(rows.copied().collect(), width * images.len(), height)
}
