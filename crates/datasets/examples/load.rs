//! Measures the images per second of the loader, decoded and augmented; one side of `benches/loader.py`.
//!
//! `load FOLDER [--crop resized|iou|none] [--hue RAD] [--threads N] [--batch N] [--epochs N]`: JPEGs of
//! `FOLDER/images/*/` with YOLO labels in `FOLDER/object_detection/labels/*/`. Prints the images per second of each
//! epoch after the first.

use std::path::{Path, PathBuf};
use std::time::Instant;

use opendr_datasets::augment::{Colour, Flip, IouCrop, Pipeline, RandomResizedCrop, Resize};
use opendr_datasets::loader::{ImageBatches, Loader, LoaderOptions};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{BoundingBox, BoundingBoxList};
use opendr_engine::{Error, Result, ResultExt};
use opendr_vision::Preprocess;

/// Side of the images in a batch, in pixels.
const SIDE: usize = 416;

/// Images with the text of their labels.
struct Pictures(Vec<(PathBuf, String)>);

impl Pictures {
    fn open(folder: &Path) -> Result<Self> {
        let mut pictures = Vec::new();
        for part in ["train2017", "val2017"] {
            for entry in std::fs::read_dir(folder.join("images").join(part))? {
                let path = entry?.path();
                let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
                let labels = folder.join("object_detection/labels").join(part).join(name + ".txt");
                pictures.push((path, std::fs::read_to_string(labels).unwrap_or_default()));
            }
        }
        pictures.sort();
        Ok(Self(pictures))
    }
}

impl Dataset for Pictures {}

impl DatasetIterator for Pictures {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (path, labels) = &self.0[index];
        let image = opendr_vision::open(path)?;
        let (width, height) = (image.width() as f32, image.height() as f32);
        let boxes = labels.lines().filter_map(|line| {
            let numbers: Vec<f32> = line.split(' ').map(|field| field.parse().unwrap_or_default()).collect();
            let &[class, x, y, w, h] = &numbers[..] else { return None };
            let (left, top) = ((x - w / 2.0) * width, (y - h / 2.0) * height);
            Some(BoundingBox::new(class as i64, left, top, w * width, h * height, 1.0))
        });
        let target = BoundingBoxList::from(boxes.collect::<Vec<_>>());
        Ok(Sample { data: vec![image.into()], target: Some(target.into()) })
    }
}

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let option = |name: &str, default: &str| {
        let place = arguments.iter().position(|argument| argument == name);
        place.and_then(|place| arguments.get(place + 1)).map_or_else(|| default.to_owned(), String::clone)
    };
    let number = |name: &str, default: &str| {
        let text = option(name, default);
        text.parse::<f32>().map_err(|_| Error::invalid_param(format!("{name} {text}: give a number")))
    };
    let folder = arguments.first().ok_or_else(|| Error::invalid_input("no folder; name one"))?;
    let colour = Colour { hue: number("--hue", "0")?, ..Colour::default() };
    let pipeline = match option("--crop", "resized").as_str() {
        "resized" => {
            Pipeline::default().then(RandomResizedCrop { width: SIDE, height: SIDE, ..Default::default() })?
        }
        "iou" => Pipeline::default().then(IouCrop::default())?.then(Resize { width: SIDE, height: SIDE })?,
        _ => Pipeline::default(),
    };
    let pipeline = match option("--crop", "resized").as_str() {
        "none" => pipeline,
        _ => pipeline.sometimes(0.5, Flip::default())?.then(colour)?,
    };
    let options = LoaderOptions {
        batch_size: number("--batch", "32")? as usize,
        threads: number("--threads", "2")? as usize,
        ..LoaderOptions::default()
    };
    let scaling = Preprocess::new(SIDE, SIDE).normalise([0.0; 3], [255.0; 3]);
    let pictures = Pictures::open(Path::new(folder)).context(|| format!("reading {folder}"))?;
    let loader = Loader::new(pictures, options)?.augment(pipeline).collate(ImageBatches::new(scaling));
    for epoch in 0..number("--epochs", "3")? as u64 {
        let (start, mut pictures) = (Instant::now(), 0);
        for batch in loader.epoch(epoch) {
            pictures += std::hint::black_box(batch?.content).len();
        }
        if epoch > 0 {
            println!("{:.1}", pictures as f64 / start.elapsed().as_secs_f64());
        }
    }
    Ok(())
}
