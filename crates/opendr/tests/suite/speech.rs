//! Learners of audio streams, with the models of the zoo.

use std::path::{Path, PathBuf};

use opendr::data::Audio;
use opendr::dataset::{DatasetIterator, ExternalDataset};
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::inference::{Builtin, OnnxRuntime, Session, TensorView};
use opendr::learner::{AnyLearner, AnyStream, Outputs, Ports};
use opendr::model::Model;
use opendr::params::{ParamMap, ParamValue};
use opendr::{Device, Task, Value, ValueRef};

use crate::models::Models;

fn clips(models: &Models) -> Box<dyn DatasetIterator> {
    let clips = ExternalDataset::new(models.data("speech_commands_v0.02_test"), "speech_commands");
    open(&clips, &OpenOptions::default(), &Problems::strict()).unwrap()
}

/// The samples of one clip of each of `words`, one after the other.
fn words(models: &Models, words: &[&str]) -> Vec<f32> {
    let clips = clips(models);
    let classes = clips.classes();
    let mut sound = Vec::new();
    for word in words {
        let says = |index: &usize| match clips.target(*index).unwrap() {
            Some(Value::Category(category)) => classes.name(category.class).map(AsRef::as_ref) == Some(*word),
            _ => false,
        };
        let index = (0..clips.len()).find(says).unwrap();
        let Some(Value::Audio(audio)) = clips.get(index).unwrap().data.into_iter().next() else { panic!() };
        sound.extend_from_slice(audio.as_slice());
    }
    sound
}

fn learner(name: &str, model: &Path, params: ParamMap) -> Box<dyn AnyLearner> {
    let mut learner = opendr::registry().find(name).unwrap().make(&params, Device::Cpu).unwrap();
    learner.load(model).unwrap();
    learner
}

fn push(
    stream: &mut dyn AnyStream,
    samples: &[f32],
    rate: u32,
    answers: &mut Vec<Outputs>,
) -> opendr::Result<()> {
    let piece = Audio::new(samples.to_vec(), 1, rate)?;
    let ports = Ports::default().with("audio", ValueRef::Audio(&piece));
    stream.push(Some(&ports), &mut |answer| answers.push(answer))
}

fn streamed(stream: &mut dyn AnyStream, sound: &[f32], size: usize) -> Vec<Outputs> {
    let mut answers = Vec::new();
    for piece in sound.chunks(size) {
        push(stream, piece, 16_000, &mut answers).unwrap();
    }
    stream.push(None, &mut |answer| answers.push(answer)).unwrap();
    answers
}

fn category(outputs: &Outputs) -> &opendr::target::Category {
    match outputs.first() {
        Some(Value::Category(category)) => category,
        other => panic!("{other:?}"),
    }
}

/// Every streaming audio learner, with its model.
fn listeners(models: &Models) -> Vec<(&'static str, PathBuf)> {
    let entries = opendr::registry().entries().into_iter();
    let entries = entries
        .filter(|entry| matches!(entry.spec.task, Task::SpeechRecognition | Task::VoiceActivityDetection));
    entries.filter_map(|entry| Some((entry.spec.name, models.get(entry.spec.name)?))).collect()
}

#[test]
fn pieces_give_the_answers_of_the_whole() {
    let Some(models) = Models::find() else { return };
    let mut sound = words(&models, &["yes", "stop"]);
    sound.extend([0.0; 16_000]);
    sound.extend(words(&models, &["go"]));
    for (name, model) in listeners(&models) {
        let learner = learner(name, &model, ParamMap::new());
        let whole = streamed(&mut *learner.stream().unwrap(), &sound, sound.len());
        assert!(whole.len() > 5, "{name}");
        let (mut one, mut other) = (learner.stream().unwrap(), learner.stream().unwrap());
        for size in [1, 160, 5000] {
            assert_eq!(
                streamed(&mut *one, &sound[..20_000], size),
                streamed(&mut *one, &sound[..20_000], 20_000)
            );
            if size > 1 {
                assert_eq!(streamed(&mut *one, &sound, size), whole, "{name}: pieces of {size}");
            }
        }
        // Two interleaved streams, with refused chunks between accepted ones.
        let (mut first, mut second) = (Vec::new(), Vec::new());
        for piece in sound.chunks(3000) {
            push(&mut *one, piece, 16_000, &mut first).unwrap();
            assert!(push(&mut *one, piece, 44_100, &mut first).is_err());
            assert!(push(&mut *one, &[f32::NAN], 16_000, &mut first).is_err());
            push(&mut *other, &vec![0.1; piece.len()], 16_000, &mut second).unwrap();
        }
        one.push(None, &mut |answer| first.push(answer)).unwrap();
        assert_eq!(first, whole, "{name}: two streams mix");
        one.reset();
        assert_eq!(streamed(&mut *one, &sound, 8000), whole, "{name}: after reset");
    }
}

