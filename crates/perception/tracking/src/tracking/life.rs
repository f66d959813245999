//! Age and identity of a track.

/// Detections of one track over time.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Life {
    /// Identity, once the track is confirmed.
    pub id: Option<i64>,
    /// Number of consecutive frames with a detection.
    pub hits: u32,
    /// Number of frames since the last detection; 0 in a frame with one.
    pub away: u32,
}

impl Life {
    /// Begins a frame.
    pub fn pass(&mut self) {
        if self.away > 0 {
            self.hits = 0;
        }
        self.away = self.away.saturating_add(1);
    }

    /// Records a detection in this frame. At the `needed`th consecutive one the track gets its identity, which it keeps.
    pub fn hit(&mut self, needed: u32, last_id: &mut i64) {
        self.away = 0;
        self.hits = self.hits.saturating_add(1);
        if self.hits >= needed && self.id.is_none() {
            *last_id = last_id.saturating_add(1);
            self.id = Some(*last_id);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn identities_start_at_the_needed_detection_and_stay() {
        let (mut life, mut last_id) = (Life::default(), 6);
        life.hit(3, &mut last_id);
        for seen in [true, false, true, true] {
            life.pass();
            if seen {
                life.hit(3, &mut last_id);
            }
        }
        assert_eq!((life.id, life.hits), (None, 2));
        life.pass();
        life.hit(3, &mut last_id);
        life.pass();
        life.pass();
        life.hit(3, &mut last_id);
        assert_eq!((life.id, life.away, last_id), (Some(7), 0, 7));
    }
}
