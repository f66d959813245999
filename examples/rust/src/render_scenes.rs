//! Renders a labelled data set of persons, and draws the labels of one image. Needs no input.

use std::path::Path;

use opendr::data_generation::{GeneratedWorld, GenerationOptions, generate};
use opendr::dataset::ExternalDataset;
use opendr::datasets::{OpenOptions, Problems, open};
use opendr::vision::draw::{Style, draw};
use opendr::{Silent, Value, vision};

pub fn main() -> opendr::Result<()> {
    let options = GenerationOptions { frames: 8, size: [480, 320], seed: 1, ..GenerationOptions::default() };
    let (folder, problems) = (Path::new("render_scenes"), Problems::strict());
    generate(GeneratedWorld::Persons, folder, &options, &problems, &Silent)?;
    let scenes = open(&ExternalDataset::new(folder, "coco"), &OpenOptions::default(), &problems)?;
    for index in 0..scenes.len() {
        if let Some(Value::BoundingBoxList(persons)) = scenes.target(index)? {
            println!("{}: {} persons", scenes.name(index), persons.boxes.len());
        }
    }
    let mut sample = scenes.get(4)?;
    let [Value::Image(scene)] = &mut sample.data[..] else { return Ok(()) };
    if let Some(persons) = &sample.target {
        draw(scene, persons, &Style::default());
    }
    vision::save(scene, "render_scenes.png")
}
