//! Writes the cepstra of a WAVE file as `[frames, coefficients]` into a `.npy` file, for comparison by the Python tests.
//!
//! ```console
//! $ cargo run -p opendr-audio --example mfcc -- keywords yes.wav cepstra.npy
//! $ cargo run -p opendr-audio --example mfcc -- librosa 640 480 64 yes.wav cepstra.npy
//! ```

use opendr_audio::mfcc::{Mfcc, MfccOptions, peak_factor};
use opendr_datasets::{npy_from_values, open_wav};
use opendr_engine::{Error, Result};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = arguments.iter().map(String::as_str).collect();
    let number = |text: &str| {
        text.parse::<usize>()
            .map_err(|_| Error::invalid_param(format!("{text:?} is not a number of samples")))
    };
    let (recipe, from, to) = match words[..] {
        ["keywords", from, to] => (None, from, to),
        ["librosa", window, hop, count, from, to] => {
            (Some([number(window)?, number(hop)?, number(count)?]), from, to)
        }
        _ => {
            return Err(Error::invalid_param(
                "usage: mfcc keywords IN OUT, or mfcc librosa WINDOW HOP COUNT IN OUT",
            ));
        }
    };
    let audio = open_wav(from)?;
    let samples = audio.mono();
    let (options, factor) = match recipe {
        None => (MfccOptions::keywords(), peak_factor(&samples)),
        Some([window, hop, count]) => (MfccOptions::librosa(audio.sample_rate(), window, hop, count), 1.0),
    };
    let mfcc = Mfcc::new(options)?;
    let mut cepstra = Vec::new();
    let frames = mfcc.run_scaled_into(&samples, factor, &mut cepstra);
    Ok(std::fs::write(to, npy_from_values(&cepstra, &[frames, mfcc.options().coefficients])?)?)
}
