//! How long a track has been there, and whether it is told.

/// Sightings of one track.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub(crate) struct Life {
    /// The number under which it is told, once it is.
    pub id: Option<i64>,
    /// Frames in a row in which it was seen.
    pub hits: u32,
    /// Frames since it was seen; 0 in a frame in which it is.
    pub away: u32,
}

impl Life {
    /// A frame begins.
    pub fn pass(&mut self) {
        if self.away > 0 {
            self.hits = 0;
        }
        self.away = self.away.saturating_add(1);
    }

    /// It is seen in this frame. From the `needed`th frame in a row on it has a number, and keeps it.
    pub fn see(&mut self, needed: u32, last_id: &mut i64) {
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
    fn numbers_come_with_the_needed_sighting_and_stay() {
        let (mut life, mut last_id) = (Life::default(), 6);
        life.see(3, &mut last_id);
        for seen in [true, false, true, true] {
            life.pass();
            if seen {
                life.see(3, &mut last_id);
            }
        }
        assert_eq!((life.id, life.hits), (None, 2));
        life.pass();
        life.see(3, &mut last_id);
        life.pass();
        life.pass();
        life.see(3, &mut last_id);
        assert_eq!((life.id, life.away, last_id), (Some(7), 0, 7));
    }
}
