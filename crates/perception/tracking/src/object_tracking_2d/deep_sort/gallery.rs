//! What is remembered of the looks of one object.

/// The last looks of an object, each of length 1.
#[derive(Debug, Clone, Default)]
pub(super) struct Gallery {
    looks: Vec<f32>,
    /// The number of the look that is replaced next, once there are as many as may be.
    next: usize,
}

impl Gallery {
    /// Remembers a look, in place of the oldest of `most`. One of zeros tells nothing.
    pub fn add(&mut self, look: &[f32], most: usize) {
        let length = look.len();
        if look.iter().all(|number| *number == 0.0) {
            return;
        }
        if self.looks.len() < most * length {
            return self.looks.extend(look);
        }
        self.looks.truncate(most * length);
        self.next %= most;
        if let Some(place) = self.looks.chunks_exact_mut(length).nth(self.next) {
            place.copy_from_slice(look);
            self.next += 1;
        }
    }

    /// 1 less the largest cosine with what is remembered; 2, the largest there is, where nothing is.
    pub fn distance(&self, look: &[f32]) -> f32 {
        let cosine = |other: &[f32]| other.iter().zip(look).map(|(a, b)| a * b).sum::<f32>();
        let best = self.looks.chunks_exact(look.len().max(1)).map(cosine).fold(-1.0, f32::max);
        1.0 - best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_is_forgotten() {
        let mut gallery = Gallery::default();
        assert_eq!(gallery.distance(&[1.0, 0.0]), 2.0);
        gallery.add(&[0.0, 0.0], 2);
        assert_eq!(gallery.distance(&[1.0, 0.0]), 2.0);
        gallery.add(&[1.0, 0.0], 2);
        gallery.add(&[0.0, 1.0], 2);
        assert_eq!(gallery.distance(&[1.0, 0.0]), 0.0);
        gallery.add(&[0.0, 1.0], 2);
        assert_eq!(gallery.distance(&[1.0, 0.0]), 1.0);
        // A smaller budget forgets at once.
        gallery.add(&[1.0, 0.0], 1);
        assert_eq!((gallery.distance(&[1.0, 0.0]), gallery.looks.len()), (0.0, 2));
    }
}
