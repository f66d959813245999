//! Writes a log from lines of JSON on standard input: `log FOLDER [RESUME_FROM]`.
//!
//! A line is `{"tag": "loss", "step": 1, "value": 0.5}`, or `{"tag": "batch", "step": 1, "picture": [HEIGHT, WIDTH,
//! [R, G, B, ..]]}`.

use std::io::{self, BufRead};
use std::path::Path;

use opendr_engine::data::Image;
use opendr_engine::{Error, Result};
use opendr_runlog::RunLog;
use serde::Deserialize;

#[derive(Deserialize)]
struct Line {
    tag: String,
    step: u64,
    value: Option<f64>,
    picture: Option<(usize, usize, Vec<u8>)>,
}

fn main() -> Result<()> {
    let mut arguments = std::env::args().skip(1);
    let folder =
        arguments.next().ok_or_else(|| Error::invalid_param("no folder; usage: log FOLDER [RESUME_FROM]"))?;
    let resume_from = arguments.next().and_then(|step| step.parse().ok());
    let mut log = RunLog::open(Some(Path::new(&folder)), resume_from)?;
    for line in io::stdin().lock().lines() {
        let line: Line = serde_json::from_str(&line?)
            .map_err(|error| Error::format("not a line of a log").with_source(error))?;
        if let Some(value) = line.value {
            log.scalar(&line.tag, line.step, value)?;
        }
        if let Some((height, width, samples)) = line.picture {
            let image = Image::from_rgb8(samples, width, height)?;
            log.image(&line.tag, line.step, &image)?;
        }
    }
    log.flush()
}
