//! Runs a detector that another tool exported to ONNX. Inputs: my_detector.onnx, for instance YOLOX-nano, and street.jpg.

use opendr::learner::Handle;
use opendr::object_detection_2d::{ImportedDetector, ImportedDetectorParams};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let params = ImportedDetectorParams { threshold: 0.5, ..ImportedDetectorParams::default() };
    let mut detector = Handle::<ImportedDetector>::new(params, Device::Auto)?;
    detector.load("my_detector.onnx")?;
    let mut image = vision::open("street.jpg")?;
    let boxes = detector.infer(&image)?;
    for found in &boxes.boxes {
        // The file states no names of its classes.
        println!("class {}, score {:.2}", found.name, found.confidence);
    }
    draw(&mut image, &boxes, &Style::default());
    vision::save(&image, "own_network.png")
}
