//! Detects objects in a photograph. Input: street.jpg, any photograph.

use opendr::learner::Handle;
use opendr::object_detection_2d::{CenterNet, CenterNetParams};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut detector = Handle::<CenterNet>::new(CenterNetParams::default(), Device::Auto)?;
    detector.load(opendr::download("centernet")?)?;
    let mut image = vision::open("street.jpg")?;
    let boxes = detector.infer(&image)?;
    for found in &boxes.boxes {
        let name = boxes.label(found).unwrap_or_default();
        println!("{name} {:.2}, {:.0} x {:.0} pixels", found.confidence, found.width, found.height);
    }
    draw(&mut image, &boxes, &Style::default());
    vision::save(&image, "detect_objects.png")
}
