use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{Fit, FitJob, Handle};
use opendr_engine::target::HeatmapValues;
use opendr_engine::{ErrorKind, Random};
use opendr_perception_testing::overfit::losses_on_one_batch;

use super::network::BisenetNetwork;
use super::objective::{SegmentPixels, class_weights};
use super::*;

/// A road below a sky, whose slope depends on the index; one corner is ignored.
struct Roads;

impl Dataset for Roads {}

impl DatasetIterator for Roads {
    fn len(&self) -> usize {
        6
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::new(index as u64);
        let class = |x: usize, y: usize| u32::from(y > 20 + (x * index) / 16);
        let (mut levels, mut labels) = (Vec::new(), Vec::new());
        for y in 0..48 {
            for x in 0..64 {
                let noise = 30.0 * random.normal();
                let colour: [f64; 3] = [[90.0, 150.0, 220.0], [80.0, 80.0, 80.0]][class(x, y) as usize];
                levels.extend(colour.map(|level| (level + noise) as u8));
                labels.push(if x < 4 && y < 4 { 255 } else { class(x, y) });
            }
        }
        let map = Heatmap::from_labels(labels, &[48, 64])?;
        Ok(Sample { data: vec![Image::from_rgb8(levels, 64, 48)?.into()], target: Some(map.into()) })
    }

    fn classes(&self) -> Classes {
        ["sky", "road"].into_iter().collect()
    }
}

fn objective() -> SegmentPixels {
    SegmentPixels {
        classes: Roads.classes(),
        size: [32, 64],
        crop: 1.0,
        flip: 0.0,
        colour: 0.0,
        weights: vec![1.0; 2],
    }
}

fn picture(index: usize) -> Image {
    match Roads.get(index).unwrap().data.into_iter().next() {
        Some(opendr_engine::Value::Image(image)) => image,
        other => panic!("{other:?}"),
    }
}

#[test]
fn overfits_one_batch() {
    let samples = (0..4).map(|index| Roads.get(index).unwrap()).collect();
    let network = |device: &_| BisenetNetwork::new(2, 4, false, device);
    let [before, after] = losses_on_one_batch(&objective(), network, samples, 0.01);
    assert!(after < 0.1 * before, "{before} {after}");
}

#[test]
fn rare_classes_weigh_more() {
    let job = FitJob::new(std::path::Path::new("unused"));
    assert_eq!(class_weights(&Roads, 2, 0.0, &job).unwrap(), [1.0, 1.0]);
    let mut pixels = [0_u64; 2];
    for index in 0..Roads.len() {
        let Some(opendr_engine::Value::Heatmap(map)) = Roads.get(index).unwrap().target else { panic!() };
        let HeatmapValues::Labels(labels) = map.values() else { panic!() };
        labels.iter().filter(|label| **label < 2).for_each(|label| pixels[*label as usize] += 1);
    }
    let weights = class_weights(&Roads, 2, 0.5, &job).unwrap();
    let wanted = (pixels[0] as f32 / pixels[1] as f32).sqrt();
    assert!((weights[1] / weights[0] - wanted).abs() < 1e-3, "{weights:?} {pixels:?}");
    // A class without a pixel counts as rare as the rarest.
    let weights = class_weights(&Roads, 3, 0.5, &job).unwrap();
    assert_eq!(weights[2], weights[0].max(weights[1]));
}

#[test]
fn the_fine_network_also_overfits() {
    let samples = (0..4).map(|index| Roads.get(index).unwrap()).collect();
    let network = |device: &_| BisenetNetwork::new(2, 4, true, device);
    let [before, after] = losses_on_one_batch(&objective(), network, samples, 0.01);
    assert!(after < 0.1 * before, "{before} {after}");
}

#[test]
fn infer_loads_the_model_of_fit() {
    let output = std::env::temp_dir().join(format!("opendr-bisenet-{}", std::process::id()));
    std::fs::remove_dir_all(&output).ok();
    let mut fit_params = BisenetFitParams {
        crop_height: 32,
        crop_width: 64,
        width: 4,
        crop: 1.0,
        flip: 0.0,
        ..BisenetFitParams::default()
    };
    (fit_params.training.epochs, fit_params.training.batch_size) = (40, 6);
    fit_params.training.lr = 0.01;
    let job = FitJob { device: Device::Cpu, ..FitJob::new(&output) };
    let dataset = || DatasetRef::from(&Roads as &dyn DatasetIterator);
    let params = BisenetParams::default();
    let mut handle = Handle::<Bisenet>::new(params.clone(), Device::Cpu).unwrap();
    handle.fit(&fit_params, dataset(), None, &job).unwrap();
    let map = handle.infer(&picture(0)).unwrap();
    assert_eq!(map.shape(), [48, 64]);
    let HeatmapValues::Labels(labels) = map.values() else { panic!() };
    let right = (0..48 * 64).filter(|at| labels[*at] == u32::from(at / 64 > 20)).count();
    assert!(right > 48 * 64 * 85 / 100, "{right}");
    fit_params.crop_width = 60;
    let refused = Bisenet::fit(None, &params, &fit_params, dataset(), None, &job).unwrap_err();
    assert_eq!(refused.kind(), ErrorKind::InvalidParam);
    std::fs::remove_dir_all(&output).ok();
}