#[test]
fn speech_is_told_from_silence_and_noise() {
    let Some(models) = Models::find() else { return };
    let Some(model) = models.get("silero_vad") else { return };
    let mut learner = learner("silero_vad", &model, ParamMap::new());
    let mut speaks = |sound: Vec<f32>| {
        let audio = Audio::new(sound, 1, 16_000).unwrap();
        let answer = learner.infer(&Ports::default().with("audio", ValueRef::Audio(&audio))).unwrap();
        let category = category(&answer).clone();
        (category.description.unwrap().to_string(), category.probabilities[1])
    };
    for word in ["yes", "stop", "left"] {
        let (class, probability) = speaks(words(&models, &[word]));
        assert!(class == "speech" && probability > 0.8, "{word}: {probability}");
    }
    let noise = |at: u32| 0.1 * ((at.wrapping_mul(2_654_435_761) >> 8) as f32 / (1 << 24) as f32 - 0.5);
    let noise = (0..16_000).map(noise).collect();
    for quiet in [vec![0.0; 16_000], noise, vec![0.0; 1]] {
        let (class, probability) = speaks(quiet);
        assert!(class == "silence" && probability < 0.3, "{probability}");
    }
}

#[test]
fn where_nobody_speaks_no_word_is_told() {
    let Some(models) = Models::find() else { return };
    let Some(voice) = models.get("silero_vad") else { return };
    let Some(model) = models.get("ds_cnn") else { return };
    let mut sound = vec![0.0; 5 * 16_000];
    sound.extend(words(&models, &["stop"]));
    sound.extend([0.0; 5 * 16_000]);
    let params = ParamMap::from([(
        "voice_activity".to_owned(),
        ParamValue::Text(voice.to_string_lossy().into_owned()),
    )]);
    let learner = learner("ds_cnn", &model, params);
    let answers = streamed(&mut *learner.stream().unwrap(), &sound, 1600);
    assert!((1..=4).contains(&answers.len()), "{}", answers.len());
    let predictions = answers.iter().filter_map(|answer| category(answer).description.as_deref());
    assert!(predictions.clone().any(|word| word == "stop"), "{:?}", predictions.collect::<Vec<_>>());
    for size in [111, 5000] {
        assert_eq!(streamed(&mut *learner.stream().unwrap(), &sound, size), answers);
    }
}

#[test]
fn both_runtimes_hear_the_same() {
    let Some(models) = Models::find() else { return };
    let Some(model) = models.get("silero_vad") else { return };
    let Ok(library) = OnnxRuntime::find() else {
        println!("skipped: no ONNX Runtime");
        return;
    };
    let model = Model::open(&model).unwrap().file("model.onnx").unwrap();
    let sound = words(&models, &["yes", "left"]);
    let mut probabilities = Vec::new();
    for session in [
        Session::open_with(&Builtin, &model, Device::Cpu).unwrap(),
        Session::open_with(&*library, &model, Device::Cpu).unwrap(),
    ] {
        let (mut state, mut predictions) = (vec![0.0f32; 256], Vec::new());
        for window in sound.windows(576).step_by(512) {
            let inputs =
                [TensorView::new(&[1, 576], window).unwrap(), TensorView::new(&[2, 1, 128], &state).unwrap()];
            let mut next = Vec::new();
            let ran = session.run(&inputs, |outputs| {
                predictions.push(outputs[0].values::<f32>()?[0]);
                next.extend_from_slice(outputs[1].values::<f32>()?);
                Ok(())
            });
            ran.unwrap();
            state = next;
        }
        probabilities.push(predictions);
    }
    let apart = probabilities[0].iter().zip(&probabilities[1]).map(|(one, other)| (one - other).abs());
    let apart = apart.fold(0.0, f32::max);
    assert!(apart < 1e-4, "{apart}");
    assert!(probabilities[0].iter().any(|probability| *probability > 0.9));
}
