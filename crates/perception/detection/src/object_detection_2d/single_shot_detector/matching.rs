//! Which anchor answers for which object (Liu et al., SSD, ECCV 2016, section 2.2).

use opendr_perception_common::suppression::iou;

use super::anchors::Anchor;

/// What an anchor should answer.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Match {
    /// Nothing.
    Background,
    /// The object of this number.
    Object(usize),
    /// Whatever it likes: it overlaps an object too much for background and too little to answer for it, or it lies
    /// in a crowd.
    Ignored,
}

/// When anchor and object belong together.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Matching {
    /// From this intersection over union on, an anchor answers for an object.
    pub object: f32,
    /// Below this intersection over union, an anchor is background.
    pub background: f32,
    /// Anchors with more than this share of their area in a crowd are ignored.
    pub crowd: f32,
}

impl Default for Matching {
    fn default() -> Self {
        Self { object: 0.5, background: 0.4, crowd: 0.5 }
    }
}

impl Matching {
    /// A match for each anchor. Boxes are `[x0, y0, x1, y1]` in the anchors' pixels.
    ///
    /// Every object that overlaps any anchor gets one, its best, even when their overlap is small; where two objects
    /// have the same best anchor, the one that overlaps it more does, and the other its next best. Every other anchor
    /// goes to the object that it overlaps most.
    pub fn run(&self, anchors: &[Anchor], objects: &[[f32; 4]], crowds: &[[f32; 4]]) -> Vec<Match> {
        let mut best = vec![(0.0, 0); anchors.len()];
        for (number, object) in objects.iter().enumerate() {
            for (best, anchor) in best.iter_mut().zip(anchors) {
                let overlap = iou(&anchor.corners(), object);
                if overlap > best.0 {
                    *best = (overlap, number);
                }
            }
        }
        let in_crowd =
            |anchor: &Anchor| crowds.iter().any(|crowd| share_inside(&anchor.corners(), crowd) > self.crowd);
        let of_overlap = |((overlap, object), anchor)| match overlap {
            overlap if overlap >= self.object => Match::Object(object),
            overlap if overlap >= self.background || in_crowd(anchor) => Match::Ignored,
            _ => Match::Background,
        };
        let mut matches: Vec<_> = best.into_iter().zip(anchors).map(of_overlap).collect();
        for wish in best_anchors(anchors, objects) {
            matches[wish.anchor] = Match::Object(wish.object);
        }
        matches
    }
}

/// The free anchor that overlaps an object most.
#[derive(Clone, Copy)]
struct Wish {
    object: usize,
    anchor: usize,
    overlap: f32,
}

impl Wish {
    fn of(object: usize, anchors: &[Anchor], corners: &[f32; 4], taken: &[bool]) -> Option<Self> {
        let free = anchors.iter().zip(taken).enumerate().filter(|(_, (_, taken))| !**taken);
        let wishes = free.map(|(number, (anchor, _))| Self {
            object,
            anchor: number,
            overlap: iou(&anchor.corners(), corners),
        });
        wishes.max_by(Self::by_overlap).filter(|wish| wish.overlap > 0.0)
    }

    /// The first of those that overlap alike is the greatest.
    fn by_overlap(&self, other: &Self) -> std::cmp::Ordering {
        let numbers = |wish: &Self| (wish.object, wish.anchor);
        self.overlap.total_cmp(&other.overlap).then(numbers(other).cmp(&numbers(self)))
    }
}

/// An anchor for every object that overlaps a free one; the largest overlap chooses first.
fn best_anchors(anchors: &[Anchor], objects: &[[f32; 4]]) -> Vec<Wish> {
    let mut taken = vec![false; anchors.len()];
    let wish_of = |object: usize, taken: &[bool]| Wish::of(object, anchors, &objects[object], taken);
    let mut waiting: Vec<_> = (0..objects.len()).filter_map(|object| wish_of(object, &taken)).collect();
    let mut granted = Vec::with_capacity(objects.len());
    while let Some(at) = (0..waiting.len()).max_by(|a, b| waiting[*a].by_overlap(&waiting[*b])) {
        let wish = waiting.swap_remove(at);
        if taken[wish.anchor] {
            waiting.extend(wish_of(wish.object, &taken));
        } else {
            taken[wish.anchor] = true;
            granted.push(wish);
        }
    }
    granted
}

/// The share of a box's area that lies inside another.
fn share_inside(corners: &[f32; 4], other: &[f32; 4]) -> f32 {
    let side =
        |axis: usize| (corners[axis + 2].min(other[axis + 2]) - corners[axis].max(other[axis])).max(0.0);
    side(0) * side(1) / ((corners[2] - corners[0]) * (corners[3] - corners[1]))
}

#[cfg(test)]
mod tests {
    use super::super::anchors::AnchorLevel;
    use super::*;

    fn anchors() -> Vec<Anchor> {
        AnchorLevel { stride: 32, sides: vec![[32.0, 32.0]] }.anchors([96, 32]).collect()
    }

    #[test]
    fn overlap_decides() {
        let matches = Matching::default().run(&anchors(), &[[0.0, 0.0, 32.0, 32.0]], &[]);
        assert_eq!(matches, [Match::Object(0), Match::Background, Match::Background]);
        // 32 x 14.5 of 32 x 32 is 0.45 of the union, but nothing overlaps it more.
        let matches = Matching::default().run(&anchors(), &[[0.0, 0.0, 32.0, 14.5]], &[]);
        assert_eq!(matches[0], Match::Object(0));
        let two = [[0.0, 0.0, 32.0, 32.0], [18.0, 0.0, 46.0, 32.0]];
        assert_eq!(Matching::default().run(&anchors(), &two, &[])[1], Match::Object(1));
    }

    #[test]
    fn between_object_and_background_nobody_is_asked() {
        let doubled: Vec<_> = [24.0, 32.0]
            .map(|side| Anchor { x: 16.0, y: 16.0, width: 32.0, height: side })
            .into_iter()
            .collect();
        let matches = Matching::default().run(&doubled, &[[0.0, 9.0, 32.0, 23.0]], &[]);
        assert_eq!(matches, [Match::Object(0), Match::Ignored]);
    }

    #[test]
    fn every_object_gets_an_anchor_even_the_same_ones_best() {
        let objects = [[0.0, 0.0, 10.0, 10.0], [0.0, 0.0, 32.0, 30.0], [0.0, 0.0, 40.0, 8.0]];
        let matches = Matching::default().run(&anchors(), &objects, &[]);
        assert_eq!(matches, [Match::Object(1), Match::Object(2), Match::Background]);
        let outside = [[500.0, 500.0, 510.0, 510.0]];
        assert_eq!(Matching::default().run(&anchors(), &outside, &[]), [Match::Background; 3]);
    }

    #[test]
    fn crowds_are_no_background() {
        let crowd = [[0.0, 0.0, 50.0, 32.0]];
        let matches = Matching::default().run(&anchors(), &[], &crowd);
        assert_eq!(matches, [Match::Ignored, Match::Ignored, Match::Background]);
    }
}
