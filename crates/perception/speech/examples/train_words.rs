//! Trains a keyword spotting learner on Speech Commands and measures its accuracy on a held-out fifth of the speakers.
//!
//! The clips are those of the test set of version 0.02: ten words, silence and other words. The example produces the zoo's
//! `matchboxnet/commands_12`, `edge_speech_nets/commands_12` and `quadratic_self_onn/commands_12`:
//!
//! ```console
//! $ cargo run --release -p opendr-speech --features training --example train_words -- matchboxnet speech_commands_v0.02_test out
//! ```

use std::path::Path;

use opendr_datasets::{OpenOptions, Problems, open, speaker_of_clip};
use opendr_engine::dataset::{DatasetIterator, ExternalDataset, Subset};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{Device, Error, Result, Value};
use opendr_speech::speech_recognition::{
    AudioInput, EdgeSpeechNet, EdgeSpeechNetsFitParams, EdgeSpeechNetsKind, EdgeSpeechNetsParams,
    MatchboxNetFitParams, MatchboxNetKind, MatchboxNetParams, QuadraticSelfOnnFitParams,
    QuadraticSelfOnnKind, QuadraticSelfOnnParams, TrainableWords, WordFitParams, WordLearner,
};
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (learner, clips, output, epochs) = match &arguments[..] {
        [learner, clips, output] => (learner, clips, output, 60),
        [learner, clips, output, epochs] => {
            let wrong = || Error::invalid_param(format!("{epochs:?} is not a number of epochs"));
            (learner, clips, output, epochs.parse().map_err(|_| wrong())?)
        }
        _ => {
            return Err(Error::invalid_param(
                "usage: train_words LEARNER CLIP_FOLDER OUTPUT_FOLDER [EPOCHS=60]",
            ));
        }
    };
    let words = |dropout| WordFitParams { dropout, augment: true };
    match learner.as_str() {
        "matchboxnet" => {
            let fit_params = MatchboxNetFitParams { training: training(epochs, 0.003), words: words(0.1) };
            train::<MatchboxNetKind>(MatchboxNetParams::default(), &fit_params, clips, output)
        }
        "edge_speech_nets" => {
            let params = EdgeSpeechNetsParams { architecture: EdgeSpeechNet::D, ..Default::default() };
            let fit_params = EdgeSpeechNetsFitParams { training: training(epochs, 0.003), words: words(0.1) };
            train::<EdgeSpeechNetsKind>(params, &fit_params, clips, output)
        }
        "quadratic_self_onn" => {
            let fit_params =
                QuadraticSelfOnnFitParams { training: training(epochs, 0.002), words: words(0.2) };
            train::<QuadraticSelfOnnKind>(QuadraticSelfOnnParams::default(), &fit_params, clips, output)
        }
        other => Err(Error::invalid_param(format!(
            "unknown learner {other}; choose matchboxnet, edge_speech_nets or quadratic_self_onn"
        ))),
    }
}

fn training(epochs: usize, lr: f64) -> TrainingParams {
    TrainingParams {
        epochs,
        batch_size: 32,
        lr,
        lr_schedule: ScheduleKind::Cosine,
        optimizer: OptimizerKind::Adamw,
        weight_decay: 0.01,
        ..TrainingParams::default()
    }
}

fn train<K: TrainableWords>(
    params: K::Params,
    fit_params: &K::FitParams,
    clips: &str,
    output: &str,
) -> Result<()> {
    let clips = ExternalDataset::new(clips, "speech_commands");
    let clips = &*open(&clips, &OpenOptions::default(), &Problems::strict())?;
    let (held_out, training) = (0..clips.len()).partition(|index| is_held_out(&clips.name(*index)));
    let (training, held_out) = (Subset::new(clips, training)?, Subset::new(clips, held_out)?);
    let mut handle = Handle::<WordLearner<K>>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, resume: true, ..FitJob::new(Path::new(output)) };
    let statistics = handle.fit(fit_params, (&training as &dyn DatasetIterator).into(), None, &job)?;
    println!("{statistics}");
    let mut correct = 0;
    for index in 0..held_out.len() {
        let sample = held_out.get(index)?;
        let (Some(Value::Audio(audio)), Some(Value::Category(word))) = (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("the sample has no audio with a class"));
        };
        correct += usize::from(handle.infer(AudioInput::from(audio))?.class == word.class);
    }
    let (count, trained) = (held_out.len(), training.len());
    println!(
        "trained on {trained} clips; correct of {count} clips of other speakers: {correct}, accuracy {:.4}",
        correct as f64 / count as f64
    );
    Ok(())
}

/// Whether a clip is of the held-out fifth of the speakers, by the hash in its name; noise has no speaker and is split by its
/// number.
fn is_held_out(name: &str) -> bool {
    let file = name.rsplit('/').next().unwrap_or(name);
    let speaker = speaker_of_clip(file).trim_end_matches(".wav");
    u64::from_str_radix(speaker, 16).is_ok_and(|hash| hash % 5 == 4)
}
