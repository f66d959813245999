//! Trains BiSeNet on synthetic street scenes with CamVid's eleven classes and measures it on other scenes.
//!
//! ```console
//! $ cargo run --release -p opendr-segmentation --features training --example train_bisenet -- out
//! ```
//!
//! The example produces the zoo's `bisenet/drawn_streets`. The scenes are drawings: on photographs the model is of little use.

use std::path::Path;

use opendr_engine::data::Image;
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::target::{Classes, Heatmap, HeatmapValues};
use opendr_engine::{Device, Error, Random, Result, Value};
use opendr_segmentation::semantic_segmentation::{Bisenet, BisenetFitParams, BisenetParams};

const CLASSES: [&str; 11] = [
    "Sky",
    "Building",
    "Pole",
    "Road",
    "Pavement",
    "Tree",
    "SignSymbol",
    "Fence",
    "Car",
    "Pedestrian",
    "Bicyclist",
];
const WIDTH: usize = 192;
const HEIGHT: usize = 144;
/// First seed of the held-out scenes.
const HELD_OUT: u64 = 1_000_000;

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [output, rest @ ..] = &arguments[..] else {
        return Err(Error::invalid_param("usage: train_bisenet OUTPUT_FOLDER [SCENES] [EPOCHS]"));
    };
    let number = |at: usize, usual: usize| rest.get(at).and_then(|text| text.parse().ok()).unwrap_or(usual);
    let scenes = Streets { first: 0, count: number(0, 600) };
    let mut fit_params =
        BisenetFitParams { crop_height: 96, crop_width: 128, width: 12, colour: 0.0, ..Default::default() };
    fit_params.training.epochs = number(1, 20);
    let mut handle = Handle::<Bisenet>::new(BisenetParams::default(), Device::Cpu)?;
    let job = FitJob { device: Device::Cpu, ..FitJob::new(Path::new(output)) };
    println!("{}", handle.fit(&fit_params, (&scenes as &dyn DatasetIterator).into(), None, &job)?);
    measure(&mut handle, &Streets { first: HELD_OUT, count: 100 })
}

/// Prints the intersection over union of each class over all pixels.
fn measure(handle: &mut Handle<Bisenet>, scenes: &Streets) -> Result<()> {
    let mut counts = [[0_u64; CLASSES.len()]; CLASSES.len()];
    for index in 0..scenes.len() {
        let sample = scenes.get(index)?;
        let (Some(Value::Image(image)), Some(Value::Heatmap(ground_truth))) =
            (sample.data.first(), &sample.target)
        else {
            return Err(Error::invalid_input("the sample has no image with a map"));
        };
        let found = handle.infer(image)?;
        let (HeatmapValues::Labels(found), HeatmapValues::Labels(wanted)) =
            (found.values(), ground_truth.values())
        else {
            return Err(Error::invalid_input("the map has no classes"));
        };
        for (found, wanted) in found.iter().zip(wanted.iter()) {
            counts[*wanted as usize][*found as usize] += 1;
        }
    }
    let mut sum = 0.0;
    for (class, name) in CLASSES.iter().enumerate() {
        let there: u64 = counts[class].iter().sum();
        let predicted: u64 = counts.iter().map(|row| row[class]).sum();
        let both = counts[class][class];
        let overlap = both as f64 / (there + predicted - both).max(1) as f64;
        println!("{name}: IoU {overlap:.3}");
        sum += overlap;
    }
    let correct: u64 = (0..CLASSES.len()).map(|class| counts[class][class]).sum();
    let all: u64 = counts.iter().flatten().sum();
    println!("mean IoU {:.4}, pixel accuracy {:.4}", sum / CLASSES.len() as f64, correct as f64 / all as f64);
    Ok(())
}

/// Synthetic scenes, each with its own seed.
struct Streets {
    first: u64,
    count: usize,
}

impl Dataset for Streets {}

impl DatasetIterator for Streets {
    fn len(&self) -> usize {
        self.count
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (image, map) = Scene::new(self.first + index as u64).drawn()?;
        Ok(Sample { data: vec![image.into()], target: Some(map.into()) })
    }

    fn classes(&self) -> Classes {
        CLASSES.into_iter().collect()
    }
}

/// Canvas of colours and classes.
struct Scene {
    random: Random,
    colours: Vec<[f64; 3]>,
    classes: Vec<u32>,
}

type Colour = [f64; 3];

impl Scene {
    fn new(seed: u64) -> Self {
        Self {
            random: Random::new(seed),
            colours: vec![[0.0; 3]; WIDTH * HEIGHT],
            classes: vec![0; WIDTH * HEIGHT],
        }
    }

    fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.random.unit()
    }

    /// Returns a colour near `base`.
    fn near(&mut self, base: Colour, spread: f64) -> Colour {
        let light = self.between(-spread, spread);
        base.map(|level| level + light + self.between(-spread / 3.0, spread / 3.0))
    }

    fn paint(&mut self, class: u32, colour: Colour, inside: impl Fn(f64, f64) -> bool) {
        for at in 0..WIDTH * HEIGHT {
            if inside((at % WIDTH) as f64, (at / WIDTH) as f64) {
                (self.colours[at], self.classes[at]) = (colour, class);
            }
        }
    }

    fn square(&mut self, class: u32, colour: Colour, [left, top, width, height]: [f64; 4]) {
        self.paint(class, colour, |x, y| x >= left && x < left + width && y >= top && y < top + height);
    }

    fn disc(&mut self, class: u32, colour: Colour, [x0, y0]: [f64; 2], [across, down]: [f64; 2]) {
        self.paint(class, colour, |x, y| ((x - x0) / across).powi(2) + ((y - y0) / down).powi(2) < 1.0);
    }

    fn drawn(mut self) -> Result<(Image, Heatmap)> {
        let (width, height) = (WIDTH as f64, HEIGHT as f64);
        let horizon = self.between(0.35, 0.55) * height;
        let vanishing = self.between(0.3, 0.7) * width;
        let sky = self.near([150.0, 185.0, 225.0], 50.0);
        self.paint(0, sky, |_, _| true);
        self.houses(horizon);
        self.fences_and_trees(horizon);
        self.ground(horizon, vanishing);
        self.poles(horizon);
        for _ in 0..2 + self.random.below(6) {
            // Nearer objects are lower and larger.
            let foot = horizon + self.between(0.08, 1.0).powi(2) * (height - horizon);
            let size = (foot - horizon) / (height - horizon) * 0.9 * height + 8.0;
            let x = self.between(0.0, width);
            match self.random.below(3) {
                0 => self.car(x, foot, size),
                1 => self.person(x, foot, size, 9),
                _ => {
                    let tyre = self.near([30.0, 30.0, 30.0], 15.0);
                    for side in [-0.28, 0.28] {
                        self.disc(10, tyre, [x + side * size, foot - 0.17 * size], [0.17 * size; 2]);
                    }
                    self.person(x, foot - 0.15 * size, 0.9 * size, 10);
                }
            }
        }
        self.finished()
    }

    fn houses(&mut self, horizon: f64) {
        let mut left = -20.0;
        while left < WIDTH as f64 {
            let (across, up) = (self.between(20.0, 70.0), self.between(0.1, 0.95) * horizon);
            if self.random.unit() < 0.75 {
                let wall = self.near([150.0, 120.0, 105.0], 60.0);
                let glass = self.near([70.0, 85.0, 100.0], 40.0);
                let step = self.between(7.0, 14.0);
                let top = horizon - up;
                self.square(1, wall, [left, top, across, up + 3.0]);
                let right = left + across;
                self.paint(1, glass, |x, y| {
                    let window = |at: f64| (at / step).fract().abs() > 0.55;
                    x > left + 2.0
                        && x < right - 2.0
                        && y > top + 2.0
                        && y < horizon
                        && window(x)
                        && window(y)
                });
            }
            left += across;
        }
    }

    fn fences_and_trees(&mut self, horizon: f64) {
        if self.random.unit() < 0.6 {
            let (left, long) = (self.between(-20.0, 150.0), self.between(30.0, 110.0));
            let (up, step) = (self.between(6.0, 14.0), self.between(3.0, 6.0));
            let (wood, gap) = (self.near([120.0, 100.0, 80.0], 40.0), self.near([90.0, 90.0, 80.0], 30.0));
            self.square(7, gap, [left, horizon - up, long, up + 3.0]);
            self.paint(7, wood, |x, y| {
                x >= left
                    && x < left + long
                    && y > horizon - up
                    && y < horizon + 3.0
                    && (x / step).fract() > 0.5
            });
        }
        for _ in 0..self.random.below(5) {
            let (x, up) = (self.between(0.0, WIDTH as f64), self.between(15.0, 55.0));
            let trunk = self.near([85.0, 65.0, 45.0], 20.0);
            self.square(5, trunk, [x - 1.5, horizon - up, 3.0, up + 4.0]);
            for _ in 0..8 {
                let leaves = self.near([65.0, 105.0, 50.0], 35.0);
                let (aside, above) = (self.random.normal() * up * 0.16, self.random.normal() * up * 0.16);
                let round = self.between(0.12, 0.25) * up;
                self.disc(5, leaves, [x + aside, horizon - up + above], [round, round]);
            }
        }
    }

    fn ground(&mut self, horizon: f64, vanishing: f64) {
        let height = HEIGHT as f64;
        let stones = self.near([150.0, 140.0, 135.0], 35.0);
        self.paint(4, stones, |_, y| y >= horizon);
        let asphalt = self.near([95.0, 95.0, 100.0], 35.0);
        let (left, right) = (self.between(-1.6, -0.5), self.between(0.5, 1.6));
        let slope = WIDTH as f64 / 2.0 / (height - horizon);
        let along = move |x: f64, y: f64| (x - vanishing) / ((y - horizon + 2.0) * slope);
        self.paint(3, asphalt, |x, y| y >= horizon && along(x, y) > left && along(x, y) < right);
        let line = self.near([215.0, 215.0, 205.0], 25.0);
        let (at, dash) = (self.between(-0.2, 0.2), self.between(3.0, 8.0));
        self.paint(3, line, |x, y| {
            let far = 60.0 / (y - horizon + 2.0);
            y >= horizon && (along(x, y) - at).abs() < 0.02 && (far * dash).fract() > 0.4
        });
    }

    fn poles(&mut self, horizon: f64) {
        for _ in 0..self.random.below(4) {
            let (x, foot) = (self.between(0.0, WIDTH as f64), horizon + self.between(2.0, 25.0));
            let (up, thick) = (self.between(30.0, 90.0), self.between(1.5, 4.0));
            let metal = self.near([110.0, 110.0, 112.0], 50.0);
            self.square(2, metal, [x, foot - up, thick, up]);
            if self.random.unit() < 0.6 {
                let round = self.between(4.0, 9.0);
                let paints = [[200.0, 40.0, 40.0], [40.0, 70.0, 190.0], [220.0, 190.0, 40.0]];
                let hue = paints[self.random.below(3)];
                let paint = self.near(hue, 30.0);
                self.disc(6, paint, [x + thick / 2.0, foot - up + round], [round, round]);
            }
        }
    }

    fn car(&mut self, x: f64, foot: f64, size: f64) {
        let paints = [[170.0, 40.0, 40.0], [50.0, 70.0, 150.0], [200.0; 3], [45.0; 3], [150.0, 150.0, 155.0]];
        let hue = paints[self.random.below(5)];
        let paint = self.near(hue, 30.0);
        let (glass, tyre) = (self.near([60.0, 75.0, 90.0], 30.0), self.near([25.0; 3], 10.0));
        let (long, up) = (self.between(0.9, 1.5) * size, 0.3 * size);
        self.square(8, paint, [x - long / 2.0, foot - up, long, 0.85 * up]);
        self.square(8, paint, [x - 0.3 * long, foot - 1.7 * up, 0.6 * long, 0.8 * up]);
        self.square(8, glass, [x - 0.25 * long, foot - 1.6 * up, 0.5 * long, 0.5 * up]);
        for side in [-0.3, 0.3] {
            self.disc(8, tyre, [x + side * long, foot - 0.25 * up], [0.3 * up; 2]);
        }
    }

    fn person(&mut self, x: f64, foot: f64, size: f64, class: u32) {
        let skin = self.near([190.0, 150.0, 125.0], 45.0);
        let hues = [self.between(20.0, 220.0), self.between(20.0, 220.0), self.between(20.0, 220.0)];
        let (coat, legs) = (self.near(hues, 20.0), self.near([60.0, 60.0, 80.0], 40.0));
        let tall = 0.75 * size;
        for side in [-0.09, 0.02] {
            self.square(class, legs, [x + side * tall, foot - 0.45 * tall, 0.08 * tall, 0.45 * tall]);
        }
        self.disc(class, coat, [x, foot - 0.62 * tall], [0.14 * tall, 0.24 * tall]);
        self.disc(class, skin, [x, foot - 0.92 * tall], [0.075 * tall, 0.09 * tall]);
    }

    /// Applies gain, tint and noise, and converts to bytes.
    fn finished(mut self) -> Result<(Image, Heatmap)> {
        let (gain, grain) = (self.between(0.6, 1.25), self.between(2.0, 14.0));
        let tint: Colour = std::array::from_fn(|_| self.between(-12.0, 12.0));
        let mut levels = Vec::with_capacity(3 * WIDTH * HEIGHT);
        for at in 0..WIDTH * HEIGHT {
            let noise = grain * self.random.normal();
            levels.extend([0, 1, 2].map(|channel| {
                (self.colours[at][channel] * gain + tint[channel] + noise).clamp(0.0, 255.0) as u8
            }));
        }
        Ok((Image::from_rgb8(levels, WIDTH, HEIGHT)?, Heatmap::from_labels(self.classes, &[HEIGHT, WIDTH])?))
    }
}
