//! Detects faces with their eyes, noses and corners of the mouth. Input: people.jpg, a photograph with faces.

use opendr::face_detection::{Yunet, YunetParams};
use opendr::learner::Handle;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut detector = Handle::<Yunet>::new(YunetParams::default(), Device::Auto)?;
    detector.load(opendr::download("yunet")?)?;
    let mut image = vision::open("people.jpg")?;
    let faces = detector.infer(&image)?;
    for face in &faces.boxes {
        let [left, _] = face.landmarks[0];
        let [right, _] = face.landmarks[1];
        println!("a face of {:.0} pixels, {:.0} between the eyes", face.width, (right - left).abs());
    }
    draw(&mut image, &faces, &Style::default());
    vision::save(&image, "detect_faces.png")
}
