//! Whisper with real weights, on the recordings of the package moonshine-voice.

use std::path::{Path, PathBuf};
use std::process::Command;

use opendr::data::{Audio, Timeseries};
use opendr::datasets::open_wav;
use opendr::learner::Handle;
use opendr::metrics::{Metric, Transcription, TranscriptionParams};
use opendr::params::{ParamMap, ParamValue, Params};
use opendr::speech_transcription::{Whisper, WhisperParams};
use opendr::target::WhisperTranscription;
use opendr::{Device, ErrorKind};

use crate::models::Models;

const BECKETT: &str = "Ever tried, ever failed. No matter, try again. Fail again. Fail better.";
const TWO_CITIES: &str = "It was the best of times, it was the worst of times, it was the age of wisdom, it was the age of \
    foolishness, it was the epoch of belief, it was the epoch of incredulity, it was the season of Light, it was the \
    season of Darkness, it was the spring of hope, it was the winter of despair, we had everything before us, we had \
    nothing before us, we were all going direct to Heaven, we were all going direct the other way: in short, the period \
    was so far like the present period, that some of its noisiest authorities insisted on its being received, for good \
    or for evil, in the superlative degree of comparison only.";

/// The folder of the recordings; prints a line and returns `None` where pip cannot download them.
fn recordings() -> Option<PathBuf> {
    let root = Path::new(&std::env::var_os("CARGO_MANIFEST_DIR")?).join("../..");
    let cache =
        std::env::var_os("OPENDR_TEST_CACHE").map_or_else(|| root.join("target/test-cache"), PathBuf::from);
    let folder = cache.join("moonshine_voice");
    let assets = folder.join("moonshine_voice/assets");
    if !assets.join("two_cities.wav").exists() {
        let mut pip = Command::new("python3");
        pip.args(["-m", "pip", "install", "--quiet", "--no-deps", "--only-binary=:all:", "--target"]);
        let done = pip.arg(&folder).arg("moonshine-voice==0.1.5").output();
        if !done.is_ok_and(|done| done.status.success()) {
            println!("skipped: pip does not get moonshine-voice");
            return None;
        }
    }
    Some(assets)
}

fn whisper(params: &[(&str, ParamValue)]) -> Option<Handle<Whisper>> {
    let models = Models::find()?;
    let params: ParamMap = params.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    let mut handle = Handle::new(WhisperParams::from_map(&params).unwrap(), Device::Cpu).unwrap();
    handle.load(models.get("whisper")?).unwrap();
    Some(handle)
}

fn errors(reference: &str, said: &str) -> f64 {
    let params = TranscriptionParams { lower_case: true, drop_punctuation: true, join_whitespace: true };
    let mut metric = Transcription::new(&params).unwrap();
    let edits = metric.add(reference, said).unwrap();
    edits.errors() as f64 / reference.split_whitespace().count() as f64
}

#[test]
fn spoken_texts_are_written_down() {
    let (Some(handle), Some(recordings)) = (whisper(&[]), recordings()) else { return };
    for (name, text) in [("beckett.wav", BECKETT), ("two_cities.wav", TWO_CITIES)] {
        let audio = open_wav(recordings.join(name)).unwrap();
        let said = handle.stream().unwrap().infer((&audio).into()).unwrap();
        println!("{said:#}word error {:.3}", errors(text, &said.text));
        assert!(errors(text, &said.text) <= 0.05, "{said}");
        let times: Vec<f32> = said.segments.iter().flat_map(|segment| [segment.start, segment.end]).collect();
        assert!(
            times.is_sorted() && times.last().is_some_and(|end| f64::from(*end) < audio.duration_s() + 1.0)
        );
    }
}

#[test]
fn streams_in_pieces_of_any_size_give_the_same() {
    let partial = ("partial_interval", ParamValue::Float(4.0));
    let (Some(handle), Some(recordings)) = (whisper(&[partial]), recordings()) else { return };
    let audio = open_wav(recordings.join("beckett.wav")).unwrap();
    let samples: Vec<f32> = audio.mono().to_vec();
    let rate = audio.sample_rate();
    let mut answers = Vec::new();
    for size in [1, 777, 5000] {
        let (mut stream, mut predictions) = (handle.stream().unwrap(), Vec::new());
        for piece in samples.chunks(size) {
            let piece = Audio::new(piece.to_vec(), 1, rate).unwrap();
            stream.push((&piece).into(), &mut |said| predictions.push(said)).unwrap();
        }
        stream.flush(&mut |said| predictions.push(said)).unwrap();
        answers.push(predictions);
    }
    assert!(answers.iter().all(|predictions| *predictions == answers[0]));
    let (words, parts): (Vec<_>, Vec<_>) = answers[0].iter().partition(|said| said.segments.is_empty());
    assert!(!words.is_empty() && !parts.is_empty());
    let text: String = parts.iter().map(|said| said.text.as_str()).collect();
    println!("{text}");
    assert!(errors(BECKETT, &text) <= 0.10, "{text}");
}

#[test]
fn an_hour_of_silence_costs_nothing() {
    let Some(handle) = whisper(&[]) else { return };
    let (mut stream, mut count) = (handle.stream().unwrap(), 0);
    let minute = Audio::new(vec![0.0005; 48_000 * 60], 1, 48_000).unwrap();
    for _ in 0..60 {
        stream.push((&minute).into(), &mut |_| count += 1).unwrap();
    }
    stream.flush(&mut |_| count += 1).unwrap();
    assert_eq!(count, 0);
}

#[test]
fn wrong_sound_has_a_defined_answer() {
    let Some(handle) = whisper(&[]) else { return };
    let infer = |audio: &Audio| handle.stream().unwrap().infer(audio.into());
    // Less than a frame, and bytes.
    let click = Audio::new(vec![0.5; 100], 1, 16_000).unwrap();
    assert_eq!(infer(&click).unwrap(), WhisperTranscription::default());
    let bytes: Vec<u8> = (0..8000).map(|at| if at % 40 < 20 { 130 } else { 126 }).collect();
    let hum = Audio::from_pcm8(&bytes, 1, 8000).unwrap();
    assert_eq!(infer(&hum).unwrap(), infer(&hum).unwrap());
    let broken = Audio::new(vec![f32::NAN; 16_000], 1, 16_000).unwrap();
    assert_eq!(infer(&broken).unwrap_err().kind(), ErrorKind::InvalidInput);
    let slow = Audio::new(vec![0.0; 100], 1, 10).unwrap();
    assert_eq!(infer(&slow).unwrap_err().kind(), ErrorKind::InvalidInput);
    let wide = Timeseries::new(vec![0.0; 64], [8, 8]).unwrap();
    assert!(handle.stream().unwrap().infer((&wide).into()).is_err());
}

#[test]
fn parameters_that_do_not_fit_are_refused() {
    let second = Audio::new(vec![0.0; 16_000], 1, 16_000).unwrap();
    for (name, value) in [("language", "de"), ("suppress_tokens", "1,x"), ("suppress_tokens", "99999999")] {
        let Some(handle) = whisper(&[(name, value.into())]) else { return };
        let error = handle.stream().unwrap().infer((&second).into()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::InvalidParam, "{name} = {value}: {error}");
    }
}
