//! Fusion of class maps, boxes and person masks to one panoptic map.
//!
//! A pixel of a thing class is assigned to the box of that class with the nearest centre, relative to the box's size; a pixel
//! of a person to the box of the person given by the person masks, where there is one. Connected regions of a thing class
//! outside of all boxes are objects if they are large ([`Components`]). Boxes of classes without a class map are filled
//! completely, smaller ones over larger ones. The remaining pixels are stuff.

use opendr_segmentation::instance_segmentation::OwnerMap;
use opendr_vision::components::{Components, Connectivity};

/// A label is this times its class plus the index of the object within its class.
pub(super) const LABEL_DIVISOR: u32 = 1000;
/// Label of void.
pub(super) const VOID: u32 = 255 * LABEL_DIVISOR;

/// Margin around a box within which pixels may belong to it, as a share of the image's longer side.
const MARGIN: f32 = 8.0 / 640.0;
/// Minimum IoU of a detected person's box and the box around a person mask.
const LEAST_IOU: f32 = 0.3;
/// Maximum number of boxes; further boxes are not used.
const MOST: usize = 999;

/// A detected object of a thing class.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Thing {
    pub class: u32,
    /// `[left, top, right, bottom]` in pixels.
    pub corners: [f32; 4],
}

/// Predictions of the networks.
pub(super) struct Predictions<'a> {
    /// Width and height of the image.
    pub size: [usize; 2],
    /// Thing map: a class of its network for each pixel, and the table to the classes of the fusion.
    pub things: &'a [u32],
    pub of_things: &'a [Option<u32>],
    /// Stuff map, and the table to the classes of the fusion.
    pub stuff: &'a [u32],
    pub of_stuff: &'a [Option<u32>],
    /// Person of each pixel, and the class of persons.
    pub persons: &'a OwnerMap,
    pub person: Option<u32>,
}

/// Thresholds; shares as in the learner's parameters.
pub(super) struct Rules {
    pub box_masks: bool,
    pub min_overlap: f32,
    pub min_leftover: f32,
    pub min_stuff: f32,
}

/// Buffers of the fusion.
#[derive(Debug, Default)]
pub(super) struct Fusion {
    /// Index of the box of each pixel, from 1.
    claims: Vec<u16>,
    pixels: Vec<u32>,
    /// Box of each person of the person masks.
    of_persons: Vec<Option<u16>>,
    order: Vec<usize>,
    /// Label of each box; `None` for a dropped box.
    labels: Vec<Option<u32>>,
    /// Number of objects of each class so far.
    counts: Vec<u32>,
    components: Components,
    of_components: Vec<Option<u32>>,
}

impl Fusion {
    /// Writes the label of each pixel. `things` are sorted by score.
    pub fn run(
        &mut self,
        predictions: &Predictions<'_>,
        things: &[Thing],
        rules: &Rules,
        labels: &mut [u32],
    ) {
        let things = &things[..things.len().min(MOST)];
        let total = labels.len() as f32;
        self.counts.clear();
        self.match_persons(predictions, things);
        self.claim(predictions, things);
        self.number_boxes(predictions, things, rules);
        for (label, claim) in labels.iter_mut().zip(&self.claims) {
            *label = usize::from(*claim).checked_sub(1).and_then(|at| self.labels[at]).unwrap_or(VOID);
        }
        self.add_leftovers(predictions, rules.min_leftover * total, labels);
        if rules.box_masks {
            self.fill_boxes(predictions, things, labels);
        }
        self.add_stuff(predictions, rules.min_stuff * total, labels);
    }

    /// Assigns a box to each person of the person masks.
    fn match_persons(&mut self, predictions: &Predictions<'_>, things: &[Thing]) {
        self.of_persons.clear();
        for object in 1..=u8::MAX {
            let best = predictions.persons.corners(object).and_then(|corners| {
                let persons =
                    things.iter().enumerate().filter(|(_, thing)| Some(thing.class) == predictions.person);
                let ranked = persons.map(|(at, thing)| (iou(corners, thing.corners), at as u16));
                ranked.filter(|(iou, _)| *iou >= LEAST_IOU).max_by(|one, other| one.0.total_cmp(&other.0))
            });
            self.of_persons.push(best.map(|(_, at)| at));
        }
    }

