//! Names the expression of a face. Input: astronaut.png (opendr download sample/astronaut).

use opendr::facial_expression_recognition::{FacialEmotion, FacialEmotionParams};
use opendr::learner::Handle;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut recogniser = Handle::<FacialEmotion>::new(FacialEmotionParams::default(), Device::Auto)?;
    recogniser.load(opendr::download("facial_emotion")?)?;
    let mut image = vision::open("astronaut.png")?;
    let expression = recogniser.infer(&image)?;
    let classes = recogniser.classes();
    let mut scores: Vec<_> = classes.iter().zip(&expression.probabilities).collect();
    scores.sort_by(|(_, one), (_, other)| other.total_cmp(one));
    for (name, probability) in &scores[..3] {
        println!("{name} {probability:.2}");
    }
    draw(&mut image, &expression, &Style::default());
    vision::save(&image, "name_expression.png")
}
