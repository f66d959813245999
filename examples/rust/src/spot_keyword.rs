//! Recognises a spoken word and draws its waveform. Input: word.wav, a word of Speech Commands, such as "right".

use opendr::data::Image;
use opendr::learner::Handle;
use opendr::speech_recognition::{AudioInput, MatchboxNet};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, datasets, vision};

pub fn main() -> opendr::Result<()> {
    let mut recogniser = Handle::<MatchboxNet>::new(Default::default(), Device::Auto)?;
    recogniser.load(opendr::download("matchboxnet")?)?;
    let audio = datasets::open_wav("word.wav")?;
    let word = recogniser.infer(AudioInput::Audio(&audio))?;
    let name = word.description.as_deref().unwrap_or_default();
    println!("{name} {:.2}", word.confidence.unwrap_or_default());

    let mut pixels = vec![255; 200 * 500 * 3];
    let step = audio.as_slice().len() / 500;
    for (column, part) in audio.as_slice().chunks_exact(step).take(500).enumerate() {
        let high = part.iter().copied().fold(f32::MIN, f32::max);
        let low = part.iter().copied().fold(f32::MAX, f32::min);
        for row in 100 - (high * 99.0) as i32..=100 - (low * 99.0) as i32 {
            let at = (row as usize * 500 + column) * 3;
            pixels[at..at + 3].copy_from_slice(&[20, 90, 180]);
        }
    }
    let mut picture = Image::from_rgb8(pixels, 500, 200)?;
    draw(&mut picture, &word, &Style::default());
    vision::save(&picture, "spot_keyword.png")
}
