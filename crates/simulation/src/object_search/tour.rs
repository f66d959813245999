//! Shortest orders in which places are visited.

use super::KnownMap;
use super::distances::Distances;
use super::frontiers::Candidate;

/// Largest number of places.
pub(super) const PLACES: usize = 8;

/// Lengths of the shortest ways past all places, by the place they begin with (Held and Karp, 1962).
#[derive(Debug, Clone, Default)]
pub(super) struct Tour {
    distances: Distances,
    /// Ways between the places, metres.
    ways: [[f64; PLACES]; PLACES],
    /// Length of the rest of the way past the places of a set, after a place in it.
    rest: Vec<[f64; PLACES]>,
    /// For each place, the length of the shortest way that begins with it, above the shortest of all, metres.
    pub detours: [f64; PLACES],
    /// For each place, the way to the nearest other one, metres.
    pub nearest: [f64; PLACES],
}

/// A way that is not known, metres.
const NO_WAY: f64 = 20.0;

impl Tour {
    /// Computes all lengths for the first candidates.
    pub fn plan(&mut self, map: &KnownMap, candidates: &[Candidate]) {
        let candidates = &candidates[..candidates.len().min(PLACES)];
        let mut targets = [0; PLACES];
        targets.iter_mut().zip(candidates).for_each(|(target, candidate)| *target = candidate.target);
        let (count, all) = (candidates.len(), (1_usize << candidates.len()) - 1);
        self.nearest = [NO_WAY; PLACES];
        for (from, start) in targets.iter().enumerate().take(count) {
            self.ways[from][from] = 0.0;
            let ends = &targets[from + 1..count];
            if !ends.is_empty() {
                self.distances.compute_to(*start, ends, |cell| map.is_passable(cell));
            }
            for to in from + 1..count {
                let way = self.distances.metres(targets[to]).unwrap_or(NO_WAY);
                (self.ways[from][to], self.ways[to][from]) = (way, way);
                for end in [from, to] {
                    self.nearest[end] = self.nearest[end].min(way);
                }
            }
        }
        self.rest.clear();
        self.rest.resize(all + 1, [0.0; PLACES]);
        for set in 1..=all {
            for last in (0..count).filter(|last| set >> last & 1 == 1) {
                let others = set & !(1 << last);
                let lengths = (0..count).filter(|next| others >> next & 1 == 1);
                let lengths = lengths.map(|next| self.ways[last][next] + self.rest[others][next]);
                self.rest[set][last] = lengths.reduce(f64::min).unwrap_or(0.0);
            }
        }
        self.detours = [0.0; PLACES];
        for (first, candidate) in candidates.iter().enumerate() {
            self.detours[first] = candidate.length + self.rest[all][first];
        }
        let detours = &mut self.detours[..count];
        let shortest = detours.iter().copied().fold(f64::INFINITY, f64::min);
        detours.iter_mut().for_each(|length| *length -= shortest);
    }
}
