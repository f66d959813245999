//! Trains a learner of words on those of Speech Commands, and measures it on the clips of a fifth of the speakers, kept apart.
//!
//! The clips are of the test set of version 0.02, of ten words, silence and other words. It makes the zoo's
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
    EdgeSpeechNet, EdgeSpeechNetsFitParams, EdgeSpeechNetsKind, EdgeSpeechNetsParams, MatchboxNetFitParams,
    MatchboxNetKind, MatchboxNetParams, QuadraticSelfOnnFitParams, QuadraticSelfOnnKind,
    QuadraticSelfOnnParams, Sound, TrainableWords, WordFitParams, WordLearner,
};
use opendr_training::{OptimizerKind, ScheduleKind, TrainingParams};

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let (learner, clips, output, epochs) = match &arguments[..] {
        [learner, clips, output] => (learner, clips, output, 60),
        [learner, clips, output, epochs] => {
            let wrong = || Error::invalid_param(format!("{epochs:?} epochs; give a number"));
            (learner, clips, output, epochs.parse().map_err(|_| wrong())?)
        }
        _ => {
            return Err(Error::invalid_param(
                "give a learner, the folder of the clips, one for the model and, if you like, the epochs (60)",
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
            "no learner {other}; give matchboxnet, edge_speech_nets or quadratic_self_onn"
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
    let (kept_apart, training) = (0..clips.len()).partition(|index| is_kept_apart(&clips.name(*index)));
    let (training, kept_apart) = (Subset::new(clips, training)?, Subset::new(clips, kept_apart)?);
    let mut handle = Handle::<WordLearner<K>>::new(params, Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, resume: true, ..FitJob::new(Path::new(output)) };
    let statistics = handle.fit(fit_params, (&training as &dyn DatasetIterator).into(), None, &job)?;
    println!("{statistics}");
    let mut right = 0;
    for index in 0..kept_apart.len() {
        let sample = kept_apart.get(index)?;
        let (Some(Value::Audio(audio)), Some(Value::Category(word))) = (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("no clip with its word"));
        };
        right += usize::from(handle.infer(Sound::from(audio))?.class == word.class);
    }
    let (count, trained) = (kept_apart.len(), training.len());
    println!(
        "trained on {trained} clips; of {count} of other speakers {right} are right: {:.4}",
        right as f64 / count as f64
    );
    Ok(())
}

/// A fifth of the speakers, by the hash that names them; noise, which nobody speaks, by its number.
fn is_kept_apart(name: &str) -> bool {
    let file = name.rsplit('/').next().unwrap_or(name);
    let speaker = speaker_of_clip(file).trim_end_matches(".wav");
    u64::from_str_radix(speaker, 16).is_ok_and(|hash| hash % 5 == 4)
}
