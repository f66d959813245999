//! KITTI's tracking benchmark.

use std::path::{Path, PathBuf};

use opendr_engine::dataset::{Dataset, DatasetIterator, Sample};
use opendr_engine::target::{
    BoundingBox3DList, TrackingAnnotation, TrackingAnnotation3D, TrackingAnnotation3DList,
    TrackingAnnotationList,
};
use opendr_engine::{Error, Header, Result, Value, ValueType};

use crate::fields::lines;
use crate::folder::{PICTURES, files_in, folders_in, past_end, read_text};
use crate::kitti::labels::{MAX_FRAMES, flat_from_boxes, track_from_line};
use crate::kitti::{Scene, folder_with};
use crate::{Format, OpenOptions, Problem, Problems, Recognition};

const FOLDERS: [&str; 3] = ["label_02", "image_02", "velodyne"];
const FRAMES_PER_SECOND: f64 = 10.0;

/// KITTI's tracking benchmark: a sample is a frame of a sequence with its objects.
///
/// The samples are the frames of one sequence after the other. Their header has the name of the sequence as frame
/// id and the time since its start (10 frames per second). Data depend on the target as in [`Kitti`](crate::Kitti).
#[derive(Debug)]
pub struct KittiTracking {
    recordings: Vec<Recording>,
    /// Index of the first sample of each sequence.
    starts: Vec<usize>,
    len: usize,
    target: ValueType,
}

#[derive(Debug)]
struct Recording {
    name: String,
    root: PathBuf,
    pictures: Vec<String>,
    clouds: Vec<String>,
    calibration: Option<PathBuf>,
    /// Sorted by frame; `None` in the test part.
    tracks: Option<Vec<TrackingAnnotation3D>>,
    len: usize,
}

impl Recording {
    fn open(root: &Path, name: &str, labelled: bool, problems: &Problems) -> Result<Self> {
        let labels = root.join("label_02").join(format!("{name}.txt"));
        let tracks = match labelled {
            true => Some(read_tracks(&labels, problems)?),
            false => None,
        };
        let pictures = files_in(&root.join("image_02").join(name), PICTURES);
        let clouds = files_in(&root.join("velodyne").join(name), &["bin"]);
        let calibration = Some(root.join("calib").join(format!("{name}.txt"))).filter(|path| path.is_file());
        let last = |names: &[String]| names.iter().filter_map(|name| frame_of(name)).max();
        let labelled = tracks.iter().flatten().filter_map(|track| track.frame).max();
        let recorded = last(&pictures).max(last(&clouds));
        if let (Some(labelled), Some(recorded)) =
            (labelled, recorded.filter(|recorded| Some(*recorded) < labelled))
        {
            let message = format!(
                "labels frame {labelled}, but the last recorded frame is {recorded}; add the missing frames"
            );
            problems.report(Problem::new(labels, message))?;
        }
        let len = recorded.or(labelled).map_or(0, |last| last as usize + 1);
        Ok(Self { name: name.to_owned(), root: root.to_owned(), pictures, clouds, calibration, tracks, len })
    }

    fn scene(&self, frame: i64) -> Scene {
        let file = |folder: &str, names: &[String]| {
            let at = names.binary_search_by_key(&Some(frame), |name| frame_of(name)).ok()?;
            Some(self.root.join(folder).join(&self.name).join(names.get(at)?))
        };
        Scene {
            picture: file("image_02", &self.pictures),
            cloud: file("velodyne", &self.clouds),
            calibration: self.calibration.clone(),
        }
    }

    fn header(&self, frame: i64) -> Header {
        Header::new((frame as f64 * 1e9 / FRAMES_PER_SECOND) as i64, self.name.as_str())
    }

    fn tracks(&self, frame: i64) -> Option<TrackingAnnotation3DList> {
        let tracks = self.tracks.as_deref()?;
        let start = tracks.partition_point(|track| track.frame < Some(frame));
        let end = tracks.partition_point(|track| track.frame <= Some(frame));
        let annotations = tracks.get(start..end).unwrap_or_default().to_vec();
        Some(TrackingAnnotation3DList { header: self.header(frame), ..annotations.into() })
    }
}

/// Returns the frame number of a file name.
fn frame_of(name: &str) -> Option<i64> {
    let number = name.split_once('.')?.0.parse().ok()?;
    (0..=MAX_FRAMES).contains(&number).then_some(number)
}

fn read_tracks(path: &Path, problems: &Problems) -> Result<Vec<TrackingAnnotation3D>> {
    let text = read_text(path)?;
    let (mut tracks, mut seen) = (Vec::new(), std::collections::HashSet::new());
    for (number, line) in lines(&text) {
        let track = track_from_line(line).and_then(|track| {
            match track.id >= 0 && !seen.insert((track.frame, track.id)) {
                true => Err(format!("has object {} twice in its frame", track.id)),
                false => Ok(track),
            }
        });
        match track {
            Ok(track) => tracks.push(track),
            Err(message) => problems.report(Problem::at_line(path, number, message))?,
        }
    }
    tracks.sort_by_key(|track| track.frame);
    Ok(tracks)
}

