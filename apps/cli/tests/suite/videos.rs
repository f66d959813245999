//! `opendr infer` on videos, through an installed `ffmpeg`.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::place::Place;

/// A learner whose model is in the test data.
const LEARNER: &str = "yunet/640";

/// A place with `clip.mp4`: `frames` frames of a photograph with two faces, at 10 Hz.
fn place_with_clip(frames: u32) -> Option<Place> {
    let (place, data) = Place::with_data()?;
    let made = Command::new("ffmpeg")
        .args(["-v", "error", "-loop", "1", "-framerate", "10", "-i"])
        .arg(data.join("data/photos/zidane.jpg"))
        .args([
            "-frames:v",
            &frames.to_string(),
            "-vf",
            "scale=640:360",
            "-pix_fmt",
            "yuv420p",
            "-preset",
            "ultrafast",
        ])
        .arg(place.path("clip.mp4"))
        .status();
    if made.is_ok_and(|status| status.success()) {
        return Some(place);
    }
    println!("skipped: no ffmpeg");
    None
}

/// Width, height and number of frames of a complete video.
fn measure(video: &Path) -> [u32; 3] {
    let output = Command::new("ffprobe")
        .args(["-v", "error", "-count_frames", "-select_streams", "v", "-of", "csv=p=0"])
        .args(["-show_entries", "stream=width,height,nb_read_frames"])
        .arg(video)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&output.stdout);
    let numbers: Vec<u32> = text.trim().split(',').filter_map(|number| number.parse().ok()).collect();
    numbers.try_into().unwrap_or_else(|_| panic!("{}: {text} {output:?}", video.display()))
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path());
    entries.filter(|path| path.extension().is_some_and(|extension| extension == "mp4")).collect()
}

#[test]
fn video_becomes_a_video() {
    let Some(place) = place_with_clip(12) else { return };
    let done = place
        .run(["infer", LEARNER, "clip.mp4", "--out", "seen.mp4", "--json", "--threshold=0.8"])
        .ends_with(0);
    let lines = done.lines();
    assert_eq!(lines.len(), 12);
    for (number, line) in lines.iter().enumerate() {
        assert_eq!((&line["input"], &line["index"]), (&"clip.mp4".into(), &number.into()));
        let boxes = &line["outputs"]["boxes"];
        assert_eq!(boxes["boxes"].as_array().unwrap().len(), 2, "{line}");
        assert_eq!(boxes["stamp_ns"], number as u64 * 100_000_000);
    }
    assert_eq!(measure(&place.path("seen.mp4")), [640, 360, 12]);
    let text =
        place.run(["infer", LEARNER, "clip.mp4", "--out", "folder", "--limit", "5"]).ends_with(0).stdout;
    assert!(text.contains("clip.mp4 frame 4\n"), "{text}");
    assert_eq!(measure(&place.path("folder/clip.mp4")), [640, 360, 5]);
}

#[test]
fn pictures_become_a_video_too() {
    let Some(place) = place_with_clip(1) else { return };
    for number in 0..3 {
        place.run(["infer", LEARNER, "clip.mp4", "--out", &format!("{number}.png")]).ends_with(0);
    }
    place.run(["infer", LEARNER, "*.png", "--out", "seen.mkv"]).ends_with(0);
    assert_eq!(measure(&place.path("seen.mkv")), [640, 360, 3]);
}

#[test]
fn wrong_video_outputs_are_reported_once() {
    let Some(place) = place_with_clip(6) else { return };
    let refused = place.run(["infer", LEARNER, "clip.mp4", "--out", "seen.png"]).ends_with(12);
    assert!(refused.stderr.contains("give a folder, or a video"), "{}", refused.stderr);
    let over_itself = place.run(["infer", LEARNER, "clip.mp4", "--out", "."]).ends_with(1);
    assert_eq!(over_itself.stderr.matches("is the input itself").count(), 1, "{}", over_itself.stderr);
    assert_eq!(measure(&place.path("clip.mp4"))[2], 6);
}

#[test]
fn broken_video_among_others_is_reported() {
    let Some(place) = place_with_clip(4) else { return };
    place.write("broken.mp4", "no video at all");
    let done = place.run(["infer", LEARNER, "broken.mp4", "clip.mp4", "--out", "out", "--json"]).ends_with(1);
    let lines = done.lines();
    assert_eq!((lines.len(), &lines[0]["input"]), (5, &"broken.mp4".into()));
    assert_eq!(files(&place.path("out")), [place.path("out/clip.mp4")]);
}

#[cfg(unix)]
#[test]
fn interrupt_ends_the_video_properly() {
    use std::os::unix::process::CommandExt;
    let Some(place) = place_with_clip(3000) else { return };
    let mut command = place.command(["infer", LEARNER, "clip.mp4", "--out", "seen.mp4", "--json"]);
    // As in a terminal, the signal goes to the whole group, children included.
    command.process_group(0);
    let mut running = place.start(command);
    while running.stdout().lines().count() < 5 && running.child.try_wait().unwrap().is_none() {
        std::thread::sleep(std::time::Duration::from_millis(5));
    }
    let group = format!("-{}", running.child.id());
    assert!(Command::new("kill").args(["-INT", "--", &group]).status().unwrap().success());
    let done = running.finish().ends_with(130);
    let lines = done.lines();
    assert!((5..2000).contains(&lines.len()) && done.stderr.is_empty(), "{}", done.stderr);
    assert_eq!(measure(&place.path("seen.mp4")), [640, 360, lines.len() as u32]);
    assert_eq!(files(&place.0).len(), 2);
}
