//! Properties of a video file.

use std::path::Path;
use std::process::Stdio;

use opendr_engine::{Error, Result, ResultExt};
use serde::Deserialize;

use crate::source::VideoInfo;
use crate::video::ffmpeg::{Ffmpeg, input_arguments};

/// Valid frame rates; others are an error in the file and unusable for a writer.
const RATES: std::ops::RangeInclusive<f64> = 0.01..=1000.0;

const USUAL_RATE: f64 = 25.0;

#[derive(Deserialize)]
struct Report {
    #[serde(default)]
    streams: Vec<Stream>,
    #[serde(default)]
    format: Format,
}

#[derive(Deserialize)]
struct Stream {
    avg_frame_rate: Option<String>,
    nb_frames: Option<String>,
    duration: Option<String>,
}

#[derive(Deserialize, Default)]
struct Format {
    duration: Option<String>,
}

/// Reads the properties of the first video stream of a file with `ffprobe`.
///
/// # Errors
/// `Unsupported` when the program is not installed, `InvalidInput` when the file is not a video.
pub(crate) fn probe(programs: &Ffmpeg, path: &Path, max_samples: u64) -> Result<VideoInfo> {
    let entries = "stream=avg_frame_rate,nb_frames,duration:format=duration";
    let mut arguments: Vec<_> =
        ["-v", "error", "-select_streams", "V:0", "-show_entries", entries, "-of", "json"]
            .map(Into::into)
            .into();
    arguments.extend(input_arguments(path, max_samples));
    let opening = || format!("opening {}", path.display());
    let child = Ffmpeg::spawn(&programs.ffprobe, &arguments, Stdio::null()).context(opening)?;
    let output = child.wait_with_output().context(opening)?;
    if !output.status.success() {
        let complaints = String::from_utf8_lossy(&output.stderr);
        let last = complaints.lines().last().unwrap_or("no reason given").trim();
        let prefix = format!("file:{}: ", path.display());
        let last = last.strip_prefix(&prefix).unwrap_or(last);
        return Err(Error::invalid_input(format!("cannot read the video: ffprobe reports \"{last}\"")))
            .context(opening);
    }
    info_of_report(&output.stdout).context(opening)
}

fn info_of_report(json: &[u8]) -> Result<VideoInfo> {
    let report: Report = serde_json::from_slice(json)
        .map_err(|error| Error::format("cannot parse the output of ffprobe").with_source(error))?;
    let stream = report.streams.first().ok_or_else(|| {
        Error::invalid_input("no video stream in the file; pass a file with a video stream")
    })?;
    let rate = stream.avg_frame_rate.as_deref().and_then(rate_of_text).unwrap_or(USUAL_RATE);
    let number = |text: &Option<String>| text.as_deref()?.parse::<f64>().ok().filter(|value| *value > 0.0);
    let duration_s = number(&stream.duration).or_else(|| number(&report.format.duration));
    let counted = stream.nb_frames.as_deref().and_then(|text| text.parse().ok()).filter(|frames| *frames > 0);
    let frames = counted.or_else(|| Some((duration_s? * rate).round() as u64));
    Ok(VideoInfo { frame_rate: rate, frames, duration_s })
}

/// Parses a rate such as `"30000/1001"`.
fn rate_of_text(text: &str) -> Option<f64> {
    let (over, under) = text.split_once('/')?;
    let rate = over.parse::<f64>().ok()? / under.parse::<f64>().ok()?;
    RATES.contains(&rate).then_some(rate)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reports_are_read() {
        let info = info_of_report(
            br#"{"streams":[{"avg_frame_rate":"30000/1001","nb_frames":"90"}],"format":{"duration":"3.0"}}"#,
        )
        .unwrap();
        assert!((info.frame_rate - 29.97).abs() < 0.01);
        assert_eq!((info.frames, info.duration_s), (Some(90), Some(3.0)));
        let info = info_of_report(br#"{"streams":[{"avg_frame_rate":"0/0","duration":"N/A"}],"format":{}}"#)
            .unwrap();
        assert_eq!((info.frame_rate, info.frames, info.duration_s), (25.0, None, None));
        let info = info_of_report(br#"{"streams":[{"avg_frame_rate":"10/1"}],"format":{"duration":"2.04"}}"#)
            .unwrap();
        assert_eq!(info.frames, Some(20));
        assert!(info_of_report(br#"{"streams":[]}"#).is_err());
        assert!(info_of_report(b"not json").is_err());
    }
}
