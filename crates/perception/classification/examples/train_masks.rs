//! Trains a classifier of faces with and without mask, and measures it.
//!
//! The masks are synthetic: drawn over the faces that YuNet detects in COCO's first 128 images for training, and over those in
//! another folder of images for testing; half of the faces have no mask, some of these have dark glasses. The example produces
//! the zoo's `image_classifier/masked_face`, a part of `yunet/masked`:
//!
//! ```console
//! $ cargo run --release -p opendr-classification --features training --example train_masks -- shared/data/coco128/images YUNET \
//!       shared/data/face_verification out
//! ```
//!
//! YUNET is a container of YuNet.

use std::path::{Path, PathBuf};

use opendr_classification::image_classification::{
    ImageClassifier, ImageClassifierFitParams, ImageClassifierParams,
};
use opendr_engine::data::{Image, Layout};
use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::learner::{FitJob, Handle};
use opendr_engine::target::{BoundingBox, Category, Classes};
use opendr_engine::{Device, Error, Random, Result, ResultExt, Value};
use opendr_face_detection::face_detection::{Yunet, YunetParams, mask_crop};
use opendr_vision::Preprocess;

/// Side of the training images in pixels.
const SIDE: usize = 40;
/// Versions of a face, half of them with masks.
const VERSIONS: usize = 80;
/// Minimum side of a face in pixels.
const SMALLEST: f32 = 20.0;
/// Side of the region around a face in which a mask is drawn, in longer sides of its box.
const AROUND: f32 = 3.0;
const CLASSES: [&str; 2] = ["face", "masked face"];

fn main() -> Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [pictures, detector, others, output] = &arguments[..] else {
        return Err(Error::invalid_param(
            "usage: train_masks TRAINING_IMAGES YUNET TEST_IMAGES OUTPUT_FOLDER",
        ));
    };
    let mut finder =
        Handle::<Yunet>::new(YunetParams { threshold: 0.5, ..YunetParams::default() }, Device::Cpu)?;
    finder.load(Path::new(detector))?;
    let training = Crops::of(&mut finder, Path::new(pictures), VERSIONS, 1)?;
    let test = Crops::of(&mut finder, Path::new(others), 2, 2)?;
    println!("{} crops for training, {} for testing", training.len(), test.len());
    let mut learner = Handle::<ImageClassifier>::new(ImageClassifierParams::default(), Device::Cpu)?;
    let mut params =
        ImageClassifierFitParams { side: SIDE, width: 24, crop: 0.8, dropout: 0.3, ..Default::default() };
    params.training.epochs = 20;
    params.training.num_workers = 1;
    let job = FitJob { device: Device::Cpu, ..FitJob::new(Path::new(output)) };
    println!("{}", learner.fit(&params, (&training as &dyn DatasetIterator).into(), None, &job)?);
    for (what, crops) in [("training", &training), ("others", &test)] {
        let mut counts = [[0_usize; 2]; 2];
        for (image, class) in &crops.0 {
            counts[*class][learner.infer(image)?.class as usize] += 1;
        }
        println!(
            "{what}: confusion matrix, rows ground truth, columns predictions, without and with mask: {counts:?}"
        );
    }
    Ok(())
}

/// Crops of faces, and whether they have a mask.
struct Crops(Vec<(Image, usize)>);

