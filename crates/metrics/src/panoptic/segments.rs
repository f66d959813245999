//! Segments of one image, and the pixels that ground truth and prediction share.

use std::collections::HashMap;

use opendr_engine::{Error, Result};

/// Id of pixels without segment.
const VOID: u32 = 0;

/// An object (thing), or the region of a class (stuff).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PanopticSegment {
    /// Id in the map; not 0.
    pub id: u32,
    /// Class index.
    pub class: u32,
    /// Whether it is a crowd: several objects that are not separated. Ground truth only.
    pub is_crowd: bool,
}

/// The segments of an image.
#[derive(Debug, Clone, Copy)]
pub struct PanopticMap<'a> {
    /// Segment id of each pixel; 0 is void.
    pub ids: &'a [u32],
    /// Table of the segments.
    pub segments: &'a [PanopticSegment],
}

/// Numbers of pixels by ground-truth and predicted segment, which are identified by their indices in the tables.
pub(super) struct Overlaps {
    /// Pixels in both segments of a pair.
    shared: HashMap<(usize, usize), u64>,
    ground_truth: Vec<u64>,
    found: Vec<u64>,
    in_void: Vec<u64>,
    in_crowd: Vec<u64>,
}

impl Overlaps {
    pub fn new(found: &PanopticMap<'_>, ground_truth: &PanopticMap<'_>) -> Result<Self> {
        if found.ids.len() != ground_truth.ids.len() {
            return Err(Error::invalid_input(format!(
                "{} predicted and {} true pixels; give maps of one size",
                found.ids.len(),
                ground_truth.ids.len()
            )));
        }
        let (indices_of_ground_truth, indices_of_found) =
            (indices("ground truth", ground_truth)?, indices("prediction", found)?);
        let mut overlaps = Self {
            shared: HashMap::new(),
            ground_truth: vec![0; ground_truth.segments.len()],
            found: vec![0; found.segments.len()],
            in_void: vec![0; found.segments.len()],
            in_crowd: vec![0; found.segments.len()],
        };
        for ((true_id, found_id), pixels) in pixels_by_pair(ground_truth.ids, found.ids) {
            let row = index("ground truth", &indices_of_ground_truth, true_id)?;
            let column = index("prediction", &indices_of_found, found_id)?;
            if let Some(row) = row {
                overlaps.ground_truth[row] += pixels;
            }
            let Some(column) = column else { continue };
            overlaps.found[column] += pixels;
            match row {
                None => overlaps.in_void[column] += pixels,
                Some(row) => {
                    overlaps.shared.insert((row, column), pixels);
                    let object = ground_truth.segments[row];
                    if object.is_crowd && object.class == found.segments[column].class {
                        overlaps.in_crowd[column] += pixels;
                    }
                }
            }
        }
        match overlaps.found.iter().position(|pixels| *pixels == 0) {
            Some(column) => Err(Error::invalid_input(format!(
                "predicted segment {} has no pixels; remove it from the table",
                found.segments[column].id
            ))),
            None => Ok(overlaps),
        }
    }

    /// Returns the indices of ground-truth and predicted segments that share pixels, with the number of shared pixels.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, u64)> {
        self.shared.iter().map(|(&(row, column), &pixels)| (row, column, pixels))
    }

    pub fn true_pixels(&self, row: usize) -> u64 {
        self.ground_truth[row]
    }

    pub fn found_pixels(&self, column: usize) -> u64 {
        self.found[column]
    }

    /// Returns the number of pixels of a predicted segment without ground truth.
    pub fn in_void(&self, column: usize) -> u64 {
        self.in_void[column]
    }

    /// Returns the number of pixels of a predicted segment in crowds of its class.
    pub fn in_crowd(&self, column: usize) -> u64 {
        self.in_crowd[column]
    }
}

/// Returns the number of pixels of each pair of ids. Neighbouring pixels are mostly equal, so runs are counted.
fn pixels_by_pair(ground_truth: &[u32], found: &[u32]) -> HashMap<(u32, u32), u64> {
    let mut counts = HashMap::new();
    let (mut pair, mut run) = ((VOID, VOID), 0);
    for next in ground_truth.iter().copied().zip(found.iter().copied()) {
        if next != pair {
            *counts.entry(pair).or_default() += run;
            (pair, run) = (next, 0);
        }
        run += 1;
    }
    *counts.entry(pair).or_default() += run;
    counts
}

fn indices(what: &str, map: &PanopticMap<'_>) -> Result<HashMap<u32, usize>> {
    let mut indices = HashMap::with_capacity(map.segments.len());
    for (at, segment) in map.segments.iter().enumerate() {
        if segment.id == VOID || indices.insert(segment.id, at).is_some() {
            return Err(Error::invalid_input(format!(
                "the table of the {what} has segment {} twice or as void; give every segment its own id from 1",
                segment.id
            )));
        }
    }
    Ok(indices)
}

/// Returns the index of a segment; `None` for void.
fn index(what: &str, indices: &HashMap<u32, usize>, id: u32) -> Result<Option<usize>> {
    match indices.get(&id) {
        None if id != VOID => Err(Error::invalid_input(format!(
            "segment {id} in the map of the {what} is not in its table; add it, or set its pixels to 0"
        ))),
        index => Ok(index.copied()),
    }
}
