//! Predicts class and instance of every pixel, and draws the instances. Input: street.jpg, any photograph.

use std::collections::BTreeMap;

use opendr::learner::Handle;
use opendr::panoptic_segmentation::{EfficientPs, EfficientPsParams, EfficientPsTargets};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut segmenter = Handle::<EfficientPs>::new(EfficientPsParams::default(), Device::Auto)?;
    segmenter.load(opendr::download("efficient_ps")?)?;
    let mut image = vision::open("street.jpg")?;
    let EfficientPsTargets { instance, semantic } = segmenter.infer(&image)?;
    let (instances, _) = instance.class_labels()?;
    let (classes, _) = semantic.class_labels()?;
    let mut found = BTreeMap::new();
    for (index, class) in instances.iter().zip(classes.iter()) {
        found.entry(*index).or_insert((*class, 0)).1 += 1;
    }
    for (index, (class, pixels)) in found {
        // A number where no class is certain.
        let name = semantic
            .classes
            .name(i64::from(class))
            .map_or_else(|| class.to_string(), |name| name.to_string());
        println!("instance {index}: {name}, {pixels} pixels");
    }
    draw(&mut image, &instance, &Style::default());
    vision::save(&image, "panoptic.png")
}
