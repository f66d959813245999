//! Segments of one picture, and the pixels that those of truth and answer share.

use std::collections::HashMap;

use opendr_engine::{Error, Result};

/// The number of pixels that belong to no segment.
const VOID: u32 = 0;

/// One object, or the region of one class.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct PanopticSegment {
    /// Its number in the map; not 0.
    pub id: u32,
    /// Its class.
    pub class: u32,
    /// Whether it is a crowd: several objects that are not told apart. Only in truth.
    pub is_crowd: bool,
}

/// A picture's segments.
#[derive(Debug, Clone, Copy)]
pub struct PanopticMap<'a> {
    /// The number of each pixel's segment; 0 is void.
    pub ids: &'a [u32],
    /// The table of segments.
    pub segments: &'a [PanopticSegment],
}

/// Pixels by true and found segment, which are known by their places in the tables.
pub(super) struct Overlaps {
    /// Where both are in a segment.
    shared: HashMap<(usize, usize), u64>,
    truth: Vec<u64>,
    found: Vec<u64>,
    in_void: Vec<u64>,
    in_crowd: Vec<u64>,
}

impl Overlaps {
    pub fn new(found: &PanopticMap<'_>, truth: &PanopticMap<'_>) -> Result<Self> {
        if found.ids.len() != truth.ids.len() {
            return Err(Error::invalid_input(format!(
                "{} found and {} true pixels; give maps of one size",
                found.ids.len(),
                truth.ids.len()
            )));
        }
        let (places_of_truth, places_of_found) = (places("truth", truth)?, places("answer", found)?);
        let mut overlaps = Self {
            shared: HashMap::new(),
            truth: vec![0; truth.segments.len()],
            found: vec![0; found.segments.len()],
            in_void: vec![0; found.segments.len()],
            in_crowd: vec![0; found.segments.len()],
        };
        for ((true_id, found_id), pixels) in pixels_by_pair(truth.ids, found.ids) {
            let row = place("truth", &places_of_truth, true_id)?;
            let column = place("answer", &places_of_found, found_id)?;
            if let Some(row) = row {
                overlaps.truth[row] += pixels;
            }
            let Some(column) = column else { continue };
            overlaps.found[column] += pixels;
            match row {
                None => overlaps.in_void[column] += pixels,
                Some(row) => {
                    overlaps.shared.insert((row, column), pixels);
                    let object = truth.segments[row];
                    if object.is_crowd && object.class == found.segments[column].class {
                        overlaps.in_crowd[column] += pixels;
                    }
                }
            }
        }
        match overlaps.found.iter().position(|pixels| *pixels == 0) {
            Some(column) => Err(Error::invalid_input(format!(
                "found segment {} has no pixel; leave it out of the table",
                found.segments[column].id
            ))),
            None => Ok(overlaps),
        }
    }

    /// Places of true and found segment that share pixels, and how many.
    pub fn pairs(&self) -> impl Iterator<Item = (usize, usize, u64)> {
        self.shared.iter().map(|(&(row, column), &pixels)| (row, column, pixels))
    }

    pub fn true_pixels(&self, row: usize) -> u64 {
        self.truth[row]
    }

    pub fn found_pixels(&self, column: usize) -> u64 {
        self.found[column]
    }

    /// Pixels of a found segment for which there is no truth.
    pub fn in_void(&self, column: usize) -> u64 {
        self.in_void[column]
    }

    /// Pixels of a found segment in crowds of its class.
    pub fn in_crowd(&self, column: usize) -> u64 {
        self.in_crowd[column]
    }
}

/// Neighbours are mostly alike, so runs are counted.
fn pixels_by_pair(truth: &[u32], found: &[u32]) -> HashMap<(u32, u32), u64> {
    let mut counts = HashMap::new();
    let (mut pair, mut run) = ((VOID, VOID), 0);
    for next in truth.iter().copied().zip(found.iter().copied()) {
        if next != pair {
            *counts.entry(pair).or_default() += run;
            (pair, run) = (next, 0);
        }
        run += 1;
    }
    *counts.entry(pair).or_default() += run;
    counts
}

fn places(whose: &str, map: &PanopticMap<'_>) -> Result<HashMap<u32, usize>> {
    let mut places = HashMap::with_capacity(map.segments.len());
    for (at, segment) in map.segments.iter().enumerate() {
        if segment.id == VOID || places.insert(segment.id, at).is_some() {
            return Err(Error::invalid_input(format!(
                "the table of the {whose} has segment {} twice or as void; give every segment its own number from 1",
                segment.id
            )));
        }
    }
    Ok(places)
}

/// The place of a segment; `None` for void.
fn place(whose: &str, places: &HashMap<u32, usize>, id: u32) -> Result<Option<usize>> {
    match places.get(&id) {
        None if id != VOID => Err(Error::invalid_input(format!(
            "segment {id} of the {whose}'s map is not in its table; add it, or give its pixels the number 0"
        ))),
        place => Ok(place.copied()),
    }
}
