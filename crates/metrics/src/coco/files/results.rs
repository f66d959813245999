//! Result files: lists of detections.

use std::io::Read;

use opendr_engine::{Error, JsonPiece, JsonStream, Result, map_in_order};

use super::batches::{Batch, Batches};
use super::entry::{Entry, needed};
use super::ground_truth::GroundTruths;
use super::kind::Kind;
use crate::coco::matching::Detection;

/// A detection.
pub(super) struct ScoredDetection<S> {
    /// Index of the image.
    image: u32,
    /// Category id.
    pub class: i64,
    pub detection: Detection,
    pub detected: S,
}

/// Contents of a result file.
pub(super) struct Results<K: Kind> {
    detections: Vec<ScoredDetection<K::Detected>>,
    /// Indices into `detections` by image.
    order: Vec<u32>,
    /// Start of each image in `order`, and the end.
    starts: Vec<u32>,
    /// Number of detections whose category the annotations do not list.
    pub unlisted: u64,
}

impl<K: Kind> Results<K> {
    /// Reads the file.
    ///
    /// # Errors
    /// Returns `Io`, or `Format` with line, byte and key.
    pub(super) fn read(file: impl Read, ground_truths: &GroundTruths<K>, threads: usize) -> Result<Self> {
        let mut json = JsonStream::new(file);
        let mut batches = Batches::new(&mut json)?;
        let first = batches.next().transpose()?;
        // As in pycocotools, the first detection determines whether areas are those of boxes.
        let boxed = match first.as_ref().and_then(|batch| batch.pieces().next()) {
            Some(piece) => Entry::read(&piece, Default::default())?.bounds.is_some(),
            None => false,
        };
        let (mut detections, mut unlisted) = (Vec::new(), 0);
        let work = |(): &mut (), batch: Result<Batch>| -> Result<(Vec<_>, u64)> {
            let (mut detections, mut unlisted) = (Vec::new(), 0);
            for piece in batch?.pieces() {
                match detection(&piece, ground_truths, boxed)? {
                    Some(detection) => detections.push(detection),
                    None => unlisted += 1,
                }
            }
            Ok((detections, unlisted))
        };
        let batches = first.into_iter().map(Ok).chain(batches);
        map_in_order(&mut vec![(); threads], batches, work, |batch| -> Result<()> {
            let (some, others) = batch?;
            detections.extend(some);
            unlisted += others;
            match u32::try_from(detections.len()) {
                Ok(_) => Ok(()),
                Err(_) => Err(Error::unsupported("more than 2^32 detections; split the file")),
            }
        })?;
        json.end()?;
        Ok(Self::sorted(detections, ground_truths.images(), unlisted))
    }

    fn sorted(detections: Vec<ScoredDetection<K::Detected>>, images: usize, unlisted: u64) -> Self {
        let mut starts = vec![0u32; images + 1];
        for detection in &detections {
            starts[detection.image as usize + 1] += 1;
        }
        for at in 0..images {
            starts[at + 1] += starts[at];
        }
        let (mut next, mut order) = (starts.clone(), vec![0; detections.len()]);
        for (at, detection) in (0..).zip(&detections) {
            let index = &mut next[detection.image as usize];
            order[*index as usize] = at;
            *index += 1;
        }
        Self { detections, order, starts, unlisted }
    }

    /// Returns the number of detections.
    pub(super) fn detections(&self) -> usize {
        self.detections.len()
    }

    /// Returns the detections in image `index`, in the order of the file.
    pub(super) fn of_image(&self, index: u32) -> impl Iterator<Item = &ScoredDetection<K::Detected>> {
        let index = index as usize;
        self.order[self.starts[index] as usize..self.starts[index + 1] as usize]
            .iter()
            .map(|at| &self.detections[*at as usize])
    }
}

/// Parses a detection; `None` if the annotations do not list its category.
fn detection<K: Kind>(
    piece: &JsonPiece<'_>,
    ground_truths: &GroundTruths<K>,
    boxed: bool,
) -> Result<Option<ScoredDetection<K::Detected>>> {
    let mut entry = Entry::read(piece, K::FIELDS)?;
    let mut read = || {
        let id = needed(entry.image, "image_id")?;
        let image = ground_truths.index(id).ok_or_else(|| {
            Error::format(format!(
                "image_id {id} is not among the images of the annotations; give results of these images"
            ))
        })?;
        let class = needed(entry.class, "category_id")?;
        let score = needed(entry.score, "score")?;
        if !ground_truths.classes.contains_key(&class) {
            return Ok(None);
        }
        let (detected, own) = K::detected(&mut entry, ground_truths.size(image))?;
        let area = match entry.bounds.filter(|_| boxed) {
            Some([_, _, width, height]) => width * height,
            None => own,
        };
        Ok(Some(ScoredDetection { image, class, detection: Detection { score, area }, detected }))
    };
    read().map_err(|error: Error| piece.error_at(0, error.message()))
}
