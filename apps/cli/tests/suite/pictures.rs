//! `opendr infer` on real and malformed images.

use std::ffi::OsStr;
use std::fs;
use std::path::{Path, PathBuf};

use crate::cmyk_jpeg::cmyk_jpeg;
use crate::place::Place;
use image::{DynamicImage, Rgb, RgbImage};
use opendr::data::PixelFormat;
use opendr::vision;
use serde_json::Value;

/// A learner whose model is in the test data.
const LEARNER: &str = "yunet/640";
/// Upper bound of the memory of each run, in 10^6 bytes.
const MEMORY_MB: f64 = 1000.0;

fn pictures_of_coco(data: &Path, count: usize) -> Vec<PathBuf> {
    let entries = fs::read_dir(data.join("data/coco128/images/val2017")).unwrap();
    let mut pictures: Vec<_> = entries.map(|entry| entry.unwrap().path()).collect();
    pictures.sort();
    pictures.truncate(count);
    assert_eq!(pictures.len(), count);
    pictures
}

fn photo_with_two_faces(data: &Path) -> DynamicImage {
    let photo = vision::open(data.join("data/photos/zidane.jpg")).unwrap();
    let (width, height) = (photo.width() as u32, photo.height() as u32);
    RgbImage::from_raw(width, height, photo.hwc_u8(PixelFormat::Rgb)).unwrap().into()
}

fn size(picture: &Path) -> [usize; 2] {
    let picture = vision::open(picture).unwrap();
    [picture.width(), picture.height()]
}

fn faces(line: &Value) -> usize {
    assert_eq!(line["outputs"]["boxes"]["type"], "BoundingBoxList", "{line}");
    line["outputs"]["boxes"]["boxes"].as_array().unwrap().len()
}

#[test]
fn folder_of_pictures_is_done_in_order() {
    let Some((place, data)) = Place::with_data() else { return };
    let folder = place.path("in");
    fs::create_dir(&folder).unwrap();
    for picture in pictures_of_coco(&data, 64) {
        fs::copy(&picture, folder.join(picture.file_name().unwrap())).unwrap();
    }
    let done = place.run(["infer", LEARNER, "in", "--out", "out", "--json", "--show-timings"]).ends_with(0);
    let lines = done.lines();
    let names: Vec<_> = lines.iter().map(|line| line["input"].as_str().unwrap()).collect();
    assert!(lines.len() == 64 && names.is_sorted(), "{names:?}");
    assert!(lines.iter().map(faces).sum::<usize>() > 10);
    assert!(lines.iter().all(|line| line["timings_ms"]["session"].as_f64().unwrap() > 0.0));
    for name in names {
        let written = place.path("out").join(Path::new(name).file_name().unwrap());
        assert_eq!(size(&written), size(&place.path(name)));
    }
    assert_eq!(fs::read_dir(place.path("out")).unwrap().count(), 64);
    assert!(done.peak_mb < MEMORY_MB, "{}", done.peak_mb);
    let some = place.run(["infer", LEARNER, "in", "--limit", "3", "--json"]).ends_with(0).lines();
    assert_eq!(some, lines[..3].iter().cloned().map(without_timings).collect::<Vec<_>>());
}

fn without_timings(mut line: Value) -> Value {
    line.as_object_mut().unwrap().remove("timings_ms");
    line
}

