//! Stored embeddings of one object.

/// The last embeddings of an object, each of length 1.
#[derive(Debug, Clone, Default)]
pub(super) struct Gallery {
    embeddings: Vec<f32>,
    /// Index of the embedding that is overwritten next, once the gallery is full.
    next: usize,
}

impl Gallery {
    /// Adds an embedding; of more than `most`, it overwrites the oldest. Zeros are ignored.
    pub fn add(&mut self, embedding: &[f32], most: usize) {
        let length = embedding.len();
        if embedding.iter().all(|number| *number == 0.0) {
            return;
        }
        if self.embeddings.len() < most * length {
            return self.embeddings.extend(embedding);
        }
        self.embeddings.truncate(most * length);
        self.next %= most;
        if let Some(place) = self.embeddings.chunks_exact_mut(length).nth(self.next) {
            place.copy_from_slice(embedding);
            self.next += 1;
        }
    }

    /// Returns 1 minus the largest cosine with the stored embeddings; 2, the maximum, when there are none.
    pub fn distance(&self, embedding: &[f32]) -> f32 {
        let cosine = |other: &[f32]| other.iter().zip(embedding).map(|(a, b)| a * b).sum::<f32>();
        let best = self.embeddings.chunks_exact(embedding.len().max(1)).map(cosine).fold(-1.0, f32::max);
        1.0 - best
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_oldest_is_overwritten() {
        let mut gallery = Gallery::default();
        assert_eq!(gallery.distance(&[1.0, 0.0]), 2.0);
        gallery.add(&[0.0, 0.0], 2);
        assert_eq!(gallery.distance(&[1.0, 0.0]), 2.0);
        gallery.add(&[1.0, 0.0], 2);
        gallery.add(&[0.0, 1.0], 2);
        assert_eq!(gallery.distance(&[1.0, 0.0]), 0.0);
        gallery.add(&[0.0, 1.0], 2);
        assert_eq!(gallery.distance(&[1.0, 0.0]), 1.0);
        // A smaller budget applies at once.
        gallery.add(&[1.0, 0.0], 1);
        assert_eq!((gallery.distance(&[1.0, 0.0]), gallery.embeddings.len()), (0.0, 2));
    }
}
