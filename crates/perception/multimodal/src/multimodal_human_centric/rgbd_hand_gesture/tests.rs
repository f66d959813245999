use opendr_engine::data::{Layout, PixelFormat};
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::{ErrorKind, Random};
use opendr_perception_common::small_classifier::SmallClassifier;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::overfit::losses_on_one_batch;

use super::objective::RgbdObjective;
use super::*;

/// Images of almost equal colours; the depth determines the class: the near part is above, below or absent.
struct Hands;

impl Dataset for Hands {}

impl DatasetIterator for Hands {
    fn len(&self) -> usize {
        12
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (image, depth) = pictures(index);
        let target = Category::new(index as i64 % 3, None);
        Ok(Sample { data: vec![image.into(), depth.into()], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        ["above", "below", "nothing"].into_iter().collect()
    }
}

fn pictures(index: usize) -> (Image, Image) {
    let mut random = Random::new(index as u64);
    let levels: Vec<u8> = (0..20 * 20 * 3).map(|_| 124 + random.below(8) as u8).collect();
    let metres = |at: usize| match (index % 3, at / 160) {
        (0, 0) | (1, 1) => 0.5,
        _ => 0.9,
    };
    let depth: Vec<f32> = (0..16 * 20).map(metres).collect();
    let depth = Image::new(depth, 16, 20, PixelFormat::Grey, Layout::Hwc).unwrap();
    (Image::from_rgb8(levels, 20, 20).unwrap(), depth)
}

#[test]
fn overfits_one_batch() {
    let params = RgbdHandGestureParams::default();
    let objective = RgbdObjective { params: &params, classes: Hands.classes(), side: 16, drop_depth: false };
    let samples = (0..Hands.len()).map(|index| Hands.get(index).unwrap()).collect();
    let network = |device: &burn::tensor::Device| SmallClassifier::new(CHANNELS, 3, 8, 0.0, device);
    let [before, after] = losses_on_one_batch(&objective, network, samples, 0.005);
    assert!(after < 0.05 * before, "{before} {after}");
}

#[test]
fn infer_loads_the_model_of_fit_and_depth_decides() {
    let output = std::env::temp_dir().join(format!("opendr-rgbd-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let mut fit_params =
        RgbdHandGestureFitParams { side: 16, width: 8, dropout: 0.0, drop_depth: true, ..Default::default() };
    (fit_params.training.epochs, fit_params.training.batch_size, fit_params.training.lr) = (60, 6, 0.01);
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let mut handle = Handle::<RgbdHandGesture>::new(Default::default(), Device::Cpu).unwrap();
    let dataset = DatasetRef::from(&Hands as &dyn DatasetIterator);
    handle.fit(&fit_params, dataset, None, &job).unwrap();
    let predict = |handle: &mut Handle<RgbdHandGesture>, image: &Image, depth: &Image| {
        handle.infer(RgbdInputs { image, depth })
    };
    // Colours of one sample, depth of another one that is not paired with it in training.
    let mut right = 0;
    for index in 0..12 {
        let ((image, _), (_, depth)) = (pictures(index + 100), pictures(index));
        right += usize::from(predict(&mut handle, &image, &depth).unwrap().class == index as i64 % 3);
    }
    assert!(right >= 11, "{right} of 12");
    let (image, depth) = pictures(0);
    let unknown = Image::new(vec![0u16; 4], 2, 2, PixelFormat::Grey, Layout::Hwc).unwrap();
    let category = predict(&mut handle, &image, &unknown).unwrap();
    assert_eq!((category.probabilities.len(), category.description.is_some()), (3, true));
    assert_eq!(predict(&mut handle, &image, &unknown).unwrap(), category);
    let refused = predict(&mut handle, &depth, &image).unwrap_err();
    assert_eq!(refused.kind(), ErrorKind::InvalidInput);
    let calls = (0..3).map(|index| Hands.get(index).unwrap().data).collect();
    check_trained_learner::<RgbdHandGesture>(&job.model(), &output.join("scratch"), calls);
    let params = RgbdHandGestureParams { n_class: Some(16), ..Default::default() };
    let mut other = Handle::<RgbdHandGesture>::new(params, Device::Cpu).unwrap();
    assert_eq!(other.load(job.model()).unwrap_err().kind(), ErrorKind::InvalidParam);
    std::fs::remove_dir_all(&output).ok();
}
