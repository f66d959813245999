//! Any tracks as sequences of the MOT Challenge.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use opendr_engine::dataset::{DatasetIterator, Sample};
use opendr_engine::target::TrackingAnnotationList;
use opendr_engine::{Error, Progress, Result, Unit, Value};
use opendr_vision::Encoder;

use crate::folder::{path_inside, write_file};
use crate::mot::row::{CLASSES, PEDESTRIAN};
use crate::{Problem, Problems, WriteOptions};

/// Pictures are written as JPEG, as the challenge has them.
const JPEG_QUALITY: u8 = 95;

/// One sequence, as far as it is written.
#[derive(Default)]
struct Unfinished {
    folder: PathBuf,
    name: String,
    truth: String,
    pictures: i64,
    image_size: Option<[usize; 2]>,
}

/// A sequence goes on as long as the frame id of the header stays; pictures are numbered anew from 1.
pub(super) fn write(
    dataset: &dyn DatasetIterator,
    path: &Path,
    options: &WriteOptions,
    problems: &Problems,
    progress: &dyn Progress,
) -> Result<()> {
    let part =
        path_inside(path, options.split.as_deref().unwrap_or("train")).map_err(Error::invalid_param)?;
    progress.begin("writing MOT", Some(dataset.len() as u64), Unit::Items);
    let mut sequence: Option<Unfinished> = None;
    for index in 0..dataset.len() {
        if progress.stopped() {
            break;
        }
        let written = dataset.get(index).and_then(|sample| add(&mut sequence, &part, sample));
        if let Err(error) = written {
            problems.report(Problem::at_key(path, format!("sample {index}"), error.to_string()))?;
        }
        progress.advance(1);
    }
    progress.end();
    sequence.map_or(Ok(()), Unfinished::finish)
}

fn add(sequence: &mut Option<Unfinished>, part: &Path, sample: Sample) -> Result<()> {
    let tracks = match sample.target {
        Some(Value::TrackingAnnotationList(tracks)) => tracks,
        _ => return Err(Error::invalid_input("no tracks; MOT holds a TrackingAnnotationList a sample")),
    };
    let name = tracks.header.frame_id.as_deref().unwrap_or("sequence");
    if sequence.as_ref().is_none_or(|current| current.name != name) {
        let folder = path_inside(part, name).map_err(Error::invalid_input)?;
        let begun = Unfinished { folder, name: name.to_owned(), ..Unfinished::default() };
        if let Some(done) = sequence.replace(begun) {
            done.finish()?;
        }
    }
    let Some(current) = sequence else { return Ok(()) };
    let truth = truth_text(&tracks, current.pictures + 1)?;
    if let Some(Value::Image(image)) = sample.data.first() {
        let file = current.folder.join(format!("img1/{:06}.jpg", current.pictures + 1));
        std::fs::create_dir_all(current.folder.join("img1"))?;
        Encoder { jpeg_quality: JPEG_QUALITY }.save(image, file)?;
        current.image_size = Some([image.width(), image.height()]);
    }
    current.pictures += 1;
    current.truth += &truth;
    Ok(())
}

/// Lines of nine fields; what is seen of an object is not known, hence 1.
fn truth_text(tracks: &TrackingAnnotationList, frame: i64) -> Result<String> {
    let mut text = String::new();
    for track in &tracks.annotations {
        let found = &track.bounding_box;
        if track.id < 0 || !track.mot().iter().all(|number| number.is_finite()) {
            return Err(Error::invalid_input(format!(
                "{track:#} is no object of a truth; give it an identity"
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
        write_file(&self.folder.join("gt/gt.txt"), self.truth.as_bytes())
    }
}
