//! Reads the text in an image. Input: sign.png, a photograph of a sign.

use opendr::learner::Handle;
use opendr::text_recognition::{PpOcr, PpOcrParams};
use opendr::vision::draw::{Style, draw};
use opendr::{Device, vision};

pub fn main() -> opendr::Result<()> {
    let mut reader = Handle::<PpOcr>::new(PpOcrParams::default(), Device::Auto)?;
    reader.load(opendr::download("pp_ocr")?)?;
    let mut image = vision::open("sign.png")?;
    let texts = reader.infer(&image)?;
    for region in &texts.regions {
        println!("'{}' {:.2}", region.text, region.confidence);
    }
    draw(&mut image, &texts, &Style::default());
    vision::save(&image, "read_text.png")
}
