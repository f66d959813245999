//! `transcribe FOLDER SOUND.wav...`: transcribes recordings with Whisper and prints the time taken. `FOLDER` contains
//! CTranslate2's `model.bin` with `tokenizer.json`, or the container converted from them. With `--pieces`, the audio is passed
//! in pieces of 100 ms.

use std::path::Path;
use std::process::ExitCode;
use std::time::Instant;

use opendr_datasets::open_wav;
use opendr_engine::data::Audio;
use opendr_engine::learner::Handle;
use opendr_engine::model::{Manifest, Model, ModelWriter};
use opendr_engine::target::WhisperTranscription;
use opendr_engine::{Device, Result};
use opendr_speech::speech_transcription::{Whisper, WhisperParams};

fn main() -> ExitCode {
    let mut arguments: Vec<String> = std::env::args().skip(1).collect();
    let pieces = arguments.iter().position(|argument| argument == "--pieces");
    if let Some(place) = pieces {
        arguments.remove(place);
    }
    let Some((folder, sounds)) = arguments.split_first() else {
        eprintln!("usage: transcribe [--pieces] FOLDER SOUND.wav...");
        return ExitCode::from(2);
    };
    match run(Path::new(folder), sounds, pieces.is_some()) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("{error:?}");
            ExitCode::FAILURE
        }
    }
}

fn run(folder: &Path, sounds: &[String], pieces: bool) -> Result<()> {
    let start = Instant::now();
    let container = if folder.join("model.json").exists() { folder.to_owned() } else { imported(folder)? };
    println!("container in {:.2} s", start.elapsed().as_secs_f64());
    let start = Instant::now();
    let mut handle = Handle::<Whisper>::new(WhisperParams::default(), Device::Cpu)?;
    handle.load(&container)?;
    println!("loaded in {:.2} s", start.elapsed().as_secs_f64());
    for sound in sounds {
        let audio = open_wav(sound)?;
        let start = Instant::now();
        let mut transcription = WhisperTranscription::default();
        match pieces {
            true => streamed(&mut handle, &audio)?,
            false => handle.infer_into((&audio).into(), &mut transcription)?,
        }
        let (took, length) = (start.elapsed().as_secs_f64(), audio.duration_s());
        print!("{transcription:#}");
        println!("{sound}: {length:.2} s in {took:.2} s, real-time factor {:.3}", took / length);
    }
    println!("{}", peak_memory());
    Ok(())
}

fn streamed(handle: &mut Handle<Whisper>, audio: &Audio) -> Result<()> {
    let samples = audio.mono();
    let mut stream = handle.stream()?;
    let mut show = |transcription: WhisperTranscription| match transcription.segments.is_empty() {
        true => println!("...{}", transcription.text),
        false => print!("{transcription:#}"),
    };
    for piece in samples.chunks(audio.sample_rate() as usize / 10) {
        let piece = Audio::new(piece.to_vec(), 1, audio.sample_rate())?;
        stream.push((&piece).into(), &mut show)?;
    }
    stream.flush(&mut show)
}

fn imported(folder: &Path) -> Result<std::path::PathBuf> {
    let networks = opendr_import::whisper_from_ctranslate2(&std::fs::read(folder.join("model.bin"))?)?;
    let container = folder.join("container");
    let mut writer = ModelWriter::new(&container, Manifest::new("whisper", "imported"))?;
    writer.add("encoder.onnx", &networks.encoder)?;
    writer.add("decoder.onnx", &networks.decoder)?;
    writer.add("tokenizer.json", &std::fs::read(folder.join("tokenizer.json"))?)?;
    let _: Model = writer.finish()?;
    Ok(container)
}

/// Returns the line of the kernel's report; empty where there is none.
fn peak_memory() -> String {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    status.lines().find(|line| line.starts_with("VmHWM")).unwrap_or_default().to_owned()
}
