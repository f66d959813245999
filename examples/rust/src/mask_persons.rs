//! Detects persons with a mask of each. Input: people.jpg, a photograph with persons.

use opendr::instance_segmentation::{BodyPix, BodyPixParams};
use opendr::learner::Handle;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut segmenter = Handle::<BodyPix>::new(BodyPixParams::default(), Device::Auto)?;
    segmenter.load(opendr::download("bodypix")?)?;
    let mut image = vision::open("people.jpg")?;
    let persons = segmenter.infer(&image)?;
    for person in &persons.boxes {
        let mask = person.segment.as_ref().map_or(0.0, |segment| segment.area);
        let share = 100.0 * mask / person.area();
        println!("a person whose mask is {share:.0} % of its box, score {:.2}", person.confidence);
    }
    draw(&mut image, &persons, &Style::default());
    vision::save(&image, "mask_persons.png")
}
