//! Person segmentation with real weights.

use opendr::data::Image;
use opendr::dataset::{DatasetIterator as _, ExternalDataset};
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::learner::{AnyLearner, Ports};
use opendr::params::ParamMap;
use opendr::target::{BoundingBox, BoundingBoxList, HeatmapValues, Segmentation};
use opendr::{Device, Value};

use crate::models::Models;

fn bodypix(models: &Models) -> Option<Box<dyn AnyLearner>> {
    let model = models.get("bodypix")?;
    let mut learner =
        opendr::registry().find("bodypix").unwrap().make(&ParamMap::new(), Device::Cpu).unwrap();
    learner.load(&model).unwrap();
    Some(learner)
}

fn persons(learner: &mut dyn AnyLearner, image: &Image) -> BoundingBoxList {
    let answer = learner.infer(&Ports::one(image)).unwrap();
    let Some(Value::BoundingBoxList(list)) = answer.first() else { panic!("{answer:?}") };
    list.clone()
}

fn mask(found: &BoundingBox) -> Vec<bool> {
    match &found.segment.as_ref().unwrap().segmentation {
        Segmentation::Rle(rle) => rle.mask().unwrap(),
        other => panic!("{other:?}"),
    }
}

fn picture(models: &Models, name: &str) -> Image {
    opendr::vision::open(models.data("photos").join(name)).unwrap()
}

#[test]
fn persons_before_the_bus() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = bodypix(&models) else { return };
    for (name, least, most, share) in [("bus.jpg", 3, 4, 0.10..0.15), ("zidane.jpg", 2, 3, 0.4..0.6)] {
        let image = picture(&models, name);
        let found = persons(&mut *learner, &image);
        let masks: Vec<_> = found.boxes.iter().map(mask).collect();
        let count = |at: usize| masks.iter().filter(|mask| mask[at]).count();
        let pixels = image.width() * image.height();
        assert!((0..pixels).all(|at| count(at) <= 1), "{name}: a pixel of two persons");
        let here = (0..pixels).map(count).sum::<usize>() as f64 / pixels as f64;
        println!("{name}: {here:.3} of the image, {found:#}");
        assert!(share.contains(&here), "{name}: {here}");
        assert!((least..=most).contains(&found.boxes.len()), "{name}: {found:#}");
    }
}

#[test]
fn there_is_nobody_in_a_cup_and_in_the_dark() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = bodypix(&models) else { return };
    let black = Image::from_rgb8(vec![0; 320 * 240 * 3], 320, 240).unwrap();
    for image in [picture(&models, "coffee.png"), black] {
        let found = persons(&mut *learner, &image);
        assert!(found.boxes.is_empty(), "{found:#}");
    }
}

/// The persons in COCO's pictures that cover 3 % of them at least.
#[test]
fn persons_of_coco_are_found() {
    let Some(models) = Models::find() else { return };
    let Some(mut learner) = bodypix(&models) else { return };
    let pictures = ExternalDataset::new(models.data("coco128/panoptic_segmentation"), "coco_panoptic");
    let pictures = open(&pictures, &OpenOptions::default(), &Problems::strict()).unwrap();
    let (mut found, mut there, mut both, mut any) = (0, 0, 0_u64, 0_u64);
    for index in 0..pictures.len() {
        let sample = pictures.get(index).unwrap();
        let (Some(Value::Image(image)), Some(Value::BoundingBoxList(ground_truth))) =
            (sample.data.first(), &sample.target)
        else {
            panic!("no masks")
        };
        let is_person = |one: &&BoundingBox| ground_truth.label(one) == Some("person");
        let wanted: Vec<_> = ground_truth.boxes.iter().filter(is_person).map(mask).collect();
        let pixels = image.width() * image.height();
        if wanted.iter().flatten().filter(|pixel| **pixel).count() * 100 < pixels {
            continue;
        }
        let answers: Vec<_> = persons(&mut *learner, image).boxes.iter().map(mask).collect();
        for at in 0..pixels {
            let (one, other) = (wanted.iter().any(|mask| mask[at]), answers.iter().any(|mask| mask[at]));
            both += u64::from(one && other);
            any += u64::from(one || other);
        }
        for person in &wanted {
            if person.iter().filter(|pixel| **pixel).count() * 100 < 3 * pixels {
                continue;
            }
            there += 1;
            found += u32::from(answers.iter().any(|answer| {
                let pairs = || person.iter().zip(answer);
                let shared = pairs().filter(|(one, other)| **one && **other).count();
                2 * shared > pairs().filter(|(one, other)| **one || **other).count()
            }));
        }
    }
    let overlap = both as f64 / any as f64;
    println!("{found} of {there} persons with an IoU above 0.5; IoU of all their pixels {overlap:.3}");
    assert!(overlap >= 0.65 && 2 * found >= there, "{overlap} {found}/{there}");
}

/// MediaPipe 0.10.9's own runs of the two networks return 0.545 and 0.551 of the image; both count the helmet in front of
/// her, which DeepLab does not.
#[test]
fn the_astronaut_is_segmented_from_the_background() {
    let Some(models) = Models::find() else { return };
    let Some(deeplab) = labels(&models, "deeplab", "astronaut.png") else { return };
    for (spec, wanted) in [("selfie_segmentation", 0.545), ("selfie_segmentation/landscape", 0.551)] {
        let Some(labels) = labels(&models, spec, "astronaut.png") else { return };
        let share = labels.iter().filter(|label| **label == 1).count() as f64 / labels.len() as f64;
        // Pascal's person is class 15.
        let persons = deeplab.iter().zip(&labels).filter(|(label, _)| **label == 15);
        let (all, found) =
            persons.fold((0.0, 0.0), |(all, found), (_, label)| (all + 1.0, found + f64::from(*label)));
        println!("{spec}: {share:.4} of the image, {:.4} of DeepLab's person", found / all);
        assert!((share - wanted).abs() < 0.01 && found / all > 0.95, "{spec}: {share} {}", found / all);
    }
}

fn labels(models: &Models, spec: &str, name: &str) -> Option<Vec<u32>> {
    let model = models.get(spec)?;
    let entry = opendr::registry().find(spec.split('/').next().unwrap()).unwrap();
    let mut learner = entry.make(&ParamMap::new(), Device::Cpu).unwrap();
    learner.load(&model).unwrap();
    let image = picture(models, name);
    let answer = learner.infer(&Ports::one(&image)).unwrap();
    let Some(Value::Heatmap(map)) = answer.first() else { panic!("{answer:?}") };
    assert_eq!(map.shape(), [image.height(), image.width()]);
    match map.values() {
        HeatmapValues::Labels(labels) => Some(labels.to_vec()),
        HeatmapValues::Scores(_) => panic!("no labels"),
    }
}
