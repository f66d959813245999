//! MOT Challenge: videos with tracks, and files of results.

use std::path::{Path, PathBuf};
use std::sync::Arc;

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{BoundingBoxList, Classes, TrackingAnnotationList};
use opendr_engine::{Error, Header, Progress, Result, ResultExt, Value, ValueType};

use crate::folder::{files_in, folders_in, part_folder, past_end, read_text, write_file};
use crate::{Format, OpenOptions, Problems, Recognition, WriteOptions};

mod row;
mod sequence;
mod write;

pub use row::MotRow;
pub use sequence::MotSequence;

/// Names of the parts, those with ground truth first.
const PARTS: [&str; 3] = ["val", "train", "test"];
/// Bytes of a text file that are read to check whether it has rows.
const HEAD: usize = 4096;

/// A data set of the MOT Challenge, of motmetrics, or a bare `gt.txt`: a sample is a frame with its objects.
///
/// The samples are the frames of one sequence after the other. The header of image and target has the name of the
/// sequence as frame id, and the time since its start. The data of a sample are its image, if there are images,
/// and, if the target type is tracks and the sequence has detections, the detections of `det.txt`, the input of
/// trackers. Ignored objects have confidence 0 in the ground truth; they are dropped if the target type is boxes.
#[derive(Debug)]
pub struct Mot {
    sequences: Vec<MotSequence>,
    /// Index of the first sample of each sequence.
    starts: Vec<usize>,
    len: usize,
    target: ValueType,
    classes: Classes,
}

impl Mot {
    /// Returns the sequences in order.
    pub fn sequences(&self) -> &[MotSequence] {
        &self.sequences
    }

    /// Returns the indices of the sequence and of the frame in it for sample `index`, both from 0.
    pub fn sequence_and_frame(&self, index: usize) -> Option<(usize, usize)> {
        let sequence = self.starts.partition_point(|start| *start <= index).checked_sub(1)?;
        (index < self.len).then(|| (sequence, index - self.starts[sequence]))
    }

    /// Returns the detections of `det.txt` for sample `index`, the input of trackers.
    pub fn detections(&self, index: usize) -> Option<BoundingBoxList> {
        let (at, picture) = self.sequence_and_frame(index)?;
        let sequence = self.sequences.get(at)?;
        let (frame, _) = sequence.frame(picture)?;
        let boxes = sequence.detections(frame).iter().map(|row| row.annotation().bounding_box);
        let header = header(sequence, frame);
        Some(BoundingBoxList { header, classes: self.classes.clone(), ..boxes.collect::<Vec<_>>().into() })
    }

    /// Returns the sequence, frame number and image of sample `index`.
    fn frame(&self, index: usize) -> Result<(&MotSequence, i64, Option<&Path>)> {
        let frame = self.sequence_and_frame(index).and_then(|(at, picture)| {
            let sequence = self.sequences.get(at)?;
            sequence.frame(picture).map(|(frame, path)| (sequence, frame, path))
        });
        frame.ok_or_else(|| past_end(index, self.len))
    }

    fn of_sequences(sequences: Vec<MotSequence>, target: ValueType) -> Self {
        let (mut starts, mut len) = (Vec::with_capacity(sequences.len()), 0);
        for sequence in &sequences {
            starts.push(len);
            len += sequence.len();
        }
        Self { sequences, starts, len, target, classes: row::classes() }
    }
}

impl Dataset for Mot {}

