//! Evaluates COCO results files; prints a line of JSON for each pair of files:
//! `coco_files bbox|segm|keypoints [--threads N] ANNOTATIONS RESULTS ...`.

use std::error::Error;
use std::path::Path;

use opendr_metrics::coco::files::{CocoFiles, CocoKind};

fn main() -> Result<(), Box<dyn Error>> {
    let usage = "usage: coco_files bbox|segm|keypoints [--threads N] ANNOTATIONS RESULTS ...";
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kind, rest @ ..] = &arguments[..] else { return Err(usage.into()) };
    let mut files = CocoFiles::new(match kind.as_str() {
        "bbox" => CocoKind::Boxes,
        "segm" => CocoKind::Masks,
        "keypoints" => CocoKind::Keypoints,
        _ => return Err(usage.into()),
    });
    let pairs = match rest {
        [flag, threads, pairs @ ..] if flag == "--threads" => {
            files.threads = threads.parse()?;
            pairs
        }
        pairs => pairs,
    };
    for [annotations, results] in pairs.as_chunks::<2>().0 {
        let done = files.compare(Path::new(annotations), Path::new(results))?;
        println!("{}", serde_json::to_string(&done.outcome.stats())?);
    }
    Ok(())
}
