//! Recognises a person by a few images of each. Inputs: known/NAME/*.jpg, a folder of images per person, and visitor.jpg.
//! Needs the feature `training`.

use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::learner::Ports;
use opendr::vision::draw::{Style, draw};
use opendr::{FitOptions, Silent, Value, vision};

pub fn main() -> opendr::Result<()> {
    let mut recogniser = opendr::learner("face_recognition")?;
    let entry = opendr::registry().find("face_recognition")?;
    let known = ExternalDataset::new("known", "imagenet");
    let options = FitOptions { out: Some("recognise_faces".into()), ..FitOptions::default() };
    opendr::fit(recogniser.as_mut(), entry, DatasetRef::External(&known).into(), &options, &Silent)?;
    println!("known: {}", recogniser.classes().iter().collect::<Vec<_>>().join(", "));
    let mut image = vision::open("visitor.jpg")?;
    let outputs = recogniser.infer(&Ports::one(&image))?;
    if let Some(Value::BoundingBoxList(faces)) = outputs.first() {
        for face in &faces.boxes {
            println!("{} {:.2}", faces.label(face).unwrap_or("unknown"), face.confidence);
        }
        draw(&mut image, faces, &Style::default());
    }
    vision::save(&image, "recognise_faces.png")
}