#[test]
fn broken_file_of_a_pattern_is_reported_and_the_rest_done() {
    let Some((place, data)) = Place::with_data() else { return };
    for picture in pictures_of_coco(&data, 5) {
        fs::copy(&picture, place.path(picture.file_name().unwrap())).unwrap();
    }
    let broken = pictures_of_coco(&data, 3).pop().unwrap();
    let broken = broken.file_name().unwrap().to_str().unwrap();
    place.write(broken, "this is text");
    let done = place.run(["infer", LEARNER, "*.jpg", "--out", "out", "--json=lines.jsonl"]).ends_with(1);
    assert_eq!(done.stderr.matches("error: ").count(), 1);
    assert!(done.stderr.contains(broken), "{}", done.stderr);
    assert_eq!(done.stdout.lines().filter(|line| line.ends_with(".jpg")).count(), 4);
    assert_eq!(fs::read_dir(place.path("out")).unwrap().count(), 4);
    let text = fs::read_to_string(place.path("lines.jsonl")).unwrap();
    let lines: Vec<Value> = text.lines().map(|line| serde_json::from_str(line).unwrap()).collect();
    let failed: Vec<_> = lines.iter().filter(|line| line["error"]["kind"] == "InvalidInput").collect();
    assert!(lines.len() == 5 && failed.len() == 1, "{text}");
    assert_eq!(failed[0]["input"], *broken);
}

#[test]
fn missing_input_among_others_is_reported_and_the_rest_done() {
    let Some((place, data)) = Place::with_data() else { return };
    let photo = data.join("data/photos/zidane.jpg");
    let arguments =
        ["infer".as_ref(), LEARNER.as_ref(), "no-such.jpg".as_ref(), photo.as_os_str(), "--json".as_ref()];
    let done = place.run(arguments).ends_with(1);
    let lines = done.lines();
    assert_eq!((&lines[0]["input"], &lines[0]["error"]["kind"]), (&"no-such.jpg".into(), &"NotFound".into()));
    assert_eq!(faces(&lines[1]), 2);
}

#[test]
fn unusual_images_are_decoded() {
    let Some((place, data)) = Place::with_data() else { return };
    RgbImage::from_pixel(1, 1, Rgb([9, 8, 7])).save(place.path("dot.png")).unwrap();
    RgbImage::from_pixel(1, 3000, Rgb([9, 8, 7])).save(place.path("line.png")).unwrap();
    let photo = photo_with_two_faces(&data);
    photo.to_rgb16().save(place.path("deep.png")).unwrap();
    photo.to_luma8().save(place.path("grey.png")).unwrap();
    photo.to_rgba8().save(place.path("opaque.png")).unwrap();
    place.write("ink.jpg", cmyk_jpeg(64, [255, 128, 0, 255]));
    let cases = [
        ("dot.png", 0),
        ("line.png", 0),
        ("deep.png", 2),
        ("grey.png", 2),
        ("opaque.png", 2),
        ("ink.jpg", 0),
    ];
    for (name, wanted) in cases {
        let done = place.run(["infer", LEARNER, name, "--out", "out", "--json"]).ends_with(0);
        assert_eq!(done.lines().iter().map(faces).collect::<Vec<_>>(), [wanted], "{name}");
        assert_eq!(size(&place.path("out").join(name)), size(&place.path(name)));
    }
    let ink = vision::open(place.path("out/ink.jpg")).unwrap().chw_u8();
    let channels = ink.chunks(64 * 64).map(|channel| channel[32 * 64 + 32]);
    let near = channels.clone().zip([255, 128, 0]).all(|(got, wanted): (u8, u8)| got.abs_diff(wanted) < 8);
    assert!(near, "{:?}", channels.collect::<Vec<_>>());
}

#[test]
fn twenty_megapixels_take_bounded_memory() {
    let Some((place, data)) = Place::with_data() else { return };
    let photo = vision::open(data.join("data/photos/zidane.jpg")).unwrap();
    fs::create_dir(place.path("in")).unwrap();
    vision::save(&vision::resize(&photo, 5472, 3648).unwrap(), place.path("in/0.jpg")).unwrap();
    for copy in 1..5 {
        fs::copy(place.path("in/0.jpg"), place.path(format!("in/{copy}.jpg"))).unwrap();
    }
    let done = place.run(["infer", LEARNER, "in", "--out", "out", "--json"]).ends_with(0);
    assert_eq!(done.lines().iter().map(faces).collect::<Vec<_>>(), [2; 5]);
    println!("peak memory {} MB", done.peak_mb);
    assert!(done.peak_mb < MEMORY_MB, "{}", done.peak_mb);
}

