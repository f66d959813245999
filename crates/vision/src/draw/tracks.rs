//! Drawing of tracks, each with its own colour and a trail of past positions.

use std::collections::{HashMap, VecDeque};

use opendr_engine::data::Image;
use opendr_engine::target::{TrackingAnnotation, TrackingAnnotationList};

use crate::draw::bounding_boxes::{outline, whole_corners};
use crate::draw::canvas::{Canvas, Point};
use crate::draw::label::Labels;
use crate::draw::palette::colour_of_index;
use crate::draw::style::Style;

/// Length of a trail, and the age at which a lost track is dropped, in frames.
const LENGTH: usize = 48;

/// Past positions of the tracks of a video; updated once per frame with [`Trails::update`].
#[derive(Debug, Clone, Default)]
pub struct Trails {
    tails: HashMap<i64, Tail>,
    pictures: usize,
}

#[derive(Debug, Clone, Default)]
struct Tail {
    points: VecDeque<Point>,
    last_seen: usize,
}

impl Trails {
    /// Adds the positions of one frame.
    pub fn update(&mut self, tracks: &TrackingAnnotationList) {
        self.pictures += 1;
        for track in tracks.annotations.iter().filter(|track| track.id >= 0) {
            let [x0, y0, x1, y1] = track.bounding_box.corners();
            let tail = self.tails.entry(track.id).or_default();
            tail.last_seen = self.pictures;
            tail.points.push_back([(x0 + x1) / 2.0, (y0 + y1) / 2.0]);
            if tail.points.len() > LENGTH {
                tail.points.pop_front();
            }
        }
        self.tails.retain(|_, tail| self.pictures - tail.last_seen < LENGTH);
    }

    fn draw(&self, canvas: &mut Canvas<'_>, id: i64, thickness: f32, style: &Style) {
        let Some(tail) = self.tails.get(&id) else { return };
        let colour = style.colour.unwrap_or_else(|| colour_of_index(id));
        let count = tail.points.len().max(1) as f32;
        for (index, (from, to)) in tail.points.iter().zip(tail.points.iter().skip(1)).enumerate() {
            let newness = (index as f32 + 1.0) / count;
            // Opaque: translucent segments would overlap visibly at their ends.
            canvas.line(*from, *to, thickness * (0.4 + 1.4 * newness), colour, 1.0);
        }
    }
}

/// Draws tracks as boxes in the colours of their ids, with the trails of `trails`.
///
/// `image` is converted to RGB `u8` where needed. Objects without an id (-1) have no trail.
pub fn draw_tracks(image: &mut Image, tracks: &TrackingAnnotationList, trails: &Trails, style: &Style) {
    let mut canvas = Canvas::over(image);
    let (thickness, unit) = (style.thickness(&canvas), style.letter_unit(&canvas));
    let colour = |track: &TrackingAnnotation| style.colour.unwrap_or_else(|| colour_of_index(track.id));
    for track in tracks.annotations.iter().rev() {
        trails.draw(&mut canvas, track.id, thickness, style);
        if let Some(corners) = whole_corners(track.bounding_box.corners()) {
            outline(&mut canvas, corners, thickness, colour(track));
        }
    }
    let mut labels = Labels::default();
    for track in tracks.annotations.iter().filter(|_| style.labels) {
        let Some(corners) = whole_corners(track.bounding_box.corners()) else { continue };
        let number = format!("#{}", track.id);
        let name = tracks.classes.label(&track.bounding_box.name).unwrap_or_default();
        let mut text = format!("{number} {name}");
        if style.show_confidences {
            text += &format!(" {:.2}", track.bounding_box.confidence);
        }
        labels.draw(&mut canvas, [&text, &number], corners, [unit, thickness], colour(track));
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::target::BoundingBox;

    #[test]
    fn trails_are_bounded_and_dropped() {
        let mut trails = Trails::default();
        for step in 0..200 {
            let at = |id, left| TrackingAnnotation {
                bounding_box: BoundingBox::new(0, left, 0.0, 2.0, 2.0, 1.0),
                id,
                frame: None,
            };
            // Object 1 stays, every frame has a new one, and one has no id.
            trails.update(&vec![at(1, step as f32), at(100 + step, 5.0), at(-1, 7.0)].into());
        }
        assert_eq!(trails.tails[&1].points.len(), LENGTH);
        assert_eq!(trails.tails[&1].points.back(), Some(&[200.0, 1.0]));
        assert_eq!(trails.tails.len(), 1 + LENGTH);
        assert!(!trails.tails.contains_key(&-1));
    }
}
