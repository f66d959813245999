//! Detects speech in a stream and draws it. Input: speech.wav, 16 kHz, mono, 16 bits.

use opendr::data::{Audio, Image};
use opendr::learner::Handle;
use opendr::speech_recognition::AudioInput;
use opendr::voice_activity_detection::{SileroVad, SileroVadParams};
use opendr::{Device, datasets, vision};

pub fn main() -> opendr::Result<()> {
    let audio = datasets::open_wav("speech.wav")?;
    let mut detector = Handle::<SileroVad>::new(SileroVadParams::default(), Device::Auto)?;
    detector.load(opendr::download("silero_vad")?)?;
    // Pieces of 0.1 s, as a microphone has them; the learner returns a prediction for every 32 ms.
    let (mut voices, mut stream) = (Vec::new(), detector.stream()?);
    for piece in audio.as_slice().chunks(1600) {
        let piece = Audio::new(piece.to_vec(), 1, 16_000)?;
        stream.push(AudioInput::Audio(&piece), &mut |voice| voices.push(voice.class))?;
    }
    let (classes, width) = (detector.classes(), 3 * voices.len());
    let mut pixels = vec![255; 100 * width * 3];
    for (index, voice) in voices.iter().enumerate() {
        let name = classes.name(*voice).map_or("", |name| name);
        if index == 0 || voices[index - 1] != *voice {
            println!("{name} from {:.2} s", index as f64 * 0.032);
        }
        // Loudness as the height of a bar, red during speech.
        let loudness =
            audio.as_slice()[512 * index..][..512].iter().fold(0f32, |loudest, one| loudest.max(one.abs()));
        let colour = if name == "speech" { [200, 40, 40] } else { [160; 3] };
        for row in 100 - (loudness * 99.0) as usize..100 {
            let at = (row * width + 3 * index) * 3;
            pixels[at..at + 9].copy_from_slice(&[colour; 3].concat());
        }
    }
    vision::save(&Image::from_rgb8(pixels, width, 100)?, "detect_voice.png")
}
