//! Reads images with their detections from a robot's recording. Input: drive.mcap (opendr infer yolox frames --out drive.mcap
//! --with-input), or a rosbag.

use opendr::dataset::ExternalDataset;
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::vision::draw::{Style, draw};
use opendr::{Value, vision};

pub fn main() -> opendr::Result<()> {
    let set = ExternalDataset::new("drive.mcap", "recording");
    let recording = open(&set, &OpenOptions::default(), &Problems::strict())?;
    println!("{} images with detections", recording.len());
    let mut last = None;
    for index in (0..recording.len()).step_by(4) {
        let mut sample = recording.get(index)?;
        let Some(Value::BoundingBoxList(boxes)) = sample.target else { continue };
        let Some(Value::Image(image)) = sample.data.pop() else { continue };
        let names: Vec<_> = boxes.boxes.iter().map(|found| boxes.label(found).unwrap_or_default()).collect();
        let seconds = image.header.stamp_ns.unwrap_or_default() as f64 / 1e9;
        println!("{seconds:.2} s: {}", names.join(", "));
        last = Some((image, boxes));
    }
    let Some((mut image, boxes)) = last else { return Ok(()) };
    draw(&mut image, &boxes, &Style::default());
    vision::save(&image, "read_recording.png")
}
