//! Writer of tracks as sequences of the MOT Challenge.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::target::TrackingAnnotationList;
use opendr_engine::{Error, Progress, Result, Value};

use crate::folder::{path_inside, write_file, write_picture};
use crate::mot::row::{CLASSES, PEDESTRIAN};
use crate::picture_files::write_each;
use crate::{Problems, WriteOptions};

/// A sequence being written.
#[derive(Default)]
struct Unfinished {
    folder: PathBuf,
    name: String,
    ground_truth: String,
    detections: String,
    pictures: i64,
    image_size: Option<[usize; 2]>,
}

/// Writes `dataset`; frames are numbered from 1.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let part =
        path_inside(path, options.split.as_deref().unwrap_or("train")).map_err(Error::invalid_param)?;
    let mut current: Option<Unfinished> = None;
    write_each(dataset, problems, progress, |index| {
        if index == 0 || dataset.sequence(index) != dataset.sequence(index - 1) {
            current.take().map_or(Ok(()), Unfinished::finish)?;
        }
        let sample = dataset.get(index)?;
        let sequence = match &mut current {
            Some(sequence) => sequence,
            None => current.insert(Unfinished::begin(&part, dataset, index, &sample)?),
        };
        sequence.add(dataset, index, &sample, options.link)
    })?;
    current.map_or(Ok(()), Unfinished::finish)
}

/// Returns lines of nine fields; the visibility is unknown and written as 1.
fn truth_text(tracks: &TrackingAnnotationList, frame: i64) -> Result<String> {
    let mut text = String::new();
    for track in &tracks.annotations {
        let found = &track.bounding_box;
        if track.id < 0 || !track.mot().iter().all(|number| number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "{track:#} cannot be written as ground truth; it needs an identity and finite values"
            )));
        }
        let label =
            tracks.classes.label(&found.name).map(str::to_owned).unwrap_or_else(|| found.name.to_string());
        let class = CLASSES.iter().position(|class| *class == label).map_or(PEDESTRIAN, |class| class as i64);
        let considered = i32::from(found.confidence != 0.0);
        let (left, top, width, height) = (found.left, found.top, found.width, found.height);
        // Writing to a String cannot fail.
        writeln!(text, "{frame},{},{left},{top},{width},{height},{considered},{class},1", track.id).ok();
    }
    Ok(text)
}

impl Unfinished {
    /// Starts a sequence, named by the frame id of its first target.
    fn begin(part: &Path, dataset: &dyn DatasetIterator, index: usize, sample: &Sample) -> Result<Self> {
        let named = sample.target.as_ref().and_then(|target| target.header().frame_id.clone());
        let number = dataset.sequence(index).unwrap_or(0);
        let name = named.map_or_else(|| format!("{number:04}"), |name| name.to_string());
        let folder = path_inside(part, &name).map_err(Error::invalid_input)?;
        Ok(Self { folder, name, ..Self::default() })
    }

    fn add(
        &mut self,
        dataset: &dyn DatasetIterator,
        index: usize,
        sample: &Sample,
        link: bool,
    ) -> Result<()> {
        let Some(Value::TrackingAnnotationList(tracks)) = &sample.target else {
            return Err(Error::invalid_input("the sample has no tracks; MOT needs a TrackingAnnotationList"));
        };
        let ground_truth = truth_text(tracks, self.pictures + 1)?;
        if let Some(Value::Image(image)) = sample.data.first() {
            let file = self.folder.join(format!("img1/{:06}.jpg", self.pictures + 1));
            write_picture(dataset.path(index).as_deref(), image, &file, link)?;
            self.image_size = Some([image.width(), image.height()]);
        }
        let lists = sample.data.iter().filter_map(|datum| match datum {
            Value::BoundingBoxList(list) => Some(list),
            _ => None,
        });
        for one in
            lists.flat_map(|list| &list.boxes).filter(|one| one.corners().iter().all(|edge| edge.is_finite()))
        {
            let (frame, confidence) = (self.pictures + 1, one.confidence);
            // Writing to a String cannot fail.
            writeln!(
                self.detections,
                "{frame},-1,{},{},{},{},{confidence}",
                one.left, one.top, one.width, one.height
            )
            .ok();
        }
        self.pictures += 1;
        self.ground_truth += &ground_truth;
        Ok(())
    }

    fn finish(self) -> Result<()> {
        let mut info = format!(
            "[Sequence]\nname={}\nimDir=img1\nframeRate=30\nseqLength={}\n",
            self.name, self.pictures
        );
        if let Some([width, height]) = self.image_size {
            // Writing to a String cannot fail.
            writeln!(info, "imWidth={width}\nimHeight={height}\nimExt=.jpg").ok();
        }
        write_file(&self.folder.join("seqinfo.ini"), info.as_bytes())?;
        if !self.detections.is_empty() {
            write_file(&self.folder.join("det/det.txt"), self.detections.as_bytes())?;
        }
        write_file(&self.folder.join("gt/gt.txt"), self.ground_truth.as_bytes())
    }
}