#[test]
fn hostile_files_are_refused() {
    let Some((place, data)) = Place::with_data() else { return };
    let photo = fs::read(data.join("data/photos/bus.jpg")).unwrap();
    let mut png_bomb = Vec::from(*b"\x89PNG\r\n\x1a\n\0\0\0\x0dIHDR\0\0\xff\xff\0\0\xff\xff\x08\x02\0\0\0");
    png_bomb.extend(crc32(&png_bomb[12..]).to_be_bytes());
    let mut jpeg_bomb = photo.clone();
    let frame = jpeg_bomb.windows(2).position(|pair| pair == [0xff, 0xc0] || pair == [0xff, 0xc2]).unwrap();
    jpeg_bomb[frame + 5..frame + 9].fill(0xff);
    let mut bmp_bomb =
        Vec::from(*b"BM\0\0\0\0\0\0\0\0\x36\0\0\0\x28\0\0\0\xff\xff\0\0\xff\xff\0\0\x01\0\x18\0");
    bmp_bomb.resize(54, 0);
    let cases: [(&str, &[u8], i32); 7] = [
        ("text.jpg", b"Dear reader, this is no picture.", 1),
        ("empty.png", b"", 1),
        ("bomb.png", &png_bomb, 1),
        ("bomb.jpg", &jpeg_bomb, 1),
        ("bomb.bmp", &bmp_bomb, 1),
        ("head.jpg", &photo[..200], 1),
        ("nonsense.webp", b"RIFF\xff\xff\xff\xffWEBPVP8 \xff\xff\xff\xff", 1),
    ];
    for (name, bytes, code) in cases {
        place.write(name, bytes);
        let done = place.run(["infer", LEARNER, name, "--out", "out"]).ends_with(code);
        assert!(done.stderr.contains(name), "{}", done.stderr);
        assert!(done.stdout.is_empty() && done.stderr.lines().count() == 1, "{done:?}");
        assert!(done.peak_mb < MEMORY_MB / 3.0, "{name}: {} MB", done.peak_mb);
    }
    assert_eq!(fs::read_dir(place.path("out")).unwrap().count(), 0);
}

fn crc32(bytes: &[u8]) -> u32 {
    let step = |crc: u32, _| if crc & 1 == 1 { crc >> 1 ^ 0xedb8_8320 } else { crc >> 1 };
    !bytes.iter().fold(!0, |crc, byte| (0..8).fold(crc ^ u32::from(*byte), step))
}

#[test]
fn input_is_never_written_over() {
    let Some((place, data)) = Place::with_data() else { return };
    let photo = fs::read(data.join("data/photos/zidane.jpg")).unwrap();
    let input = place.write("in/zidane.jpg", &photo);
    for out in ["in", "in/zidane.jpg", "in/../in"] {
        let done = place.run(["infer", LEARNER, "in/zidane.jpg", "--out", out]).ends_with(1);
        assert!(done.stderr.contains("is the input itself"), "{}", done.stderr);
        assert_eq!(fs::read(&input).unwrap(), photo);
    }
}

#[cfg(unix)]
#[test]
fn names_that_are_not_utf8_work() {
    use std::os::unix::ffi::OsStrExt;
    let Some((place, data)) = Place::with_data() else { return };
    let name = OsStr::from_bytes(b"face-\xff.jpg");
    fs::copy(data.join("data/photos/zidane.jpg"), place.path(name)).unwrap();
    let out = OsStr::from_bytes(b"out-\xfe");
    let arguments = ["infer".as_ref(), LEARNER.as_ref(), name, "--json".as_ref(), "--out".as_ref(), out];
    let done = place.run(arguments).ends_with(0);
    assert_eq!(done.lines().iter().map(faces).collect::<Vec<_>>(), [2]);
    assert!(vision::open(place.path(out).join(name)).is_ok());
}

