//! Detects fallen persons, and the poses that show it. Input: fallen.jpg, a photograph with a person who lies.

use opendr::fall_detection::{FallDetector, FallDetectorParams, FallDetectorTargets};
use opendr::learner::Handle;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut detector = Handle::<FallDetector>::new(FallDetectorParams::default(), Device::Auto)?;
    detector.load(opendr::download("fall_detector")?)?;
    let mut image = vision::open("fallen.jpg")?;
    let FallDetectorTargets { falls, poses } = detector.infer(&image)?;
    for fall in &falls.boxes {
        println!("{}, score {:.2}", falls.label(fall).unwrap_or_default(), fall.confidence);
    }
    println!("{} poses", poses.poses.len());
    draw(&mut image, &poses, &Style::default());
    draw(&mut image, &falls, &Style::default());
    vision::save(&image, "detect_falls.png")
}
