//! Large images in tiles, with the real networks.

use std::collections::BTreeMap;

use opendr::data::{Image, ImageView, Layout, PixelFormat};
use opendr::dataset::{DatasetIterator as _, ExternalDataset};
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::learner::{AnyLearner, Ports};
use opendr::params::ParamMap;
use opendr::target::{BoundingBox, BoundingBoxList, HeatmapValues};
use opendr::{Device, ErrorKind, Random, Value};

use crate::models::Models;

const SIZE: [usize; 2] = [3840, 2160];
/// Longer side of the objects, in pixels.
const LONG: f32 = 24.0;
const OBJECTS: usize = 30;

fn learner(models: &Models, spec: &str, params: &[(&str, f64)]) -> Option<Box<dyn AnyLearner>> {
    let model = models.get(spec)?;
    let name = spec.split('/').next().unwrap();
    let mut learner = opendr::registry().find(name).unwrap().make(&ParamMap::new(), Device::Cpu).unwrap();
    learner.load(&model).unwrap();
    for (name, value) in params {
        let as_float = learner.set(name, (*value).into());
        as_float.or_else(|_| learner.set(name, (*value as i64).into())).unwrap();
    }
    Some(learner)
}

fn boxes(learner: &mut dyn AnyLearner, image: &Image) -> BoundingBoxList {
    match learner.infer(&Ports::one(image)).unwrap().first() {
        Some(Value::BoundingBoxList(boxes)) => boxes.clone(),
        other => panic!("{other:?}"),
    }
}

/// A downscaled part of an image, each pixel the mean of those that it replaces.
fn shrunk(part: ImageView<'_>, scale: f32) -> (Vec<[u8; 3]>, usize) {
    let side = |long: usize| ((long as f32 * scale).round() as usize).max(1);
    let (width, height) = (side(part.width()), side(part.height()));
    let pixel = |at: usize| {
        let range = |at: usize, count: usize, long: usize| {
            at * long / count..((at + 1) * long / count).max(at * long / count + 1)
        };
        let (columns, rows) =
            (range(at % width, width, part.width()), range(at / width, height, part.height()));
        let count = (columns.len() * rows.len()) as u32;
        [0, 1, 2].map(|channel| {
            let sums = rows.clone().flat_map(|y| columns.clone().map(move |x| (x, y)));
            (sums.map(|(x, y)| u32::from(part.sample_u8(x, y, channel))).sum::<u32>() / count) as u8
        })
    };
    ((0..width * height).map(pixel).collect(), width)
}