#[test]
fn parameters_and_threads_reach_the_learner() {
    let Some((place, data)) = Place::with_data() else { return };
    let photo = data.join("data/photos/t1.jpg");
    let photo = photo.to_str().unwrap();
    let count = |flags: &[&str]| {
        let done = place.run(["infer", LEARNER, photo, "--json"].iter().chain(flags)).ends_with(0);
        faces(&done.lines()[0])
    };
    assert!(count(&[]) > 2);
    assert_eq!(count(&["--max-detections", "2"]), 2);
    assert_eq!(count(&["--threshold", "1"]), 0);
    assert_eq!(count(&["--threads", "1", "--suppression", "soft", "--max-detections=1"]), 1);
}

#[test]
fn bench_measures_every_stage() {
    let Some((place, data)) = Place::with_data() else { return };
    let photo = data.join("data/photos/zidane.jpg");
    let flags = ["--frames", "5", "--warmup", "1", "--threads", "1", "--json", "--quiet"];
    let arguments = ["bench", LEARNER, photo.to_str().unwrap()];
    let done = place.run(arguments.iter().chain(&flags)).ends_with(0);
    let report: Value = serde_json::from_str(&done.stdout).unwrap();
    assert_eq!((&report["frames"], &report["threads"]), (&5.into(), &1.into()));
    assert_eq!((&report["image"]["width"], &report["image"]["height"]), (&1280.into(), &720.into()));
    for key in ["p50_ms", "p99_ms"] {
        let [pre, session, post, total] =
            ["pre", "session", "post", "total"].map(|stage| report[key][stage].as_f64().unwrap());
        assert!(pre > 0.0 && session > 0.0 && post > 0.0 && total >= session, "{report}");
    }
    assert!(report["frames_per_second"].as_f64().unwrap() > 0.0);
    assert!(!cfg!(target_os = "linux") || report["peak_memory_mb"].as_f64().unwrap() > 1.0);
    assert!(report["layers"].is_null());
    let drawn = place.run(["bench", LEARNER, "--frames", "2", "--offline"]).ends_with(0);
    assert!(drawn.stdout.contains("2 frames of 1920x1080 (drawn)"), "{}", drawn.stdout);
}

#[test]
fn bench_profiles_the_layers_of_networks() {
    let Some((place, data)) = Place::with_data() else { return };
    let photo = data.join("data/photos/zidane.jpg");
    let trace = place.path("trace.json");
    let flags = ["--frames", "3", "--warmup", "1", "--threads", "1", "--quiet", "--layers", "--trace"];
    let flags: Vec<&str> = flags.into_iter().chain([trace.to_str().unwrap()]).collect();
    let arguments = ["bench", LEARNER, photo.to_str().unwrap()];
    let run = |more: &[&str]| {
        let mut command = place.command(arguments.iter().chain(&flags).chain(more));
        command.env("OPENDR_RUNTIME", "builtin");
        place.start(command).finish().ends_with(0)
    };
    let report: Value = serde_json::from_str(&run(&["--json"]).stdout).unwrap();
    let layers = report["layers"]["layers"].as_array().unwrap();
    let sum: f64 = layers.iter().map(|layer| layer["ms"].as_f64().unwrap()).sum();
    assert!((sum - report["layers"]["ms"].as_f64().unwrap()).abs() < 1e-6, "{sum}");
    let convolution = layers.iter().find(|layer| layer["operator"] == "Conv").unwrap();
    assert!(convolution["gflops"].as_f64().unwrap() > 0.0, "{convolution}");
    let events: Value = serde_json::from_slice(&fs::read(&trace).unwrap()).unwrap();
    let calls = events["traceEvents"].as_array().unwrap().iter().filter(|event| event["name"] == "call");
    assert_eq!(calls.count(), 3);
    let text = run(&[]).stdout;
    assert!(text.contains("GFLOP/s") && text.contains("Conv"), "{text}");
}
