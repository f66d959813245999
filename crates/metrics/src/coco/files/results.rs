//! Result files: lists of detections.

use std::io::Read;

use opendr_engine::{Error, JsonPiece, JsonStream, Result, map_in_order};

use super::batches::{Batch, Batches};
use super::entry::{Entry, needed};
use super::kind::Kind;
use super::truth::Truths;
use crate::coco::matching::Detection;

/// A detection.
pub(super) struct Found<S> {
    /// Index of the image.
    picture: u32,
    /// Category id.
    pub class: i64,
    pub detection: Detection,
    pub found: S,
}

/// Contents of a result file.
pub(super) struct Results<K: Kind> {
    found: Vec<Found<K::Found>>,
    /// Indices into `found` by image.
    order: Vec<u32>,
    /// Start of each image in `order`, and the end.
    starts: Vec<u32>,
    /// Number of detections whose category the annotations do not list.
    pub of_other_classes: u64,
}

impl<K: Kind> Results<K> {
    /// Reads the file.
    ///
    /// # Errors
    /// Returns `Io`, or `Format` with line, byte and key.
    pub(super) fn read(file: impl Read, truths: &Truths<K>, threads: usize) -> Result<Self> {
        let mut json = JsonStream::new(file);
        let mut batches = Batches::new(&mut json)?;
        let first = batches.next().transpose()?;
        // As in pycocotools, the first detection determines whether areas are those of boxes.
        let boxed = match first.as_ref().and_then(|batch| batch.pieces().next()) {
            Some(piece) => Entry::read(&piece, Default::default())?.bounds.is_some(),
            None => false,
        };
        let (mut found, mut of_other_classes) = (Vec::new(), 0);
        let work = |(): &mut (), batch: Result<Batch>| -> Result<(Vec<_>, u64)> {
            let (mut found, mut of_other_classes) = (Vec::new(), 0);
            for piece in batch?.pieces() {
                match one(&piece, truths, boxed)? {
                    Some(one) => found.push(one),
                    None => of_other_classes += 1,
                }
            }
            Ok((found, of_other_classes))
        };
        let batches = first.into_iter().map(Ok).chain(batches);
        map_in_order(&mut vec![(); threads], batches, work, |batch| -> Result<()> {
            let (some, others) = batch?;
            found.extend(some);
            of_other_classes += others;
            match u32::try_from(found.len()) {
                Ok(_) => Ok(()),
                Err(_) => Err(Error::unsupported("more than 2^32 detections; split the file")),
            }
        })?;
        json.end()?;
        Ok(Self::sorted(found, truths.pictures(), of_other_classes))
    }

    fn sorted(found: Vec<Found<K::Found>>, pictures: usize, of_other_classes: u64) -> Self {
        let mut starts = vec![0u32; pictures + 1];
        for one in &found {
            starts[one.picture as usize + 1] += 1;
        }
        for at in 0..pictures {
            starts[at + 1] += starts[at];
        }
        let (mut next, mut order) = (starts.clone(), vec![0; found.len()]);
        for (at, one) in (0..).zip(&found) {
            let place = &mut next[one.picture as usize];
            order[*place as usize] = at;
            *place += 1;
        }
        Self { found, order, starts, of_other_classes }
    }

    /// Returns the number of detections.
    pub(super) fn detections(&self) -> usize {
        self.found.len()
    }

    /// Returns the detections in image `place`, in the order of the file.
    pub(super) fn of_picture(&self, place: u32) -> impl Iterator<Item = &Found<K::Found>> {
        let place = place as usize;
        self.order[self.starts[place] as usize..self.starts[place + 1] as usize]
            .iter()
            .map(|at| &self.found[*at as usize])
    }
}

/// Parses a detection; `None` if the annotations do not list its category.
fn one<K: Kind>(piece: &JsonPiece<'_>, truths: &Truths<K>, boxed: bool) -> Result<Option<Found<K::Found>>> {
    let mut entry = Entry::read(piece, K::FIELDS)?;
    let mut read = || {
        let id = needed(entry.picture, "image_id")?;
        let picture = truths.place(id).ok_or_else(|| {
            Error::format(format!(
                "image_id {id} is not among the images of the annotations; give results of these images"
            ))
        })?;
        let class = needed(entry.class, "category_id")?;
        let score = needed(entry.score, "score")?;
        if !truths.classes.contains_key(&class) {
            return Ok(None);
        }
        let (found, own) = K::found(&mut entry, truths.size(picture))?;
        let area = match entry.bounds.filter(|_| boxed) {
            Some([_, _, width, height]) => width * height,
            None => own,
        };
        Ok(Some(Found { picture, class, detection: Detection { score, area }, found }))
    };
    read().map_err(|error: Error| piece.error_at(0, error.message()))
}