impl KittiTracking {
    /// Returns the index, the sequence and the frame of sample `index`.
    fn place(&self, index: usize) -> Result<(usize, &Recording, i64)> {
        let found = || {
            let at = self.starts.partition_point(|start| *start <= index).checked_sub(1)?;
            let (recording, start) = (self.recordings.get(at)?, self.starts.get(at)?);
            Some((at, recording, (index - start) as i64))
        };
        found().filter(|_| index < self.len).ok_or_else(|| past_end(index, self.len))
    }
}

impl Dataset for KittiTracking {}

impl DatasetIterator for KittiTracking {
    fn len(&self) -> usize {
        self.len
    }

    fn get(&self, index: usize) -> Result<Sample> {
        let (_, recording, frame) = self.place(index)?;
        let data = recording.scene(frame).data(self.target, &recording.header(frame))?;
        Ok(Sample { data, target: self.target(index)? })
    }

    fn target(&self, index: usize) -> Result<Option<Value>> {
        let (_, recording, frame) = self.place(index)?;
        let Some(tracks) = recording.tracks(frame) else { return Ok(None) };
        Ok(Some(match self.target {
            ValueType::TrackingAnnotationList => Value::TrackingAnnotationList(flat_from_tracks(&tracks)),
            ValueType::BoundingBox3DList => Value::BoundingBox3DList(tracks.bounding_box_3d_list()),
            ValueType::BoundingBoxList => {
                Value::BoundingBoxList(flat_from_boxes(&tracks.bounding_box_3d_list()))
            }
            _ => Value::TrackingAnnotation3DList(tracks),
        }))
    }

    fn name(&self, index: usize) -> String {
        match self.place(index) {
            Ok((_, recording, frame)) => format!("{}/{frame:06}", recording.name),
            Err(_) => index.to_string(),
        }
    }

    fn path(&self, index: usize) -> Option<PathBuf> {
        let (_, recording, frame) = self.place(index).ok()?;
        recording.scene(frame).path(self.target)
    }

    fn sequence(&self, index: usize) -> Option<usize> {
        self.place(index).ok().map(|(at, _, _)| at)
    }
}

fn flat_from_tracks(tracks: &TrackingAnnotation3DList) -> TrackingAnnotationList {
    let boxes: BoundingBox3DList = tracks.bounding_box_3d_list();
    let boxes = flat_from_boxes(&boxes).boxes.into_iter().zip(&tracks.annotations);
    let flat = boxes.map(|(bounding_box, track)| TrackingAnnotation {
        bounding_box,
        id: track.id,
        frame: track.frame,
    });
    TrackingAnnotationList { header: tracks.header.clone(), ..flat.collect::<Vec<_>>().into() }
}

impl Format for KittiTracking {
    const NAME: &'static str = "kitti_tracking";
    const ABOUT: &'static str =
        "KITTI's tracking benchmark: sequences of lidar scans and images with 3D tracks";
    const LAYOUT: &'static str = "[training|testing/] with label_02/0000.txt, image_02/0000/000000.png, \
                                  velodyne/0000/000000.bin and calib/0000.txt, as far as they exist";
    const TARGETS: &'static [ValueType] = &[
        ValueType::TrackingAnnotation3DList,
        ValueType::TrackingAnnotationList,
        ValueType::BoundingBox3DList,
        ValueType::BoundingBoxList,
    ];

    fn recognise(path: &Path) -> Recognition {
        match folder_with(path, None, &FOLDERS[..2]) {
            Ok(Some(_)) => Recognition::Certain,
            _ => Recognition::No("a folder label_02 or image_02".into()),
        }
    }

    fn read_index(path: &Path, options: &OpenOptions, problems: &Problems) -> Result<Self> {
        let target = options.target.unwrap_or(ValueType::TrackingAnnotation3DList);
        let root = folder_with(path, options.split.as_deref(), &FOLDERS)?.ok_or_else(|| {
            Error::not_found(format!("no KITTI tracks in {}; the layout is {}", path.display(), Self::LAYOUT))
        })?;
        let labels = files_in(&root.join("label_02"), &["txt"]);
        let names: Vec<_> = match labels.is_empty() {
            true => FOLDERS[1..]
                .iter()
                .map(|folder| folders_in(&root.join(folder)))
                .max_by_key(Vec::len)
                .unwrap_or_default(),
            false => labels.iter().filter_map(|name| Some(name.rsplit_once('.')?.0.to_owned())).collect(),
        };
        let (mut recordings, mut starts, mut len) = (Vec::new(), Vec::new(), 0);
        for name in names {
            let recording = Recording::open(&root, &name, !labels.is_empty(), problems)?;
            starts.push(len);
            len += recording.len;
            recordings.push(recording);
        }
        Ok(Self { recordings, starts, len, target })
    }
}
