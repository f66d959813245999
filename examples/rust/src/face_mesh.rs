//! Predicts the 478 points of a face, irises included. Input: astronaut.png (opendr download sample/astronaut).

use opendr::facial_landmarks::{FaceMesh, FaceMeshParams};
use opendr::learner::Handle;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut mesh = Handle::<FaceMesh>::new(FaceMeshParams::default(), Device::Auto)?;
    mesh.load(opendr::download("face_mesh")?)?;
    let mut image = vision::open("astronaut.png")?;
    let faces = mesh.infer(&image)?;
    for face in &faces.poses {
        let [_, _, width, _] = face.bounding_box().unwrap_or_default();
        println!("{} points over {:.0} pixels, score {:.2}", face.keypoints.len(), width, face.confidence);
    }
    draw(&mut image, &faces, &Style::default());
    vision::save(&image, "face_mesh.png")
}