impl DatasetIterator for Mot {
    fn len(&self) -> usize {
        self.len
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (sequence, frame, path) = self.frame(index)?;
        let image = path.map(opendr_vision::open).transpose()?;
        let image = image.map(|image| Value::Image(image.with_header(header(sequence, frame))));
        let is_tracked = self.target != ValueType::BoundingBoxList && sequence.has_detections();
        let detections = self.detections(index).filter(|_| is_tracked).map(Value::BoundingBoxList);
        let data = image.into_iter().chain(detections).collect();
        Ok(Sample { data, target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let (sequence, frame, _) = self.frame(index)?;
        let (header, classes) = (header(sequence, frame), self.classes.clone());
        let annotations = sequence.ground_truth(frame).iter().map(MotRow::annotation).collect();
        let tracks = TrackingAnnotationList { header, annotations, classes, action: None };
        Ok(Some(match self.target {
            ValueType::BoundingBoxList => {
                let mut boxes = tracks.bounding_box_list();
                boxes.boxes.retain(|found| found.confidence != 0.0);
                Value::BoundingBoxList(boxes)
            }
            _ => Value::TrackingAnnotationList(tracks),
        }))
    }

    fn name(&self, index: usize) -> String {
        match self.frame(index) {
            Ok((sequence, frame, _)) => format!("{}/{frame:06}", sequence.name()),
            Err(_) => index.to_string(),
        }
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        self.frame(index).ok()?.2.map(Path::to_owned)
    }

    fn image_size(&self, index: usize) -> Option<[u32; 2]> {
        self.sequences.get(self.sequence_and_frame(index)?.0)?.image_size()
    }

    fn sequence(&self, index: usize) -> Option<usize> {
        self.sequence_and_frame(index).map(|(sequence, _)| sequence)
    }

    fn classes(&self) -> Classes {
        self.classes.clone()
    }
}

fn header(sequence: &MotSequence, frame: i64) -> Header {
    let stamp_ns = ((frame - 1) as f64 / sequence.frame_rate() * 1e9).round();
    Header::new(stamp_ns as i64, Arc::from(sequence.name()))
}

impl Format for Mot {
    const NAME: &'static str = "mot";
    const ALIASES: &'static [&'static str] = &["mot15", "mot16", "mot17", "mot20", "motchallenge"];
    const ABOUT: &'static str = "MOT Challenge: videos with tracked boxes";
    const LAYOUT: &'static str = "[PART/]SEQUENCE/ with img1/000001.jpg, gt/gt.txt, det/det.txt and seqinfo.ini, as far as they exist; or \
                                  SEQUENCE/gt.txt; or SEQUENCE.txt files";
    const TARGETS: &'static [ValueType] = &[ValueType::TrackingAnnotationList, ValueType::BoundingBoxList];

    fn recognise(path: &Path) -> Recognition {
        let folders = candidates(path);
        if folders.iter().any(|folder| is_sequence(folder)) {
            return Recognition::Certain;
        }
        match bare_files(path).is_empty() {
            true => Recognition::No("a folder with gt/gt.txt or det/det.txt, or a text of its rows".into()),
            false => Recognition::Possible,
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let target = options.target.unwrap_or(ValueType::TrackingAnnotationList);
        let part = part_folder(path, options.split.as_deref(), &PARTS)?;
        let root = part.as_deref().unwrap_or(path);
        let folders: Vec<_> = candidates(root).into_iter().filter(|folder| is_sequence(folder)).collect();
        let sequences: Result<Vec<_>> = match folders.is_empty() {
            true => bare_files(root).iter().map(|file| MotSequence::open_file(file, problems)).collect(),
            false => folders.iter().map(|folder| MotSequence::open_folder(folder, problems)).collect(),
        };
        let sequences = sequences?;
        if sequences.is_empty() {
            let message = format!("no sequence in {}; the layout is {}", root.display(), Self::LAYOUT);
            return Err(Error::not_found(message));
        }
        Ok(Self::of_sequences(sequences, target))
    }

    fn write(
        dataset: &dyn DatasetIterator,
        path: &Path,
        options: &WriteOptions,
        problems: &Problems,
        progress: &dyn Progress,
    ) -> Result<()> {
        write::write(dataset, path, options, problems, progress)
    }
}

/// Returns the folders that may be sequences: `path`, its folders, and those of its usual parts.
fn candidates(path: &Path) -> Vec<PathBuf> {
    let mut found = vec![path.to_owned()];
    let within =
        |folder: &Path| folders_in(folder).into_iter().map(|name| folder.join(name)).collect::<Vec<_>>();
    found.extend(within(path));
    found.extend(PARTS.iter().flat_map(|part| within(&path.join(part))));
    found
}

fn is_sequence(folder: &Path) -> bool {
    ["gt/gt.txt", "det/det.txt", "gt.txt", "seqinfo.ini"].iter().any(|name| folder.join(name).is_file())
}

/// Returns text files of rows: `path` itself, or the files in it, if the first has rows.
fn bare_files(path: &Path) -> Vec<PathBuf> {
    let files = match path.is_dir() {
        true => files_in(path, &["txt"]).into_iter().map(|name| path.join(name)).collect(),
        false => vec![path.to_owned()],
    };
    let has_rows = |file: &PathBuf| {
        use std::io::Read;
        let mut head = Vec::new();
        let opened = std::fs::File::open(file).ok()?;
        opened.take(HEAD as u64).read_to_end(&mut head).ok()?;
        let line = String::from_utf8_lossy(&head).lines().next()?.to_owned();
        let fields =
            line.split(',').map(|field| field.trim().parse::<f64>()).collect::<Result<Vec<_>, _>>().ok()?;
        (6..=10).contains(&fields.len()).then_some(())
    };
    if files.first().is_some_and(|file| has_rows(file).is_some()) { files } else { Vec::new() }
}

/// Reads a file of results, or of ground truth without class and visibility, as one list over all frames.
///
/// # Errors
/// `NotFound` or `Io` if it cannot be read; `Format` with the line number.
pub fn open_mot_results(path: impl AsRef<Path>) -> Result<TrackingAnnotationList> {
    let path = path.as_ref();
    let text = read_text(path)?;
    TrackingAnnotationList::from_mot_text(&text).context(|| path.display().to_string())
}

/// Writes the tracks of one video for motmetrics and TrackEval: ten fields per line.
///
/// # Errors
/// `InvalidInput` for a track without frame number or identity, or with a value that is not finite; `Io`.
pub fn write_mot_results(path: impl AsRef<Path>, tracks: &TrackingAnnotationList) -> Result<()> {
    for (index, track) in tracks.annotations.iter().enumerate() {
        let numbers = track.mot();
        if track.frame.is_none_or(|frame| frame < 1) || track.id < 0 || !numbers.iter().all(|n| n.is_finite())
        {
            return Err(Error::invalid_input(format!(
                "track {index} is {numbers:?}; it needs a frame number from 1, an identity from 0 and finite values"
            )));
        }
    }
    write_file(path.as_ref(), tracks.mot_text().as_bytes())
}

/// Runs every parser of lines, for the fuzzers.
pub(crate) fn parse_any(text: &str) {
    let _ = sequence::SequenceInfo::parse(text, |_, _| Ok(()));
    for line in text.lines() {
        let _ = MotRow::parse(line, row::RowKind::GroundTruth);
        let _ = MotRow::parse(line, row::RowKind::Detections);
    }
}

#[cfg(test)]
mod tests;
