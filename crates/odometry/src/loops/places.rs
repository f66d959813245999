//! Recognition of places by the words of their descriptors.

use crate::image::Descriptor;

/// An inverted index: for each word the places where it was. A descriptor has eight words of twelve of its bits each; two descriptors of
/// one corner, which differ in a few bits, share some of them. No vocabulary is trained.
#[derive(Debug)]
pub(crate) struct Places {
    words: Vec<Vec<u32>>,
    /// Number of descriptors of each place.
    sizes: Vec<u32>,
    votes: Vec<f32>,
}

const TABLES: usize = 8;
const BITS: u32 = 12;

impl Places {
    pub fn new() -> Self {
        Self { words: vec![Vec::new(); TABLES << BITS], sizes: Vec::new(), votes: Vec::new() }
    }

    /// Adds a place and returns its number.
    pub fn add(&mut self, descriptors: &[Descriptor]) -> usize {
        let number = self.sizes.len();
        for word in descriptors.iter().flat_map(words) {
            let list = &mut self.words[word];
            if list.last() != Some(&(number as u32)) {
                list.push(number as u32);
            }
        }
        self.sizes.push(descriptors.len() as u32);
        number
    }

    /// Writes up to `most` places below `before` that share most words with the descriptors, best first. Places near a better one, less
    /// than `apart` numbers away, are left out.
    pub fn similar(
        &mut self,
        descriptors: &[Descriptor],
        before: usize,
        most: usize,
        apart: usize,
        found: &mut Vec<usize>,
    ) {
        found.clear();
        self.votes.clear();
        self.votes.resize(before.min(self.sizes.len()), 0.0);
        let places = self.sizes.len() as f32;
        for word in descriptors.iter().flat_map(words) {
            let list = &self.words[word];
            if list.is_empty() {
                continue;
            }
            // A word that is in all places distinguishes none.
            let weight = (1.0 + places / list.len() as f32).ln();
            for place in list {
                match self.votes.get_mut(*place as usize) {
                    Some(votes) => *votes += weight,
                    None => break,
                }
            }
        }
        for (votes, size) in self.votes.iter_mut().zip(&self.sizes) {
            *votes /= (*size as f32).max(30.0).sqrt();
        }
        while found.len() < most {
            let best = self.votes.iter().enumerate().max_by(|a, b| a.1.total_cmp(b.1));
            let Some((place, _)) = best.filter(|(_, votes)| **votes > 0.0) else { return };
            found.push(place);
            let near = place.saturating_sub(apart)..(place + apart + 1).min(self.votes.len());
            self.votes[near].fill(0.0);
        }
    }
}

/// Returns the words of a descriptor, as numbers over all tables.
fn words(descriptor: &Descriptor) -> impl Iterator<Item = usize> + '_ {
    (0..TABLES).map(|table| {
        let half = descriptor[table / 2] >> (32 * (table % 2) as u32);
        (table << BITS) + (half & ((1 << BITS) - 1)) as usize
    })
}
