//! Evaluates a detector on rendered persons, by COCO's metric, and draws the worst image. Needs no input.

use opendr::data_generation::{GeneratedWorld, GenerationOptions};
use opendr::learner::Handle;
use opendr::object_detection_2d::{SingleShotDetector, SingleShotDetectorParams};
use opendr::params::ParamMap;
use opendr::vision::draw::{Style, draw};
use opendr::{Device, Value, metrics, vision};

pub fn main() -> opendr::Result<()> {
    let options = GenerationOptions { frames: 8, size: [320, 240], seed: 1, ..GenerationOptions::default() };
    // The scenes are rendered when they are read, and not written to files.
    let scenes = GeneratedWorld::Persons.dataset(&options)?;
    let params = SingleShotDetectorParams::default();
    let mut detector = Handle::<SingleShotDetector>::new(params, Device::Auto)?;
    detector.load(opendr::download("single_shot_detector")?)?;
    let mut metric = metrics::find("coco_detection")?.make(&ParamMap::new())?;
    let mut worst = (2.0, 0, None);
    for index in 0..scenes.len() {
        let mut sample = scenes.get(index)?;
        let (Some(Value::Image(image)), Some(persons)) = (sample.data.pop(), sample.target) else { continue };
        let found = detector.infer(&image)?;
        let score = metric.update(index, (&found).into(), persons.as_value_ref())?;
        if score < worst.0 {
            worst = (score, index, Some((image, found)));
        }
    }
    let result = metric.finish().statistics;
    let [map, map50] = ["map", "map50"].map(|name| result.get(name).unwrap_or_default());
    println!("mAP {map:.3}, at an IoU of 0.5 {map50:.3}");
    println!("worst image: {}, score {:.3}", worst.1, worst.0);
    let Some((mut image, found)) = worst.2 else { return Ok(()) };
    draw(&mut image, &found, &Style::default());
    vision::save(&image, "evaluate_detector.png")
}
