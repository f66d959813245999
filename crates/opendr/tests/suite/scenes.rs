//! Learners of whole images with real weights: classification, segmentation, grasps.

use std::path::PathBuf;

use opendr::data::{Image, Layout, PixelFormat};
use opendr::dataset::{DatasetIterator as _, ExternalDataset};
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::learner::{AnyLearner, Ports};
use opendr::params::ParamMap;
use opendr::target::{BoundingBox, HeatmapValues};
use opendr::{Device, Value, vision};

use crate::models::Models;

fn learner(models: &Models, spec: &str) -> Option<Box<dyn AnyLearner>> {
    let model = models.get(spec)?;
    let name = spec.split('/').next().unwrap();
    let mut learner = opendr::registry().find(name).unwrap().make(&ParamMap::new(), Device::Cpu).unwrap();
    learner.load(&model).unwrap();
    Some(learner)
}

fn of_models(models: &Models, name: &str) -> PathBuf {
    models.data("../models").join(name)
}

#[test]
fn photographs_are_classified() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = learner(&models, "image_classifier/mobilenet_v2") else { return };
    let cases = [
        (of_models(&models, "classification/cat.bmp"), "Egyptian cat"),
        (of_models(&models, "classification/grace_hopper.bmp"), "military uniform"),
        (models.data("photos/coffee.png"), "espresso"),
    ];
    for (path, wanted) in cases {
        let answer = learner.infer(&Ports::one(&vision::open(&path).unwrap())).unwrap();
        let Some(Value::Category(category)) = answer.first() else { panic!("{answer:?}") };
        assert_eq!(category.description.as_deref(), Some(wanted), "{}", path.display());
        assert!((category.probabilities.iter().sum::<f32>() - 1.0).abs() < 0.05);
    }
}

#[test]
fn persons_wake_it() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = learner(&models, "image_classifier/visual_wake_word") else { return };
    let pictures = ExternalDataset::new(models.data("coco128/object_detection"), "yolo");
    let pictures = open(&pictures, &OpenOptions::default(), &Problems::strict()).unwrap();
    let (mut right, count) = (0, pictures.len());
    for index in 0..count {
        let sample = pictures.get(index).unwrap();
        let (Some(Value::Image(image)), Some(Value::BoundingBoxList(boxes))) =
            (sample.data.first(), &sample.target)
        else {
            panic!("no boxes")
        };
        let pixels = (image.width() * image.height()) as f32;
        let is_person = |one: &&BoundingBox| boxes.label(one) == Some("person");
        // As in the data that it was trained on, persons count from half a percent of the image on.
        let wanted = boxes.boxes.iter().filter(is_person).any(|one| one.area() > 0.005 * pixels);
        let answer = learner.infer(&Ports::one(image)).unwrap();
        let Some(Value::Category(category)) = answer.first() else { panic!("{answer:?}") };
        right += u32::from((category.class == 1) == wanted);
    }
    assert!(f64::from(right) >= 0.72 * count as f64, "{right} of {count}");
}

/// Intersection over union of each class in the mask.
fn overlaps(models: &Models, spec: &str, sample: &str) -> Option<Vec<(u8, f64)>> {
    let mut learner = learner(models, spec)?;
    let path = |part: &str| {
        of_models(models, &format!("semantic_segmentation/sample/{sample}_segmentation{part}.bmp"))
    };
    let image = vision::open(path("")).unwrap();
    let mask = vision::open(path("_mask")).unwrap().hwc_u8(PixelFormat::Grey);
    let answer = learner.infer(&Ports::one(&image)).unwrap();
    let Some(Value::Heatmap(map)) = answer.first() else { panic!("{answer:?}") };
    assert_eq!(map.shape(), [image.height(), image.width()]);
    let HeatmapValues::Labels(labels) = map.values() else { panic!("no classes") };
    let mut classes = mask.clone();
    classes.sort_unstable();
    classes.dedup();
    let overlap = |class: u8| {
        let (mut both, mut any) = (0u32, 0u32);
        for (found, there) in labels.iter().zip(&mask) {
            let (found, there) = (*found == u32::from(class), *there == class);
            both += u32::from(found && there);
            any += u32::from(found || there);
        }
        (class, f64::from(both) / f64::from(any))
    };
    Some(classes.into_iter().map(overlap).collect())
}

