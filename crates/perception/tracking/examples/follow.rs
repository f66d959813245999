//! Runs a tracker on the detections of a video. `tests/tracking` evaluates its output beside that of others, and
//! `benches/tracking.py` measures its time.
//!
//! ```console
//! $ cargo run --release -p opendr-tracking --example follow -- byte_track '{}' < frames.json
//! ```
//!
//! A line of standard input is one frame: a list of boxes `[left, top, width, height, confidence]`. A line of standard output
//! is a list of `[id, left, top, width, height]`; the last line is `{"seconds": S}`, the tracker's time for all frames.

use std::error::Error;
use std::io::{self, BufRead as _, Write as _};
use std::time::Instant;

use opendr_engine::learner::Learner;
use opendr_engine::params::{ParamMap, Params};
use opendr_engine::target::{BoundingBox, BoundingBoxList, TrackingAnnotationList};
use opendr_tracking::object_tracking_2d::{ByteTrack, OcSort, Sort, TrackerInputs};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [name, params] = &arguments[..] else {
        return Err("give a tracker and its parameters as JSON".into());
    };
    let params: ParamMap = serde_json::from_str(params)?;
    match name.as_str() {
        "sort" => run(&Sort::with_params(Params::from_map(&params)?)),
        "byte_track" => run(&ByteTrack::with_params(Params::from_map(&params)?)),
        "oc_sort" => run(&OcSort::with_params(Params::from_map(&params)?)),
        other => Err(format!("no tracker {other:?}; there are sort, byte_track, oc_sort").into()),
    }
}

fn run<L>(tracker: &L) -> Result<(), Box<dyn Error>>
where
    L: for<'a> Learner<Input<'a> = TrackerInputs<'a>, Target = TrackingAnnotationList>,
{
    let mut frames = Vec::new();
    for line in io::stdin().lock().lines() {
        let rows: Vec<[f32; 5]> = serde_json::from_str(&line?)?;
        let found = rows.iter().map(|[left, top, width, height, confidence]| {
            BoundingBox::new(0, *left, *top, *width, *height, *confidence)
        });
        frames.push(BoundingBoxList::from(found.collect::<Vec<_>>()));
    }
    let (mut state, mut target) = (L::State::default(), TrackingAnnotationList::default());
    let mut output = io::stdout().lock();
    let mut seconds = 0.0;
    for detections in &frames {
        let begin = Instant::now();
        tracker.infer_into(&mut state, TrackerInputs { detections, image: None }, &mut target)?;
        seconds += begin.elapsed().as_secs_f64();
        let rows: Vec<_> = target
            .annotations
            .iter()
            .map(|track| {
                let place = &track.bounding_box;
                (track.id, place.left, place.top, place.width, place.height)
            })
            .collect();
        serde_json::to_writer(&mut output, &rows)?;
        writeln!(output)?;
    }
    writeln!(output, "{{\"seconds\": {seconds}}}")?;
    Ok(())
}
