use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{ErrorKind, Random};
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::overfit::losses_on_one_batch;
use opendr_training::OptimizerKind;

use super::network::AudiovisualNetwork;
use super::objective::AudiovisualObjective;
use super::*;

const RATE: u32 = 8000;

fn params() -> AudiovisualEmotionParams {
    AudiovisualEmotionParams { seq_length: 3, sample_rate: RATE, seconds: 1.0, ..Default::default() }
}

/// Noise with one class in each modality: the voice trembles, rises or falls, the face is red, green or blue.
struct Persons;

impl Dataset for Persons {}

impl DatasetIterator for Persons {
    fn len(&self) -> usize {
        9
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let target = Category::new(index as i64 % 3, None);
        Ok(Sample { data: vec![voice(index).into(), face(index).into()], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        ["calm", "happy", "sad"].into_iter().collect()
    }
}

fn voice(index: usize) -> Audio {
    let mut random = Random::new(index as u64);
    let loudness = |at: usize| match index % 3 {
        0 => (at as f32 / RATE as f32 * 25.0).sin().abs(),
        1 => at as f32 / RATE as f32,
        _ => 1.0 - at as f32 / RATE as f32,
    };
    let samples: Vec<f32> =
        (0..RATE as usize).map(|at| 0.2 * loudness(at) * random.normal() as f32).collect();
    Audio::new(samples, 1, RATE).unwrap()
}

fn face(index: usize) -> Video {
    let mut random = Random::new(index as u64 + 50);
    let size = 4 * 12 * 12;
    let level = |at: usize| {
        let own = if at / size == index % 3 { 0.8 } else { 0.2 };
        own + 0.1 * random.normal() as f32
    };
    Video::new((0..3 * size).map(level).collect::<Vec<_>>(), [3, 4, 12, 12]).unwrap()
}

#[test]
fn every_fusion_overfits_one_batch() {
    for fusion in [
        AudiovisualFusion::IntermediateAttention,
        AudiovisualFusion::IntermediateTransformer,
        AudiovisualFusion::LateTransformer,
    ] {
        let params = AudiovisualEmotionParams { fusion, ..params() };
        let (sizes, classes) = (Sizes::new(&params, 16), Persons.classes());
        let objective =
            AudiovisualObjective { params: &params, classes, sizes, mod_drop: ModalityDrop::None };
        let samples = (0..Persons.len()).map(|index| Persons.get(index).unwrap()).collect();
        let network =
            |device: &burn::tensor::Device| AudiovisualNetwork::new(&sizes, fusion, 3, (4, 0.0), device);
        let [before, after] = losses_on_one_batch(&objective, network, samples, 0.002);
        assert!(after < 0.05 * before, "{fusion:?} {before} {after}");
    }
}

#[test]
fn one_modality_suffices_after_training() {
    let output = std::env::temp_dir().join(format!("opendr-audiovisual-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let mut fit_params =
        AudiovisualEmotionFitParams { side: 16, width: 4, dropout: 0.0, ..Default::default() };
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.training.lr) = (80, 9, 0.003);
    (fit_params.training.optimizer, fit_params.training.lr_steps) = (OptimizerKind::Adam, Vec::new());
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let mut handle = Handle::<AudiovisualEmotion>::new(params(), Device::Cpu).unwrap();
    let dataset = DatasetRef::from(&Persons as &dyn DatasetIterator);
    handle.fit(&fit_params, dataset, None, &job).unwrap();
    let silence = Audio::new(vec![0.0; 100], 1, RATE).unwrap();
    let mut predict = |audio: &Audio, video: Option<&Video>| {
        handle.infer(AudiovisualInputs { audio, video }).map(|category| category.class as usize)
    };
    let [mut both, mut audio_only, mut video_only] = [0; 3];
    for index in 0..9 {
        let (audio, video) = (voice(index), face(index));
        both += usize::from(predict(&audio, Some(&video)).unwrap() == index % 3);
        audio_only += usize::from(predict(&audio, None).unwrap() == index % 3);
        video_only += usize::from(predict(&silence, Some(&video)).unwrap() == index % 3);
    }
    assert!(both == 9 && audio_only >= 8 && video_only >= 8, "{both} {audio_only} {video_only}");
    assert!(predict(&silence, None).unwrap() < 3);
    let other_rate = Audio::new(vec![0.1; 100], 1, 16_000).unwrap();
    assert_eq!(predict(&other_rate, None).unwrap_err().kind(), ErrorKind::InvalidInput);
    let grey = Video::new(vec![0.5; 4], [1, 1, 2, 2]).unwrap();
    assert_eq!(predict(&silence, Some(&grey)).unwrap_err().kind(), ErrorKind::InvalidInput);
    let calls = (0..3).map(|index| Persons.get(index).unwrap().data).collect();
    check_trained_learner::<AudiovisualEmotion>(&job.model(), &output.join("scratch"), calls);
    std::fs::remove_dir_all(&output).ok();
}
