//! From two of COCO's JSON files to its numbers: `coco_files bbox|segm|keypoints ANNOTATIONS RESULTS [THREADS]`.

use std::error::Error;
use std::path::Path;

use opendr_metrics::coco::files::{CocoFiles, CocoKind};

fn main() -> Result<(), Box<dyn Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [kind, annotations, results, rest @ ..] = &arguments[..] else {
        return Err("usage: coco_files bbox|segm|keypoints ANNOTATIONS RESULTS [THREADS]".into());
    };
    let mut files = CocoFiles::new(match kind.as_str() {
        "segm" => CocoKind::Masks,
        "keypoints" => CocoKind::Keypoints,
        _ => CocoKind::Boxes,
    });
    if let [threads, ..] = rest {
        files.threads = threads.parse()?;
    }
    let done = files.compare(Path::new(annotations), Path::new(results))?;
    println!("{}", serde_json::to_string(&done.outcome.stats())?);
    Ok(())
}
