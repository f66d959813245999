//! Names the gesture of each hand in an image. Input: hand.jpg, a photograph of a hand.

use opendr::gesture_recognition::{HandGesture, HandGestureParams};
use opendr::learner::Handle;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut recogniser = Handle::<HandGesture>::new(HandGestureParams::default(), Device::Auto)?;
    recogniser.load(opendr::download("hand_gesture")?)?;
    let mut image = vision::open("hand.jpg")?;
    let hands = recogniser.infer(&image)?;
    println!("gestures: {}", recogniser.classes().iter().collect::<Vec<_>>().join(", "));
    for hand in &hands.boxes {
        println!("{} {:.2}", hands.label(hand).unwrap_or_default(), hand.confidence);
    }
    draw(&mut image, &hands, &Style::default());
    vision::save(&image, "name_gesture.png")
}
