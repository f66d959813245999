//! Videos of the MOT Challenge with ground truth and detections.

use std::collections::HashSet;
use std::path::{Path, PathBuf};

use opendr_engine::Result;

use crate::fields::lines;
use crate::folder::{PICTURES, files_in, name_of, path_inside, read_text};
use crate::mot::row::{MAX_FRAMES, MotRow, RowKind};
use crate::{Problem, Problems};

/// One video: its images, if they exist, and the rows of its files.
#[derive(Debug, Clone)]
pub struct MotSequence {
    name: String,
    frame_rate: f64,
    image_size: Option<[u32; 2]>,
    frames: Frames,
    ground_truth: Vec<MotRow>,
    detections: Vec<MotRow>,
}

#[derive(Debug, Clone)]
enum Frames {
    /// Image files by the numbers in their names.
    Pictures(Vec<(i64, PathBuf)>),
    /// Number of frames without images: the highest frame number of the rows.
    Count(i64),
}

/// Content of `seqinfo.ini`.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct SequenceInfo {
    pub(super) name: Option<String>,
    pub(super) image_folder: String,
    pub(super) frame_rate: f64,
    pub(super) length: Option<i64>,
    pub(super) image_size: Option<[u32; 2]>,
}

impl Default for SequenceInfo {
    fn default() -> Self {
        Self { name: None, image_folder: "img1".into(), frame_rate: 30.0, length: None, image_size: None }
    }
}

impl SequenceInfo {
    /// Parses `key=value` lines; wrong lines are reported with their number and skipped.
    pub(super) fn parse(text: &str, mut wrong: impl FnMut(u64, String) -> Result<()>) -> Result<Self> {
        let mut info = Self::default();
        let mut size = [0; 2];
        for (number, line) in lines(text).filter(|(_, line)| !line.trim_start().starts_with(['[', ';', '#']))
        {
            let Some((key, value)) = line.split_once('=') else {
                wrong(number, format!("is {line:.40?} instead of key=value"))?;
                continue;
            };
            let (key, value) = (key.trim(), value.trim());
            let whole = |most: i64| value.parse().ok().filter(|number| (1..=most).contains(number));
            let side = || whole(1 << 16).map(|side| side as u32);
            let rate = || value.parse().ok().filter(|rate: &f64| rate.is_finite() && *rate > 0.0);
            let fits = match key {
                "name" => keep(&mut info.name, Some(Some(value.to_owned()))),
                "imDir" => {
                    let inside = path_inside(Path::new(""), value).is_ok();
                    keep(&mut info.image_folder, inside.then(|| value.to_owned()))
                }
                "frameRate" => keep(&mut info.frame_rate, rate()),
                "seqLength" => keep(&mut info.length, whole(MAX_FRAMES).map(Some)),
                "imWidth" => keep(&mut size[0], side()),
                "imHeight" => keep(&mut size[1], side()),
                _ => true,
            };
            if !fits {
                wrong(number, format!("has {value:.40?} as {key}, which is invalid; fix it"))?;
            }
        }
        info.image_size = (!size.contains(&0)).then_some(size);
        Ok(info)
    }
}

/// Sets `place` to a value, and returns whether there is one.
fn keep<T>(place: &mut T, value: Option<T>) -> bool {
    value.map(|value| *place = value).is_some()
}

impl MotSequence {
    /// Reads the files of the sequence in `folder`.
    pub(super) fn open_folder(folder: &Path, problems: &Problems) -> Result<Self> {
        let path = folder.join("seqinfo.ini");
        let info = match path.is_file() {
            true => SequenceInfo::parse(&read_text(&path)?, |line, message| {
                problems.report(Problem::at_line(&path, line, message))
            })?,
            false => SequenceInfo::default(),
        };
        let read = |names: [&str; 2], kind| {
            let path = names.map(|name| folder.join(name)).into_iter().find(|path| path.is_file());
            path.map_or(Ok(Vec::new()), |path| read_rows(&path, kind, info.length, problems))
        };
        let ground_truth = read(["gt/gt.txt", "gt.txt"], RowKind::GroundTruth)?;
        let detections = read(["det/det.txt", "det.txt"], RowKind::Detections)?;
        let images = folder.join(&info.image_folder);
        let mut sequence = Self::of_rows(name_of(folder), ground_truth, detections);
        sequence.frame_rate = info.frame_rate;
        sequence.image_size = info.image_size;
        if images.is_dir() {
            sequence.add_images(&images, info.length, problems)?;
        } else if let (Frames::Count(count), Some(length)) = (&mut sequence.frames, info.length) {
            *count = length;
        }
        Ok(sequence)
    }

    /// Reads a file of rows without images.
    pub(super) fn open_file(path: &Path, problems: &Problems) -> Result<Self> {
        let name = name_of(path);
        let name = name.rsplit_once('.').map_or(name.as_str(), |(stem, _)| stem);
        let kind = if name == "det" { RowKind::Detections } else { RowKind::GroundTruth };
        let rows = read_rows(path, kind, None, problems)?;
        Ok(match kind {
            RowKind::GroundTruth => Self::of_rows(name.to_owned(), rows, Vec::new()),
            RowKind::Detections => Self::of_rows(name.to_owned(), Vec::new(), rows),
        })
    }

