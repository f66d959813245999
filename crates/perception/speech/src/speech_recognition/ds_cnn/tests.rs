use opendr_datasets::{OpenOptions, Problems, open};
use opendr_engine::ErrorKind;
use opendr_engine::Value;
use opendr_engine::data::{Audio, Timeseries};
use opendr_engine::dataset::{DatasetIterator as _, ExternalDataset};
use opendr_engine::learner::{Handle, Stream};
use opendr_import::{ImportOptions, onnx_from_tflite};
use opendr_perception_testing::test_models::{container_of, test_data};

use super::*;

fn learner() -> Option<Handle<DsCnn>> {
    let network = std::fs::read(test_data("models/speech_commands/kws_ref_model.tflite")?).unwrap();
    let network = onnx_from_tflite(&network, &ImportOptions::default()).unwrap();
    let classes = include_str!("../../../../../../models/classes/ds_cnn12.txt");
    let folder = container_of("ds_cnn", &network, classes);
    let mut handle = Handle::new(DsCnnParams::default(), Device::Cpu).unwrap();
    handle.load(&folder).unwrap();
    Some(handle)
}

/// Six seconds of words in sequence, with a silent second.
fn words() -> Option<Vec<f32>> {
    let clips = test_data("data/speech_commands_v0.02_test")?;
    let clips =
        open(&ExternalDataset::new(clips, "speech_commands"), &OpenOptions::default(), &Problems::strict());
    let clips = clips.unwrap();
    let mut sound = Vec::new();
    for index in [60, 200, 350, 450, 600] {
        let Some(Value::Audio(audio)) = clips.get(index).unwrap().data.into_iter().next() else { panic!() };
        sound.extend_from_slice(audio.as_slice());
    }
    sound.extend([0.0; 16_000]);
    Some(sound)
}

fn streamed(stream: &mut Stream<DsCnn>, sound: &[f32], size: usize) -> Vec<Category> {
    let mut predictions = Vec::new();
    for piece in sound.chunks(size) {
        let piece = Audio::new(piece.to_vec(), 1, 16_000).unwrap();
        stream.push((&piece).into(), &mut |prediction| predictions.push(prediction)).unwrap();
    }
    stream.flush(&mut |prediction| predictions.push(prediction)).unwrap();
    predictions
}

#[test]
fn classifies_the_shared_clips() {
    let (Some(handle), Some(clips)) = (learner(), test_data("data/speech_commands_v0.02_test")) else {
        return;
    };
    let clips =
        open(&ExternalDataset::new(clips, "speech_commands"), &OpenOptions::default(), &Problems::strict());
    let clips = clips.unwrap();
    let classes = clips.classes();
    let names = handle.classes();
    let mut correct = 0;
    for index in 0..clips.len() {
        let sample = clips.get(index).unwrap();
        let (Some(Value::Audio(audio)), Some(Value::Category(word))) = (sample.data.first(), &sample.target)
        else {
            panic!()
        };
        let prediction = handle.stream().unwrap().infer(audio.into()).unwrap();
        correct += usize::from(names.name(prediction.class) == classes.name(word.class));
    }
    let accuracy = correct as f64 / clips.len() as f64;
    println!("{correct} of {} clips correct, accuracy {accuracy:.4}", clips.len());
    assert!(accuracy >= 0.88, "{accuracy}");
}

#[test]
fn pieces_of_any_size_yield_the_predictions_of_the_whole() {
    let (Some(handle), Some(sound)) = (learner(), words()) else { return };
    let whole = streamed(&mut handle.stream().unwrap(), &sound, sound.len());
    assert_eq!(whole.len(), 2 * sound.len() / 16_000 - 1);
    // Two streams of one learner in turn, and one stream again after its end.
    let (mut one, mut other) = (handle.stream().unwrap(), handle.stream().unwrap());
    for size in [7, 160, 1111, 5000] {
        assert_eq!(streamed(&mut one, &sound, size), whole, "pieces of {size}");
        assert_eq!(streamed(&mut other, &sound[1..], size), streamed(&mut one, &sound[1..], 16_000));
    }
    assert_eq!(streamed(&mut one, &sound[..4000], 1).len(), 1);
}

#[test]
fn refused_input_leaves_a_stream_unchanged() {
    let (Some(handle), Some(sound)) = (learner(), words()) else { return };
    let whole = streamed(&mut handle.stream().unwrap(), &sound, 9000);
    let (mut stream, mut predictions) = (handle.stream().unwrap(), Vec::new());
    for piece in sound.chunks(9000) {
        let piece = Audio::new(piece.to_vec(), 1, 16_000).unwrap();
        let other = Audio::new(vec![0.5; 800], 1, 8000).unwrap();
        let broken = Timeseries::new(vec![0.1, f32::NAN], [2, 1]).unwrap();
        for wrong in [AudioInput::from(&other), AudioInput::from(&broken)] {
            let refused = stream.push(wrong, &mut |_| panic!()).unwrap_err();
            assert_eq!(refused.kind(), ErrorKind::InvalidInput);
        }
        stream.push((&piece).into(), &mut |prediction| predictions.push(prediction)).unwrap();
    }
    stream.flush(&mut |prediction| predictions.push(prediction)).unwrap();
    assert_eq!(predictions, whole);
}
