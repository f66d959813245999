//! The paths of pointing fingers, by the identity of the hand.

/// Number of points of a path.
pub(super) const POINTS: usize = 16;

/// The paths of a stream's hands.
#[derive(Debug, Default)]
pub(super) struct Paths {
    hands: Vec<HandPath>,
}

#[derive(Debug)]
struct HandPath {
    id: i64,
    points: [[f32; 2]; POINTS],
    count: usize,
    is_seen: bool,
}

impl Paths {
    /// Begins a frame without pointing hands.
    pub fn begin_frame(&mut self) {
        self.hands.iter_mut().for_each(|hand| hand.is_seen = false);
    }

    /// Adds the finger tip of hand `id`, and returns its path, oldest point first, once it has [`POINTS`] points.
    pub fn point(&mut self, id: i64, tip: [f32; 2]) -> Option<[[f32; 2]; POINTS]> {
        let at = self.hands.iter().position(|hand| hand.id == id).unwrap_or_else(|| {
            self.hands.push(HandPath { id, points: [[0.0; 2]; POINTS], count: 0, is_seen: true });
            self.hands.len() - 1
        });
        let hand = self.hands.get_mut(at)?;
        hand.is_seen = true;
        hand.points.rotate_left(1);
        *hand.points.last_mut()? = tip;
        hand.count = (hand.count + 1).min(POINTS);
        (hand.count == POINTS).then_some(hand.points)
    }

    /// Drops the paths of hands that did not point in this frame.
    pub fn end_frame(&mut self) {
        self.hands.retain(|hand| hand.is_seen);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_path_has_sixteen_points_in_a_row() {
        let mut paths = Paths::default();
        let mut frame = |tip: Option<f32>| {
            paths.begin_frame();
            let path = tip.and_then(|x| paths.point(7, [x, 0.0]));
            paths.end_frame();
            path.map(|path| path.map(|[x, _]| x))
        };
        assert!((0..15).all(|x| frame(Some(x as f32)).is_none()));
        let path = frame(Some(15.0)).unwrap();
        assert_eq!((path[0], path[15]), (0.0, 15.0));
        let path = frame(Some(16.0)).unwrap();
        assert_eq!((path[0], path[15]), (1.0, 16.0));
        assert!(frame(None).is_none());
        assert!(frame(Some(1.0)).is_none());
    }
}
