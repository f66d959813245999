//! A COCO file that is much larger than the memory allowed for checking and converting it.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::fmt::Write as _;
use std::fs::{self, File};
use std::io::{BufWriter, Write};
use std::path::{Path, PathBuf};
use std::process::Command;

use opendr_datasets::{Coco, Format, OpenOptions, Problems, WriteOptions, Yolo, check};
use opendr_engine::Silent;
use opendr_engine::data::Image;
use opendr_engine::dataset::DatasetIterator;

/// Variable with the folder, for the measured process.
const FOLDER: &str = "OPENDR_BIG_COCO";

const PICTURES: usize = 500;

/// Writes a file of about `megabytes` on a single line and returns the number of annotations. The annotations of an
/// image are spread over the file and precede what they depend on; three are broken.
fn generate(folder: &Path, megabytes: usize) -> usize {
    fs::create_dir_all(folder.join("annotations")).unwrap();
    fs::create_dir_all(folder.join("val")).unwrap();
    let first = folder.join("val/000000.png");
    opendr_vision::save(&Image::from_rgb8(vec![128; 64 * 48 * 3], 64, 48).unwrap(), &first).unwrap();
    (1..PICTURES).for_each(|at| fs::hard_link(&first, folder.join(format!("val/{at:06}.png"))).unwrap());
    let mut file = BufWriter::new(File::create(folder.join("annotations/instances_val.json")).unwrap());
    write!(file, "{{\"annotations\": [").unwrap();
    let (mut written, mut count) = (0, 0);
    let mut text = String::new();
    while written < megabytes << 20 {
        text.clear();
        let (left, top) = (count % 40, count % 30);
        let _ = write!(
            text,
            "{}{{\"id\": {count}, \"image_id\": {}, \"category_id\": {}, \"area\": 64.25, \"iscrowd\": 0, \
             \"bbox\": [{left}.5, {top}, {}, 8.25], \"segmentation\": [[",
            if count > 0 { ", " } else { "" },
            if count == 99 { 123_456 } else { 1000 + count % PICTURES },
            if count == 77 { 5 } else { 18 + 72 * (count % 2) },
            if count == 55 { "NaN" } else { "9" },
        );
        for corner in 0..100 {
            let _ = write!(text, "{left}.{corner:02}, {top}.{corner:02}, ");
        }
        text.push_str("1, 1]]}");
        file.write_all(text.as_bytes()).unwrap();
        written += text.len();
        count += 1;
    }
    let pictures: Vec<_> = (0..PICTURES)
        .map(|at| {
            format!(
                "{{\"id\": {}, \"file_name\": \"{at:06}.png\", \"width\": 64, \"height\": 48}}",
                1000 + at
            )
        })
        .collect();
    let categories = "{\"id\": 90, \"name\": \"toothbrush\"}, {\"id\": 18, \"name\": \"dog\"}";
    write!(file, "], \"images\": [{}], \"categories\": [{categories}]}}", pictures.join(", ")).unwrap();
    file.flush().unwrap();
    count
}

/// Body of the measured process: checks the file, and converts it to YOLO and to COCO.
#[test]
fn measured_process() {
    let Some(folder) = std::env::var_os(FOLDER).map(PathBuf::from) else { return };
    let problems = Problems::skipping();
    let coco = Coco::open(&folder, &OpenOptions::default(), &problems).unwrap();
    check(&coco, &problems, 2, &Silent).unwrap();
    let options = WriteOptions { split: Some("val".into()), link: true };
    Yolo::write(&coco, &folder.join("yolo"), &options, &problems, &Silent).unwrap();
    Coco::write(&coco, &folder.join("coco"), &options, &problems, &Silent).unwrap();
    problems.list().iter().for_each(|problem| println!("problem {problem}"));
    let again = Coco::open(&folder.join("coco"), &OpenOptions::default(), &Problems::strict()).unwrap();
    assert_eq!(again.class_ids(), [18, 90]);
    assert_eq!(again.target(7).unwrap(), coco.target(7).unwrap());
    let status = fs::read_to_string("/proc/self/status").unwrap();
    println!("{}", status.lines().find(|line| line.starts_with("VmHWM")).unwrap());
}

#[cfg(target_os = "linux")]
#[test]
fn memory_stays_small() {
    let whole = std::env::var("OPENDR_BIG_TESTS").is_ok_and(|value| value == "1");
    let (megabytes, limit) = if whole { (1000, 500) } else { (30, 20) };
    let folder = std::env::temp_dir().join(format!("opendr-big-coco-{}", std::process::id()));
    let count = generate(&folder, megabytes);
    let done = Command::new(std::env::current_exe().unwrap())
        .args(["--exact", "measured_process", "--nocapture"])
        .env(FOLDER, &folder)
        .output()
        .unwrap();
    let text = String::from_utf8_lossy(&done.stdout);
    assert!(done.status.success(), "{text}{}", String::from_utf8_lossy(&done.stderr));
    let reported: Vec<_> = text.lines().filter(|line| line.starts_with("problem")).collect();
    assert_eq!(reported.len(), 3, "{reported:?}");
    let wanted = ["annotations[55]", "annotations[77].category_id", "annotations[99].image_id"];
    wanted.iter().zip(&reported).for_each(|(key, reported)| {
        assert!(reported.contains(key) && reported.contains("byte"), "{reported}")
    });
    let labels = fs::read_dir(folder.join("yolo/labels/val")).unwrap();
    let lines = labels.map(|file| fs::read_to_string(file.unwrap().path()).unwrap().lines().count());
    assert_eq!(lines.sum::<usize>(), count - 3);
    fs::remove_dir_all(&folder).unwrap();
    let peak = text.lines().find_map(|line| line.strip_prefix("VmHWM:")).unwrap();
    let peak: usize = peak.trim().trim_end_matches(" kB").parse().unwrap();
    println!("a file of {megabytes} MB took {} MB of memory at most", peak >> 10);
    assert!(
        peak >> 10 < limit,
        "{} MB of memory for a file of {megabytes} MB; {limit} MB are allowed",
        peak >> 10
    );
}