impl Crops {
    /// Returns versions of all faces in the images of a folder; faces that are not detected again after drawing are skipped.
    fn of(finder: &mut Handle<Yunet>, folder: &Path, versions: usize, seed: u64) -> Result<Self> {
        let mut random = Random::new(seed);
        let mut crops = Vec::new();
        for path in pictures_in(folder)? {
            let picture = opendr_vision::open(&path)?;
            for face in finder.infer(&picture)?.boxes {
                if face.width.min(face.height) < SMALLEST || face.landmarks.len() != 5 {
                    continue;
                }
                for version in 0..versions {
                    let class = version % 2;
                    let (mut region, points) = region(&picture, &face)?;
                    if class == 1 {
                        draw_mask(&mut region, &points, &mut random);
                    } else if random.chance(0.3) && versions > 2 {
                        draw_glasses(&mut region, &points, &mut random);
                    }
                    let middle = [points[2].x, points[2].y];
                    let again = finder.infer(&region)?.boxes;
                    let apart = |face: &BoundingBox| {
                        let [x, y] = [face.left + face.width / 2.0, face.top + face.height / 2.0];
                        (x - middle[0]).hypot(y - middle[1]) / face.width.max(1.0)
                    };
                    let Some(mut found) = again
                        .into_iter()
                        .filter(|found| found.landmarks.len() == 5 && apart(found) < 0.4)
                        .min_by(|one, other| apart(one).total_cmp(&apart(other)))
                    else {
                        continue;
                    };
                    if versions > 2 {
                        let by = 0.06 * found.width;
                        found.left += by * random.normal() as f32;
                        found.top += by * random.normal() as f32;
                        found.width *= random.uniform(0.88, 1.12);
                    }
                    let crop = mask_crop(&found, SIDE);
                    let mut crop = cut(&region, &crop, SIDE)?;
                    if versions > 2 {
                        relight(&mut crop, &mut random);
                    }
                    crops.push((crop, class));
                }
            }
        }
        Ok(Self(crops))
    }
}

impl Dataset for Crops {}

impl DatasetIterator for Crops {
    fn len(&self) -> usize {
        self.0.len()
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (image, class) =
            self.0.get(index).ok_or_else(|| Error::not_found(format!("there is no crop {index}")))?;
        let target = Category { class: *class as i64, ..Category::default() };
        Ok(Sample { data: vec![Value::Image(image.clone())], target: Some(target.into()) })
    }

    fn classes(&self) -> Classes {
        CLASSES.into_iter().collect()
    }
}

fn pictures_in(folder: &Path) -> Result<Vec<PathBuf>> {
    let mut paths = Vec::new();
    for entry in std::fs::read_dir(folder).context(|| folder.display().to_string())? {
        let path = entry?.path();
        if path.is_dir() {
            paths.extend(pictures_in(&path)?);
        } else if path.extension().is_some_and(|end| end == "jpg" || end == "png") {
            paths.push(path);
        }
    }
    paths.sort();
    Ok(paths)
}

#[derive(Clone, Copy)]
struct Point {
    x: f32,
    y: f32,
}

fn cut(picture: &Image, crop: &opendr_vision::Similarity, side: usize) -> Result<Image> {
    let mut levels = vec![0_u8; 3 * side * side];
    Preprocess::new(side, side).layout(Layout::Hwc).warp_into(picture.view(), crop, &mut levels[..])?;
    Image::from_rgb8(levels, side, side)
}

/// Returns a face with its surroundings, and its landmarks there.
fn region(picture: &Image, face: &BoundingBox) -> Result<(Image, [Point; 5])> {
    let centre = [face.left + face.width / 2.0, face.top + face.height / 2.0];
    let extent = AROUND * face.width.max(face.height);
    let side = (extent as usize).clamp(96, 480);
    let crop = opendr_vision::Similarity::rotated_square(centre, extent, 0.0, side);
    let points = [0, 1, 2, 3, 4].map(|at| {
        let [x, y] = crop.crop_from_image(face.landmarks[at]);
        Point { x, y }
    });
    Ok((cut(picture, &crop, side)?, points))
}

/// Draws `colour`, a function of the position along and across the face and of the pixel, wherever it returns one; the unit is
/// the distance of the eyes, the origin the nose.
fn draw(
    image: &mut Image,
    [right, left, nose, ..]: &[Point; 5],
    colour: impl Fn(f32, f32, [u8; 3]) -> Option<[f32; 3]>,
) {
    let side = image.width();
    let (ux, uy) = (left.x - right.x, left.y - right.y);
    let distance = ux.hypot(uy).max(1.0);
    let (ux, uy) = (ux / distance, uy / distance);
    let Some(levels) = image.bytes_mut() else { return };
    for (at, pixel) in levels.chunks_exact_mut(3).enumerate() {
        let (x, y) = ((at % side) as f32 - nose.x, (at / side) as f32 - nose.y);
        let (across, down) = ((ux * x + uy * y) / distance, (ux * y - uy * x) / distance);
        if let Some(colour) = colour(across, down, [pixel[0], pixel[1], pixel[2]]) {
            for (level, colour) in pixel.iter_mut().zip(colour) {
                *level = colour.clamp(0.0, 255.0) as u8;
            }
        }
    }
}