    /// Assigns a box to each pixel of a thing class.
    fn claim(&mut self, predictions: &Predictions<'_>, things: &[Thing]) {
        let [width, height] = predictions.size;
        let margin = MARGIN * width.max(height) as f32;
        self.claims.clear();
        self.claims.resize(predictions.things.len(), 0);
        self.pixels.clear();
        self.pixels.resize(things.len(), 0);
        for (at, claim) in self.claims.iter_mut().enumerate() {
            let Some(class) = predictions.thing(at) else { continue };
            let place = [at % width, at / width].map(|at| at as f32 + 0.5);
            let owner = match Some(class) == predictions.person {
                true => predictions.persons.owners().get(at).and_then(|owner| owner.checked_sub(1)),
                false => None,
            };
            let of_person = owner.and_then(|owner| self.of_persons[usize::from(owner)]);
            let is_inside = |number: &u16| off(place, things[usize::from(*number)].corners, margin) < 1.0;
            let nearest = || {
                let near = things.iter().zip(0..).filter(|(thing, _)| thing.class == class);
                let ranked = near.map(|(thing, number)| (off(place, thing.corners, margin), number));
                let inside = ranked.filter(|(off, _)| *off < 1.0);
                inside.min_by(|one, other| one.0.total_cmp(&other.0)).map(|(_, number)| number)
            };
            if let Some(number) = of_person.filter(is_inside).or_else(nearest) {
                *claim = number + 1;
                self.pixels[usize::from(number)] += 1;
            }
        }
    }

    /// Drops boxes that the thing map does not confirm, and labels the others.
    fn number_boxes(&mut self, predictions: &Predictions<'_>, things: &[Thing], rules: &Rules) {
        self.labels.clear();
        for (thing, pixels) in things.iter().zip(&self.pixels) {
            let [left, top, right, bottom] = thing.corners;
            let area = ((right - left) * (bottom - top)).max(1.0);
            let is_confirmed = *pixels > 0 && *pixels as f32 >= rules.min_overlap * area;
            let is_known = predictions.of_things.contains(&Some(thing.class));
            let counts = &mut self.counts;
            let label = if is_known && is_confirmed { next_label(counts, thing.class) } else { None };
            self.labels.push(label);
        }
    }

    /// Labels large regions of thing classes outside of all boxes.
    fn add_leftovers(&mut self, predictions: &Predictions<'_>, least: f32, labels: &mut [u32]) {
        let free = &*labels;
        self.components.label(
            predictions.size,
            Connectivity::Four,
            |at| free[at] == VOID && predictions.thing(at).is_some(),
            |one, other| predictions.thing(one) == predictions.thing(other),
        );
        self.of_components.clear();
        self.of_components.resize(self.components.areas().len(), None);
        for (at, number) in self.components.labels().iter().enumerate() {
            let number = *number as usize;
            if number == 0 || (self.components.areas()[number] as f32) < least.max(1.0) {
                continue;
            }
            let label = &mut self.of_components[number];
            if label.is_none() {
                *label = predictions.thing(at).and_then(|class| next_label(&mut self.counts, class));
            }
            labels[at] = label.unwrap_or(VOID);
        }
    }

    /// Fills boxes of classes without a class map, smaller ones over larger ones.
    fn fill_boxes(&mut self, predictions: &Predictions<'_>, things: &[Thing], labels: &mut [u32]) {
        let [width, height] = predictions.size;
        let area = |at: &usize| {
            let [left, top, right, bottom] = things[*at].corners;
            (right - left) * (bottom - top)
        };
        self.order.clear();
        self.order
            .extend((0..things.len()).filter(|at| !predictions.of_things.contains(&Some(things[*at].class))));
        self.order.sort_by(|one, other| area(other).total_cmp(&area(one)));
        for at in &self.order {
            let [left, top, right, bottom] = things[*at].corners.map(|edge| edge.round().max(0.0) as usize);
            let columns = left.min(width)..right.min(width);
            if columns.is_empty() || top >= bottom.min(height) {
                continue;
            }
            let Some(label) = next_label(&mut self.counts, things[*at].class) else { continue };
            for row in labels.chunks_exact_mut(width).take(bottom).skip(top) {
                row[columns.clone()].fill(label);
            }
        }
    }

    fn add_stuff(&mut self, predictions: &Predictions<'_>, least: f32, labels: &mut [u32]) {
        let class =
            |at: usize| predictions.of_stuff.get(*predictions.stuff.get(at)? as usize).copied().flatten();
        self.pixels.clear();
        for (at, _) in labels.iter().enumerate().filter(|(_, label)| **label == VOID) {
            let Some(class) = class(at) else { continue };
            let needed = (class as usize + 1).max(self.pixels.len());
            self.pixels.resize(needed, 0);
            self.pixels[class as usize] += 1;
        }
        for (at, label) in labels.iter_mut().enumerate().filter(|(_, label)| **label == VOID) {
            if let Some(class) = class(at).filter(|class| self.pixels[*class as usize] as f32 >= least) {
                *label = class * LABEL_DIVISOR;
            }
        }
    }
}

impl Predictions<'_> {
    /// Returns the thing class of a pixel.
    fn thing(&self, at: usize) -> Option<u32> {
        self.of_things.get(*self.things.get(at)? as usize).copied().flatten()
    }
}