/// Class and box of an object.
type GroundTruth = Vec<(&'static str, [f32; 4])>;

/// An image, its objects of the wanted classes, and the places of all objects.
struct Scene {
    image: Image,
    ground_truth: GroundTruth,
    parts: Vec<[f32; 4]>,
}

/// Persons and cars of COCO128, 24 pixels long, with some of their surroundings, on a soft ground of 4K.
fn scene(models: &Models) -> Scene {
    let pictures = ExternalDataset::new(models.data("coco128/object_detection"), "yolo");
    let pictures = open(&pictures, &OpenOptions::default(), &Problems::strict()).unwrap();
    let level = |at: usize| {
        let (x, y) = ((at % SIZE[0]) as f32, (at / SIZE[0]) as f32);
        (130.0 + 25.0 * (x / 500.0).sin() + 20.0 * (y / 370.0).cos()) as u8
    };
    let mut samples: Vec<u8> = (0..SIZE[0] * SIZE[1]).flat_map(|at| [level(at); 3]).collect();
    let (mut random, mut ground_truth, mut places) = (Random::new(1), Vec::new(), Vec::<[usize; 2]>::new());
    let mut parts = Vec::new();
    for index in 0..pictures.len() {
        let sample = pictures.get(index).unwrap();
        let (Some(Value::Image(image)), Some(Value::BoundingBoxList(list))) =
            (sample.data.first(), &sample.target)
        else {
            panic!("no boxes")
        };
        let usable = list.boxes.iter().filter_map(|one| {
            let name = ["person", "car"].into_iter().find(|name| list.label(one) == Some(*name))?;
            let (long, short) = (one.width.max(one.height), one.width.min(one.height));
            (long >= 100.0 && short >= 40.0).then_some((name, one))
        });
        // Two per image at most, so that there are many.
        for (name, one) in usable.take(2) {
            if ground_truth.len() == OBJECTS {
                break;
            }
            let long = one.width.max(one.height);
            let scale = LONG / long;
            let cut = |edge: f32, most: usize| edge.clamp(0.0, most as f32) as usize;
            let (left, top) =
                (cut(one.left - 0.4 * long, image.width()), cut(one.top - 0.4 * long, image.height()));
            let right = cut(one.left + one.width + 0.4 * long, image.width());
            let bottom = cut(one.top + one.height + 0.4 * long, image.height());
            let part = image.view().crop(left, top, right - left, bottom - top).unwrap();
            let (pixels, width) = shrunk(part, scale);
            let place = loop {
                let place = [random.below(SIZE[0] - 100), random.below(SIZE[1] - 100)];
                let is_free = |other: &[usize; 2]| (0..2).any(|axis| place[axis].abs_diff(other[axis]) > 90);
                if places.iter().all(is_free) {
                    break place;
                }
            };
            places.push(place);
            let [x, y] = place.map(|at| at as f32);
            parts.push([x, y, x + width as f32, y + (pixels.len() / width) as f32]);
            for (at, pixel) in pixels.iter().enumerate() {
                let at = (place[1] + at / width) * SIZE[0] + place[0] + at % width;
                samples[3 * at..3 * at + 3].copy_from_slice(pixel);
            }
            let x = place[0] as f32 + (one.left - left as f32) * scale;
            let y = place[1] as f32 + (one.top - top as f32) * scale;
            ground_truth.push((name, [x, y, x + one.width * scale, y + one.height * scale]));
        }
    }
    assert_eq!(ground_truth.len(), OBJECTS);
    let image = Image::new(samples, SIZE[0], SIZE[1], PixelFormat::Rgb, Layout::Hwc).unwrap();
    Scene { image, ground_truth, parts }
}

fn overlap(a: [f32; 4], b: [f32; 4]) -> f32 {
    opendr::overlap::box_iou(a.map(f64::from), b.map(f64::from)) as f32
}

fn hits(found: &BoundingBoxList, ground_truth: &GroundTruth) -> usize {
    let is_found = |(name, place): &&(&str, [f32; 4])| {
        let same = |one: &&BoundingBox| found.label(one) == Some(*name);
        found.boxes.iter().filter(same).any(|one| overlap(one.corners(), *place) >= 0.5)
    };
    ground_truth.iter().filter(is_found).count()
}

/// Of the boxes: those on the empty ground, and pairs that are one object predicted twice.
fn mistakes(found: &BoundingBoxList, parts: &[[f32; 4]]) -> [usize; 2] {
    let is_on_ground = |one: &&BoundingBox| {
        let [x0, y0, x1, y1] = one.corners();
        let [x, y] = [(x0 + x1) / 2.0, (y0 + y1) / 2.0];
        !parts.iter().any(|[x0, y0, x1, y1]| (*x0..*x1).contains(&x) && (*y0..*y1).contains(&y))
    };
    let pairs = found.boxes.iter().enumerate().flat_map(|(at, one)| {
        found.boxes[at + 1..]
            .iter()
            .filter(move |other| one.name == other.name && overlap(one.corners(), other.corners()) > 0.5)
    });
    [found.boxes.iter().filter(is_on_ground).count(), pairs.count()]
}

#[test]
fn things_of_24_pixels_are_found_in_4k() {
    let Some(models) = Models::find() else { return };
    let Scene { image, ground_truth, parts } = scene(&models);
    for variant in ["nanodet/coco_416", "centernet/coco_512"] {
        let name = variant.split('/').next().unwrap();
        let Some(mut plain) = learner(&models, variant, &[]) else { return };
        let Some(mut tiled) = learner(&models, &format!("tiled_detection/{name}"), &[]) else { return };
        let (without, with) = (boxes(&mut *plain, &image), boxes(&mut *tiled, &image));
        let (without, hit) = (hits(&without, &ground_truth), hits(&with, &ground_truth));
        // Other objects around an object in its image may be detected too.
        let [on_ground, twice] = mistakes(&with, &parts);
        let count = with.boxes.len();
        println!(
            "{name}: {hit} of {OBJECTS} in tiles, {without} without; {count} boxes, {on_ground} of nothing, {twice} twice"
        );
        assert!(
            hit >= 2 * without && hit * 3 >= OBJECTS,
            "{name}: {hit} of {OBJECTS}, {without} without tiles"
        );
        assert!(
            on_ground <= 3 && twice == 0,
            "{name}: {on_ground} boxes of nothing, {twice} predicted twice"
        );
    }
}

/// With a budget (here one that nothing exceeds), parts of tiles that have something in them are processed side by side.
#[test]
fn parts_side_by_side_show_nearly_as_much() {
    let Some(models) = Models::find() else { return };
    let Scene { image, ground_truth, parts } = scene(&models);
    let wishes = [("rotation", 0.0), ("time_budget", 60_000.0)];
    let Some(mut whole) = learner(&models, "tiled_detection", &wishes[..1]) else { return };
    let Some(mut packed) = learner(&models, "tiled_detection", &wishes) else { return };
    let (all, found) = (boxes(&mut *whole, &image), boxes(&mut *packed, &image));
    let [wanted, hit] = [&all, &found].map(|found| hits(found, &ground_truth));
    let [on_ground, twice] = mistakes(&found, &parts);
    println!("{hit} of {OBJECTS} in parts, {wanted} in tiles; {on_ground} of nothing, {twice} twice");
    assert!(3 * hit >= 2 * wanted && on_ground <= 3 && twice == 0, "{hit} of {wanted}, {on_ground}, {twice}");
    // A static scene keeps its predictions; an empty one keeps none.
    assert_eq!(boxes(&mut *packed, &image), found);
    let ground = Image::from_rgb8(vec![130; SIZE[0] * SIZE[1] * 3], SIZE[0], SIZE[1]).unwrap();
    assert!(boxes(&mut *packed, &ground).boxes.is_empty());
}

/// With few tiles per frame, objects are detected over several frames and then kept.
#[test]
fn a_few_tiles_at_a_time_find_the_same_in_the_end() {
    let Some(models) = Models::find() else { return };
    let Scene { image, ground_truth, .. } = scene(&models);
    let Some(mut at_once) = learner(&models, "tiled_detection", &[("rotation", 0.0)]) else { return };
    let Some(mut slowly) = learner(&models, "tiled_detection", &[("rotation", 0.0), ("max_tiles", 8.0)])
    else {
        return;
    };
    let wanted = boxes(&mut *at_once, &image);
    let mut counts = Vec::new();
    for _ in 0..20 {
        let found = boxes(&mut *slowly, &image);
        counts.push(hits(&found, &ground_truth));
        if found == wanted {
            break;
        }
    }
    assert!(counts.len() > 2 && counts.is_sorted(), "{counts:?}");
    assert_eq!(boxes(&mut *slowly, &image), wanted, "{counts:?}");
    // Objects that disappear are dropped.
    let ground = Image::from_rgb8(vec![130; SIZE[0] * SIZE[1] * 3], SIZE[0], SIZE[1]).unwrap();
    (0..12).for_each(|_| drop(boxes(&mut *slowly, &ground)));
    assert!(boxes(&mut *slowly, &ground).boxes.is_empty());
}

#[test]
fn a_small_picture_is_no_other_than_without_tiles() {
    let Some(models) = Models::find() else { return };
    let photo = opendr::vision::open(models.data("photos/bus.jpg")).unwrap();
    let Some(mut plain) = learner(&models, "nanodet", &[("threshold", 0.35)]) else { return };
    let Some(mut tiled) = learner(&models, "tiled_detection", &[("tile", 1100.0), ("iou_threshold", 0.6)])
    else {
        return;
    };
    let (plain, tiled) = (boxes(&mut *plain, &photo), boxes(&mut *tiled, &photo));
    assert_eq!(plain.boxes.len(), tiled.boxes.len());
    for one in &plain.boxes {
        assert!(tiled.boxes.iter().any(|other| overlap(one.corners(), other.corners()) > 0.99), "{one:?}");
    }
}

/// A bus and its passengers are larger than tiles: no piece of them is detected as another object.
#[test]
fn what_borders_cut_is_one() {
    let Some(models) = Models::find() else { return };
    let photo = opendr::vision::open(models.data("photos/bus.jpg")).unwrap();
    let Some(mut tiled) = learner(&models, "tiled_detection", &[("tile", 400.0), ("tile_overlap", 120.0)])
    else {
        return;
    };
    let found = boxes(&mut *tiled, &photo);
    let mut counts = BTreeMap::new();
    found.boxes.iter().for_each(|one| *counts.entry(found.label(one).unwrap()).or_insert(0) += 1);
    assert_eq!(counts.get("bus"), Some(&1), "{counts:?}");
    assert!((3..=6).contains(counts.get("person").unwrap_or(&0)), "{counts:?}");
}

#[test]
fn a_part_of_another_kind_is_refused() {
    let Some(models) = Models::find() else { return };
    let Some(model) = models.get("fair_mot") else { return };
    // The detector that it carries is welcome, but it is another learner's container.
    let entry = opendr::registry().find("tiled_detection").unwrap();
    let mut learner = entry.make(&ParamMap::new(), Device::Cpu).unwrap();
    assert_eq!(learner.load(&model).unwrap_err().kind(), ErrorKind::InvalidInput);
}

/// Four birds in an image of twice the size: each has in a tile the size that the network is trained on.
#[test]
fn classes_of_pixels_come_from_the_finest_look() {
    let Some(models) = Models::find() else { return };
    let sample = |part: &str| {
        let path = models
            .data("../models")
            .join(format!("semantic_segmentation/sample/bird_segmentation{part}.bmp"));
        opendr::vision::open(path).unwrap()
    };
    let (bird, mask) = (sample(""), sample("_mask").hwc_u8(PixelFormat::Grey));
    let (width, height) = (bird.width(), bird.height());
    let place = |at: usize| (at / (2 * width) % height) * width + at % (2 * width) % width;
    let view = bird.view();
    let samples = (0..4 * width * height).flat_map(|at| {
        let at = place(at);
        [0, 1, 2].map(|channel| view.sample_u8(at % width, at / width, channel))
    });
    let four = Image::from_rgb8(samples.collect(), 2 * width, 2 * height).unwrap();
    let side = width.max(height) as f64;
    let Some(mut plain) = learner(&models, "deeplab", &[]) else { return };
    let Some(mut tiled) =
        learner(&models, "tiled_segmentation/pascal", &[("tile", side), ("tile_overlap", 0.0)])
    else {
        return;
    };
    let score = |learner: &mut dyn AnyLearner| {
        let answer = learner.infer(&Ports::one(&four)).unwrap();
        let Some(Value::Heatmap(map)) = answer.first() else { panic!("{answer:?}") };
        assert_eq!(map.shape(), [2 * height, 2 * width]);
        let HeatmapValues::Labels(labels) = map.values() else { panic!("no classes") };
        let (mut both, mut any) = (0u32, 0u32);
        for (at, label) in labels.iter().enumerate() {
            let (found, there) = (*label == 3, mask[place(at)] == 3);
            both += u32::from(found && there);
            any += u32::from(found || there);
        }
        f64::from(both) / f64::from(any)
    };
    let (without, with) = (score(&mut *plain), score(&mut *tiled));
    println!("birds {width}x{height}: {with:.3} in tiles, {without:.3} without");
    assert!(with > 0.85 && with > without, "{with} in tiles, {without} without");
}