    fn of_rows(name: String, ground_truth: Vec<MotRow>, detections: Vec<MotRow>) -> Self {
        let last = [&ground_truth, &detections].map(|rows| rows.last().map_or(0, |row| row.frame));
        let frames = Frames::Count(last[0].max(last[1]));
        Self { name, frame_rate: 30.0, image_size: None, frames, ground_truth, detections }
    }

    /// Adds the images in `folder`, whose names are their frame numbers.
    fn add_images(&mut self, folder: &Path, length: Option<i64>, problems: &Problems) -> Result<()> {
        let mut pictures = Vec::new();
        for name in files_in(folder, PICTURES) {
            let path = folder.join(&name);
            let stem = name.split_once('.').map_or(name.as_str(), |(stem, _)| stem);
            match stem.parse().ok().filter(|frame| (1..=MAX_FRAMES).contains(frame)) {
                Some(frame) => pictures.push((frame, path)),
                None => problems.report(Problem::new(path, "its name is not a number from 1; rename it"))?,
            }
        }
        pictures.sort_unstable();
        let mut last = 0;
        for (frame, path) in &pictures {
            if *frame != last + 1 {
                let missing =
                    format!("the image before it is number {last}; add the missing images or renumber");
                problems.report(Problem::new(path, missing))?;
            }
            last = *frame;
        }
        pictures.dedup_by_key(|(frame, _)| *frame);
        if length.is_some_and(|length| length != last) {
            let stated = length.unwrap_or_default();
            let message =
                format!("seqLength is {stated}, but the last image is number {last}; fix one of them");
            problems.report(Problem::at_key(folder.with_file_name("seqinfo.ini"), "seqLength", message))?;
        }
        self.frames = Frames::Pictures(pictures);
        Ok(())
    }

    /// Returns the name of its folder or file.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// Returns the frame rate in frames per second; 30 if it is not stated.
    pub fn frame_rate(&self) -> f64 {
        self.frame_rate
    }

    /// Returns `[width, height]` of the images in pixels, if stated.
    pub fn image_size(&self) -> Option<[u32; 2]> {
        self.image_size
    }

    /// Returns the number of frames.
    pub fn len(&self) -> usize {
        match &self.frames {
            Frames::Pictures(pictures) => pictures.len(),
            Frames::Count(count) => *count as usize,
        }
    }

    /// Returns whether there are no frames.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }

    /// Returns frame number and image file of frame `index`, from 0.
    pub(super) fn frame(&self, index: usize) -> Option<(i64, Option<&Path>)> {
        match &self.frames {
            Frames::Pictures(pictures) => {
                pictures.get(index).map(|(frame, path)| (*frame, Some(path.as_path())))
            }
            Frames::Count(count) => {
                let frame = i64::try_from(index).ok()?.checked_add(1)?;
                (frame <= *count).then_some((frame, None))
            }
        }
    }

    /// Returns the rows of `gt.txt` for frame number `frame`, including ignored objects.
    pub fn ground_truth(&self, frame: i64) -> &[MotRow] {
        rows_of(&self.ground_truth, frame)
    }

    /// Returns whether `det.txt` has any detections.
    pub fn has_detections(&self) -> bool {
        !self.detections.is_empty()
    }

    /// Returns the rows of `det.txt` for frame number `frame`.
    pub fn detections(&self, frame: i64) -> &[MotRow] {
        rows_of(&self.detections, frame)
    }
}

fn rows_of(rows: &[MotRow], frame: i64) -> &[MotRow] {
    let start = rows.partition_point(|row| row.frame < frame);
    let end = rows.partition_point(|row| row.frame <= frame);
    rows.get(start..end).unwrap_or_default()
}

/// Reads the rows of a file, sorted by frame.
fn read_rows(path: &Path, kind: RowKind, length: Option<i64>, problems: &Problems) -> Result<Vec<MotRow>> {
    let text = read_text(path)?;
    let (mut rows, mut seen) = (Vec::new(), HashSet::new());
    for (number, line) in lines(&text) {
        let row = MotRow::parse(line, kind).and_then(|row| {
            if length.is_some_and(|length| row.frame > length) {
                return Err(format!(
                    "has frame {}, but the sequence has {}",
                    row.frame,
                    length.unwrap_or_default()
                ));
            }
            if kind == RowKind::GroundTruth && !seen.insert((row.frame, row.id)) {
                return Err(format!("has object {} twice in frame {}", row.id, row.frame));
            }
            Ok(row)
        });
        match row {
            Ok(row) => rows.push(row),
            Err(message) => problems.report(Problem::at_line(path, number, message))?,
        }
    }
    rows.sort_by_key(|row| row.frame);
    Ok(rows)
}