#[test]
fn the_bird_lies_where_it_is() {
    let Some(models) = Models::find() else { return };
    for (spec, least) in [("deeplab", 0.90), ("deeplab/pascal_slim", 0.80)] {
        let Some(overlaps) = overlaps(&models, spec, "bird") else { return };
        let bird = overlaps.iter().find(|(class, _)| *class == 3).unwrap().1;
        assert!(bird >= least, "{spec}: {bird}");
    }
}

#[test]
fn the_street_is_segmented() {
    let Some(models) = Models::find() else { return };
    let Some(overlaps) = overlaps(&models, "deeplab/cityscapes", "cityscapes") else { return };
    let mean = overlaps.iter().map(|(_, overlap)| overlap).sum::<f64>() / overlaps.len() as f64;
    assert!(mean >= 0.70, "{mean}: {overlaps:?}");
}

/// A grey table one metre below, with a bar that lies 5 cm higher, turned by `angle`.
fn bar(angle: f32) -> (Image, Image) {
    let (sine, cosine) = angle.sin_cos();
    let on_bar = |at: usize| {
        let (x, y) = ((at % 480) as f32 - 240.0, (at / 480) as f32 - 240.0);
        (x * cosine + y * sine).abs() < 110.0 && (y * cosine - x * sine).abs() < 18.0
    };
    let colour = (0..480 * 480).flat_map(|at| if on_bar(at) { [40, 60, 160] } else { [190, 190, 190] });
    let depth: Vec<f32> = (0..480 * 480).map(|at| if on_bar(at) { 0.65 } else { 0.70 }).collect();
    let image = Image::new(colour.collect::<Vec<u8>>(), 480, 480, PixelFormat::Rgb, Layout::Hwc).unwrap();
    (image, Image::new(depth, 480, 480, PixelFormat::Grey, Layout::Hwc).unwrap())
}

#[test]
fn bars_are_grasped_across() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = learner(&models, "gr_conv_net") else { return };
    for degrees in [0, 30, 60, 90, 120, 150] {
        let angle = (degrees as f32).to_radians();
        let (image, depth) = bar(angle);
        let ports = Ports::default().with("image", &image).with("depth", &depth);
        let answer = learner.infer(&ports).unwrap();
        let Some(Value::PoseList(grasps)) = answer.first() else { panic!("{answer:?}") };
        let best = grasps.poses.first().unwrap_or_else(|| panic!("no grasp at {degrees} degrees"));
        let [one, other] = [&best.keypoints[0], &best.keypoints[1]];
        let [x, y] = [(one.x + other.x) / 2.0 - 240.0, (one.y + other.y) / 2.0 - 240.0];
        let (sine, cosine) = angle.sin_cos();
        assert!((x * cosine + y * sine).abs() < 120.0 && (y * cosine - x * sine).abs() < 25.0, "{best:?}");
        let along = (other.x - one.x) * cosine + (other.y - one.y) * sine;
        let across = (other.y - one.y) * cosine - (other.x - one.x) * sine;
        let off = along.abs().atan2(across.abs()).to_degrees();
        assert!(off < 25.0, "{degrees} degrees: {off} off");
    }
}

#[test]
fn depth_is_of_the_picture() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = learner(&models, "gr_conv_net") else { return };
    let (image, depth) = bar(0.0);
    let small = vision::resize(&image, 100, 100).unwrap();
    let refused = |image: &Image, depth: &Image| {
        let ports = Ports::default().with("image", image).with("depth", depth);
        learner.infer(&ports).unwrap_err().to_string()
    };
    let mut refused = refused;
    assert!(refused(&small, &depth).contains("the same size"));
    assert!(refused(&image, &image).contains("millimetres"));
}
