//! Trains YOLOX from random weights on drawn shapes and measures it on others.
//!
//! ```console
//! $ cargo run --release -p opendr-detection --features training --example train_shapes -- out 30
//! ```
//!
//! The second argument is the number of epochs of 512 images. Images have 160 x 160 pixels: one to four circles, squares and
//! triangles of any colour and size on noise, partly hidden by each other.

use std::path::Path;
use std::time::Instant;

use opendr_detection::object_detection_2d::{Yolox, YoloxFitParams, YoloxParams};
use opendr_engine::data::Image;
use opendr_engine::dataset::{Dataset, DatasetIterator, DatasetRef, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::target::{BoundingBox, BoundingBoxList, Classes};
use opendr_engine::{Device, Error, Header, Progress, Random, Result, Unit, Value};
use opendr_metrics::{CocoDetection, Metric};
use opendr_training::TrainingParams;

const SIDE: usize = 160;
/// Seeds and numbers of the images for training and testing.
const TRAINING: (u64, usize) = (1, 512);
const TEST: (u64, usize) = (2, 200);

/// Images of shapes.
struct Shapes {
    seed: u64,
    count: usize,
}

#[derive(Clone, Copy)]
struct Shape {
    class: usize,
    left: f32,
    top: f32,
    side: f32,
    colour: [u8; 3],
}

impl Shape {
    fn random(random: &mut Random) -> Self {
        let side = random.uniform(16.0, 80.0);
        let most = SIDE as f32 - side;
        Self {
            class: random.below(3),
            left: random.uniform(0.0, most),
            top: random.uniform(0.0, most),
            side,
            colour: [0, 1, 2].map(|_| random.below(256) as u8),
        }
    }

    fn contains(&self, x: f32, y: f32) -> bool {
        let (x, y) = ((x - self.left) / self.side, (y - self.top) / self.side);
        match self.class {
            0 => (x - 0.5).hypot(y - 0.5) <= 0.5,
            1 => (0.0..=1.0).contains(&x) && (0.0..=1.0).contains(&y),
            _ => (0.0..=1.0).contains(&y) && (x - 0.5).abs() <= y / 2.0,
        }
    }

    /// Returns the share of `self` that is in the box of `other`.
    fn hidden_by(&self, other: &Self) -> f32 {
        let along = |a: f32, b: f32| ((a + self.side).min(b + other.side) - a.max(b)).max(0.0);
        along(self.left, other.left) * along(self.top, other.top) / (self.side * self.side)
    }
}

impl Dataset for Shapes {}

impl DatasetIterator for Shapes {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let mut random = Random::from_key([self.seed, index as u64]);
        let mut shapes: Vec<Shape> = Vec::new();
        for _ in 0..1 + random.below(4) {
            let new = Shape::random(&mut random);
            if shapes.iter().all(|shape| shape.hidden_by(&new) < 0.3) {
                shapes.push(new);
            }
        }
        let ground = 40 + random.below(140);
        let mut pixels: Vec<u8> = (0..SIDE * SIDE * 3).map(|_| (ground + random.below(50)) as u8).collect();
        for (at, pixel) in pixels.chunks_exact_mut(3).enumerate() {
            let (x, y) = ((at % SIDE) as f32 + 0.5, (at / SIDE) as f32 + 0.5);
            if let Some(shape) = shapes.iter().rev().find(|shape| shape.contains(x, y)) {
                pixel.copy_from_slice(&shape.colour);
            }
        }
        let boxes: Vec<BoundingBox> = shapes
            .iter()
            .map(|&Shape { class, left, top, side, .. }| {
                BoundingBox::new(class as i64, left, top, side, side, 1.0)
            })
            .collect();
        let list = BoundingBoxList { classes: self.classes(), ..boxes.into() };
        let image = Image::from_rgb8(pixels, SIDE, SIDE)?.with_header(Header::new(1 + index as i64, "drawn"));
        Ok(Sample { data: vec![image.into()], target: Some(list.into()) })
    }

    fn classes(&self) -> Classes {
        ["circle", "square", "triangle"].into_iter().collect()
    }
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [output, epochs] = &arguments[..] else {
        return Err(Error::invalid_param("usage: train_shapes OUTPUT_FOLDER EPOCHS"));
    };
    let epochs =
        epochs.parse().map_err(|_| Error::invalid_param("the second argument must be a number of epochs"))?;
    let defaults = YoloxFitParams::default();
    let fit_params = YoloxFitParams {
        side: Some(SIDE),
        mosaic: 0.0,
        training: TrainingParams { epochs, ema: 0.99, ..defaults.training.clone() },
        ..defaults
    };
    let params = YoloxParams { threshold: 0.01, ..YoloxParams::default() };
    let mut learner = Handle::<Yolox>::new(params, Device::Cpu)?;
    let job = FitJob { progress: &Lines, ..FitJob::new(Path::new(output)) };
    let shapes = Shapes { seed: TRAINING.0, count: TRAINING.1 };
    let begin = Instant::now();
    learner.fit(&fit_params, DatasetRef::Iterator(&shapes), None, &job)?;
    println!("trained in {:.0} s", begin.elapsed().as_secs_f64());
    let (test, mut metric) = (
        Shapes { seed: TEST.0, count: TEST.1 },
        CocoDetection::new(&<CocoDetection as Metric>::Params::default())?,
    );
    for index in 0..test.len() {
        let sample = test.get(index)?;
        let (Some(Value::Image(image)), Some(Value::BoundingBoxList(truth))) =
            (sample.data.into_iter().next(), sample.target)
        else {
            return Err(Error::internal("the sample is not an image with boxes"));
        };
        metric.update(index, &learner.infer(&image)?, &truth)?;
    }
    let scalars = metric.finish().statistics.scalars;
    for name in ["map", "map50"] {
        println!("{name} {:.4}", scalars.get(name).copied().unwrap_or(f64::NAN));
    }
    Ok(())
}

/// Prints the progress.
struct Lines;

impl Progress for Lines {
    fn begin(&self, what: &str, total: Option<u64>, _: Unit) {
        println!("{what}: {total:?}");
    }

    fn advance(&self, _: u64) {}

    fn end(&self) {}

    fn status(&self, text: &str) {
        println!("{text}");
    }

    fn note(&self, line: &str) {
        println!("{line}");
    }
}
