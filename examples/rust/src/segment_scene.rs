//! Predicts the class of every pixel. Input: street.jpg, any photograph.

use std::collections::BTreeMap;

use opendr::learner::Handle;
use opendr::semantic_segmentation::{Deeplab, DeeplabParams};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut segmenter = Handle::<Deeplab>::new(DeeplabParams::default(), Device::Auto)?;
    segmenter.load(opendr::download("deeplab")?)?;
    let mut image = vision::open("street.jpg")?;
    let classes = segmenter.infer(&image)?;
    let (labels, _) = classes.class_labels()?;
    let mut pixels = BTreeMap::new();
    labels.iter().for_each(|label| *pixels.entry(*label).or_insert(0) += 1);
    for (label, count) in pixels {
        let share = 100.0 * f64::from(count) / labels.len() as f64;
        let name = classes.classes.name(i64::from(label)).map_or("", |name| name);
        println!("{name}: {share:.1} % of the image");
    }
    draw(&mut image, &classes, &Style::default());
    vision::save(&image, "segment_scene.png")
}
