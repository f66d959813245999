//! Detects only persons, with a higher threshold than the default. Input: street.jpg, any photograph.

use opendr::learner::Handle;
use opendr::object_detection_2d::{Yolox, YoloxParams};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let params = YoloxParams { threshold: 0.5, ..YoloxParams::default() };
    let mut detector = Handle::<Yolox>::new(params, Device::Auto)?;
    detector.load(opendr::download("yolox")?)?;
    let mut image = vision::open("street.jpg")?;
    let mut boxes = detector.infer(&image)?;
    let (all, classes) = (boxes.boxes.len(), boxes.classes.clone());
    boxes.boxes.retain(|found| classes.label(&found.name) == Some("person"));
    println!("{} of {all} boxes are persons", boxes.boxes.len());
    draw(&mut image, &boxes, &Style::default());
    vision::save(&image, "choose_classes.png")
}