/// Returns the label of the next object of a class; `None` when the label range is exhausted.
fn next_label(counts: &mut Vec<u32>, class: u32) -> Option<u32> {
    let at = class as usize;
    if counts.len() <= at {
        counts.resize(at + 1, 0);
    }
    let is_free = counts[at] + 1 < LABEL_DIVISOR;
    counts[at] += u32::from(is_free);
    is_free.then_some(class * LABEL_DIVISOR + counts[at])
}

/// Returns the distance from the centre of a box with a margin, in units where 1 is the edge.
fn off([x, y]: [f32; 2], [left, top, right, bottom]: [f32; 4], margin: f32) -> f32 {
    let along = |at: f32, low: f32, high: f32| {
        (at - (low + high) / 2.0).abs() / ((high - low).max(0.0) / 2.0 + margin)
    };
    along(x, left, right).max(along(y, top, bottom))
}

/// Returns the intersection over union.
fn iou(one: [f32; 4], other: [f32; 4]) -> f32 {
    let area = |[left, top, right, bottom]: [f32; 4]| (right - left).max(0.0) * (bottom - top).max(0.0);
    let shared =
        area([one[0].max(other[0]), one[1].max(other[1]), one[2].min(other[2]), one[3].min(other[3])]);
    let all = area(one) + area(other) - shared;
    if all > 0.0 { shared / all } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use super::*;

    const RULES: Rules = Rules { box_masks: true, min_overlap: 0.1, min_leftover: 0.1, min_stuff: 0.05 };

    fn pixels(picture: &[&str]) -> Vec<u32> {
        picture.concat().bytes().map(|byte| u32::from(byte - b'0')).collect()
    }

    /// Thing map: 1 is class 0 (persons), 2 is class 5. Stuff map: 1 is class 90. Class 7 has no map.
    fn fuse(things: &[&str], persons: &[&str], found: &[Thing]) -> Vec<u32> {
        let size = [things[0].len(), things.len()];
        let owned = pixels(persons);
        let mut owners = OwnerMap::default();
        owners.fill(size, |y, row| {
            let owned = &owned[y * size[0]..][..size[0]];
            row.iter_mut().zip(owned).for_each(|(owner, owned)| *owner = *owned as u8);
        });
        let predictions = Predictions {
            size,
            things: &pixels(things),
            of_things: &[None, Some(0), Some(5)],
            stuff: &vec![1; size[0] * size[1]],
            of_stuff: &[None, Some(90)],
            persons: &owners,
            person: Some(0),
        };
        let mut labels = vec![7; size[0] * size[1]];
        Fusion::default().run(&predictions, found, &RULES, &mut labels);
        labels
    }

    fn thing(class: u32, corners: [f32; 4]) -> Thing {
        Thing { class, corners }
    }

    #[test]
    fn persons_with_overlapping_boxes_are_distinguished() {
        let things = ["011110", "011110", "011110"];
        let found = [thing(0, [1.0, 0.0, 4.0, 3.0]), thing(0, [2.0, 0.0, 5.0, 3.0])];
        let by_boxes = fuse(&things, &["000000"; 3], &found);
        assert_eq!(by_boxes[6..12], [90_000, 1, 1, 2, 2, 90_000]);
        let by_persons = fuse(&things, &["011120"; 3], &found);
        assert_eq!(by_persons[6..12], [90_000, 1, 1, 1, 2, 90_000]);
    }

    #[test]
    fn boxes_without_pixels_are_dropped_and_regions_without_boxes_are_kept() {
        let things = ["220000", "220000", "000000"];
        let labels = fuse(&things, &["000000"; 3], &[thing(0, [2.0, 0.0, 6.0, 3.0])]);
        assert_eq!(labels[..6], [5001, 5001, 90_000, 90_000, 90_000, 90_000]);
        // A region of one pixel in 18 is too small for an object; the stuff behind it is labelled.
        let labels = fuse(&["200000", "000000", "000000"], &["000000"; 3], &[]);
        assert_eq!(labels, [90_000; 18]);
    }

    #[test]
    fn classes_without_a_map_fill_their_box() {
        let found = [thing(7, [0.0, 0.0, 4.0, 3.0]), thing(7, [1.0, 1.0, 2.0, 2.0])];
        let labels = fuse(&["000000"; 3], &["000000"; 3], &found);
        assert_eq!(labels[6..12], [7001, 7002, 7001, 7001, 90_000, 90_000]);
    }

    #[test]
    fn invalid_predictions_do_not_panic() {
        let corners = [[f32::NAN; 4], [f32::INFINITY; 4], [5.0, 5.0, -5.0, -5.0], [-1e30, -1e30, 1e30, 1e30]];
        let found: Vec<_> = (0..2000).map(|at| thing([0, 5, 7][at % 3], corners[at % 4])).collect();
        let labels = fuse(&["112200", "112200"], &["990011"; 2], &found);
        assert!(labels.iter().all(|label| [0, 5, 7, 90, 255].contains(&(label / LABEL_DIVISOR))));
    }
}
