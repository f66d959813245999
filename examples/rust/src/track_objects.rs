//! Tracks objects over the frames of a folder, with a detector and a tracker in sequence. Input: frames/*.jpg, of a camera.

use std::collections::BTreeMap;

use opendr::learner::Ports;
use opendr::vision::draw::{Style, draw};
use opendr::{Pipeline, Value, vision};

pub fn main() -> opendr::Result<()> {
    let mut pipeline = Pipeline::open("yolox + sort")?;
    let mut seen = BTreeMap::<_, Vec<f32>>::new();
    let mut last = None;
    for frame in vision::Source::open("frames")? {
        let mut image = frame?.image;
        let outputs = pipeline.infer(&Ports::one(&image))?;
        let Some(Value::TrackingAnnotationList(tracks)) = outputs.get("tracks") else { continue };
        for track in &tracks.annotations {
            let name = tracks.classes.label(&track.bounding_box.name).unwrap_or_default();
            seen.entry((track.id, name.to_owned())).or_default().push(track.bounding_box.left);
        }
        draw(&mut image, tracks, &Style::default());
        last = Some(image);
    }
    for ((id, name), lefts) in &seen {
        let moved = lefts[lefts.len() - 1] - lefts[0];
        println!("{name} {id}: {} frames, moved by {moved:.0} pixels", lefts.len());
    }
    last.map_or(Ok(()), |image| vision::save(&image, "track_objects.png"))
}
