use burn::optim::{AdamWConfig, GradientsParams};
use opendr_datasets::loader::Collate;
use opendr_engine::data::Image;
use opendr_engine::dataset::Sample;
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{ErrorKind, Random, Value};

use super::*;

const SMALL: usize = 96;

fn objective(classes: usize) -> NanodetObjective {
    let classes: Classes = ["a", "b", "c"].into_iter().take(classes).collect();
    NanodetObjective { side: SMALL, classes, augment: false, manifest: Manifest::new("nanodet", "") }
}

/// Returns a sample of noise with two plain squares.
fn sample(class: i64) -> Sample {
    let mut random = Random::new(3);
    let mut pixels: Vec<u8> = (0..3 * SMALL * SMALL).map(|_| random.below(60) as u8).collect();
    let corners = [[8usize, 16, 40, 56], [44, 30, 90, 84]];
    for (number, [x0, y0, x1, y1]) in corners.into_iter().enumerate() {
        for at in (y0..y1).flat_map(|y| (x0..x1).map(move |x| 3 * (y * SMALL + x))) {
            pixels[at + number] = 250;
        }
    }
    let boxes = corners.map(|corners| corners.map(|edge| edge as f32));
    let boxes = boxes.into_iter().zip([0, class]);
    let boxes = boxes.map(|(corners, class)| BoundingBox::from_corners(class, corners, 1.0)).collect();
    let image = Image::from_rgb8(pixels, SMALL, SMALL).unwrap();
    Sample {
        data: vec![Value::Image(image)],
        target: Some(Value::BoundingBoxList(BoundingBoxList { boxes, ..BoundingBoxList::default() })),
    }
}

fn batch(objective: &NanodetObjective, samples: Vec<Sample>) -> Result<Batch> {
    let collate = objective.collate()?;
    let mut batch = collate.start(samples.len());
    samples.into_iter().try_for_each(|sample| collate.add(&mut batch, sample))?;
    Ok(batch)
}

fn value(tensor: Tensor<1>) -> f32 {
    tensor.into_scalar::<f32>()
}

#[test]
fn one_batch_is_overfitted() {
    let device = Device::flex().autodiff();
    device.seed(1);
    let objective = objective(2);
    let batch = batch(&objective, vec![sample(1)]).unwrap();
    let mut network = NanodetNetwork::new(2, &device);
    let mut optimizer = AdamWConfig::new().with_weight_decay(0.0).init();
    let mut losses = Vec::new();
    for step in 0..300 {
        let loss = objective.loss(&network, &batch, &device).unwrap().total;
        losses.push(value(loss.clone()));
        if losses[step] < 0.05 * losses[0] {
            println!("{} -> {} in {step} steps", losses[0], losses[step]);
            return;
        }
        let gradients = GradientsParams::from_grads(loss.backward(), &network);
        let lr = 1e-3 * (1.0 - step as f64 / 330.0);
        network = optimizer.step(lr, network, gradients);
    }
    panic!("{losses:?}");
}

#[test]
fn a_perfect_prediction_has_no_loss() {
    let device = Device::flex();
    let objective = objective(2);
    let batch = batch(&objective, vec![sample(1), sample(0)]).unwrap();
    let cells = batch.pictures.len() * Grid96::CELLS;
    let mut rows = vec![-30.0f32; cells * (2 + DISTANCES)];
    for positive in &batch.positives {
        let row = &mut rows[positive.cell * (2 + DISTANCES)..][..2 + DISTANCES];
        row[positive.class] = 30.0;
        for (bins, distance) in row[2..].chunks_exact_mut(BINS).zip(positive.distances) {
            bins[distance as usize] = (1.0 - distance.fract()).max(1e-9).ln();
            bins[distance as usize + 1] = distance.fract().max(1e-9).ln();
        }
    }
    let rows = Tensor::from_data(TensorData::new(rows, [2, Grid96::CELLS, 2 + DISTANCES]), &device);
    let loss = loss_of_rows(rows, &batch.positives, &device);
    assert!(value(loss.total.clone()).abs() < 1e-3, "{}", value(loss.total));
}

struct Grid96;

impl Grid96 {
    const CELLS: usize = 12 * 12 + 6 * 6 + 3 * 3;
}

#[test]
fn the_focal_loss_is_that_of_the_paper() {
    let logits = Tensor::<2>::from_data([[0.4f32, -1.2]], &Device::flex());
    let quality = Tensor::<2>::from_data([[0.7f32, 0.0]], &Device::flex());
    let loss = value(focal_loss(logits, quality));
    let part = |logit: f32, quality: f32| {
        let score = 1.0 / (1.0 + (-logit).exp());
        -(quality - score).powi(2) * ((1.0 - quality) * (1.0 - score).ln() + quality * score.ln())
    };
    assert!((loss - part(0.4, 0.7) - part(-1.2, 0.0)).abs() < 1e-6);
}

#[test]
fn images_without_boxes_are_background() {
    let device = Device::flex().autodiff();
    let objective = objective(2);
    let empty = Sample { target: Some(Value::BoundingBoxList(BoundingBoxList::default())), ..sample(0) };
    let batch = batch(&objective, vec![empty]).unwrap();
    assert!(batch.positives.is_empty());
    let loss = objective.loss(&NanodetNetwork::new(2, &device), &batch, &device).unwrap();
    assert!(value(loss.total) > 0.0);
}

#[test]
fn classes_that_are_not_named_are_refused() {
    let error = batch(&objective(2), vec![sample(2)]).err().unwrap();
    assert_eq!(error.kind(), ErrorKind::InvalidInput);
    assert!(error.to_string().contains("class 2, but the data set has 2 classes"), "{error}");
    let unlabelled = Sample { target: None, ..sample(0) };
    assert_eq!(batch(&objective(2), vec![unlabelled]).err().unwrap().kind(), ErrorKind::InvalidInput);
}

#[test]
fn new_classes_keep_the_weights_for_boxes() {
    let device = Device::flex();
    let network = NanodetNetwork::new(3, &device);
    let picture = Tensor::<4>::random([1, 3, 64, 64], burn::tensor::Distribution::Normal(0.0, 1.0), &device);
    let [before, after] = [network.clone(), network.with_classes(2)].map(|network| {
        assert_eq!(network.infer(picture.clone()).len(), 6);
        network.infer(picture.clone()).split_off(3)
    });
    for (before, after) in before.into_iter().zip(after) {
        assert!(before.sub(after).abs().max().into_scalar::<f32>() < 1e-6);
    }
}

#[test]
fn frozen_layers_have_no_gradient() {
    let device = Device::flex().autodiff();
    let objective = objective(2);
    let batch = batch(&objective, vec![sample(1)]).unwrap();
    let count = |network: NanodetNetwork| {
        let loss = objective.loss(&network, &batch, &device).unwrap();
        GradientsParams::from_grads(loss.total.backward(), &network).len()
    };
    let network = NanodetNetwork::new(2, &device);
    let (all, no_backbone) = (count(network.clone()), count(network.clone().freeze_backbone()));
    assert_eq!((all, no_backbone), (68, 18));
    assert_eq!(count(network.freeze_features()), 12);
}