/// Returns the colour of a cloth.
fn cloth(random: &mut Random) -> [f32; 3] {
    match random.below(6) {
        0 => [225.0, 228.0, 232.0],
        1 => [150.0, 195.0, 225.0],
        2 => [35.0, 35.0, 40.0],
        3 => [120.0, 170.0, 150.0],
        _ => [0; 3].map(|_| random.uniform(20.0, 235.0)),
    }
}

fn draw_mask(image: &mut Image, points: &[Point; 5], random: &mut Random) {
    let colour = cloth(random);
    // Position of the mouth relative to the nose, in distances of the eyes.
    let (top, chin) = (random.uniform(-0.35, -0.05), random.uniform(1.1, 1.45));
    let (wide, narrow) = (random.uniform(0.75, 1.0), random.uniform(0.35, 0.6));
    let (pleats, phase) = (random.uniform(0.0, 0.12), random.uniform(0.0, 6.0));
    let (lit, arch) = (random.uniform(0.2, 0.7), random.uniform(0.0, 0.25));
    let (thread, rise) = (random.uniform(0.02, 0.06), random.uniform(0.1, 0.4));
    let has_threads = random.chance(0.8);
    draw(image, points, |across, down, there| {
        let light = there.iter().map(|level| f32::from(*level)).sum::<f32>() / 3.0 / 140.0;
        let begin = top + arch * across * across;
        let share = ((down - begin) / (chin - begin)).clamp(0.0, 1.0);
        // Straight at the cheeks, round at the chin.
        let half = wide + (narrow - wide) * (2.0 * share - 1.0).max(0.0).powi(2);
        let is_mask = down > begin && down < chin - 0.3 * across * across && across.abs() < half;
        let on_thread = |end: f32| (down - end - (wide - across.abs()) * rise).abs() < thread;
        let is_thread = has_threads
            && (wide..wide + 0.5).contains(&across.abs())
            && (on_thread(begin + 0.1) || on_thread(chin * 0.6));
        let fold = 1.0 + pleats * (18.0 * down + phase).sin();
        let shade = (1.0 - lit) + lit * light;
        (is_mask || is_thread).then(|| colour.map(|level| level * fold * shade))
    });
}

/// Changes illumination and colours at random.
fn relight(image: &mut Image, random: &mut Random) {
    let (power, gain) = (random.uniform(-0.7, 0.7).exp(), random.uniform(0.6, 1.3));
    let tint = [0; 3].map(|_| random.uniform(0.85, 1.15));
    // From no saturation to a higher one.
    let (colour, grain) = (random.uniform(0.0, 1.4), random.uniform(0.0, 12.0));
    let Some(levels) = image.bytes_mut() else { return };
    for pixel in levels.chunks_exact_mut(3) {
        let grey = pixel.iter().map(|level| f32::from(*level)).sum::<f32>() / 3.0;
        for (level, tint) in pixel.iter_mut().zip(tint) {
            let own = (grey + colour * (f32::from(*level) - grey)).clamp(0.0, 255.0) / 255.0;
            let lit = 255.0 * own.powf(power) * gain * tint + grain * random.normal() as f32;
            *level = lit.clamp(0.0, 255.0) as u8;
        }
    }
}

fn draw_glasses(image: &mut Image, points: &[Point; 5], random: &mut Random) {
    let colour = cloth(random);
    let (tall, wide, high) =
        (random.uniform(0.18, 0.32), random.uniform(0.28, 0.45), random.uniform(0.45, 0.65));
    draw(image, points, |across, down, _| {
        let (x, y) = ((across.abs() - 0.5) / wide, (down + high) / tall);
        let bridge = across.abs() < 0.3 && (down + high).abs() < 0.05;
        (x.powi(4) + y.powi(4) < 1.0 || bridge).then_some(colour)
    });
}
