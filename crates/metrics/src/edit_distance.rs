//! Edit distance of two sequences, with the alignment of RapidFuzz (which jiwer uses).
//!
//! Several alignments may have the fewest edits but differ in their hits. RapidFuzz removes common ends, then prefers,
//! from the end backwards, a deletion to an insertion to a substitution or hit, and halves inputs that are too large for
//! a matrix (Hirschberg). This module does the same. 64 matrix entries are computed at once (Myers, 1999; Hyyrö, 2003).

use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

/// Edits of a sequence relative to its reference.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EditCounts {
    /// Number of symbols of the reference that are correct.
    pub hits: u64,
    /// Number of symbols of the reference that are replaced.
    pub substitutions: u64,
    /// Number of symbols of the reference that are missing.
    pub deletions: u64,
    /// Number of additional symbols.
    pub insertions: u64,
}

impl EditCounts {
    /// Computes the edits from `reference` to `hypothesis`. Time grows with the length times the number of edits.
    pub fn of<T: Eq + Hash>(reference: &[T], hypothesis: &[T]) -> Self {
        let mut numbers = HashMap::new();
        let [reference, hypothesis] = [reference, hypothesis].map(|symbols| {
            let number = |symbol| {
                let next = numbers.len() as u32;
                *numbers.entry(symbol).or_insert(next)
            };
            symbols.iter().map(number).collect::<Vec<u32>>()
        });
        let mut counts = Self::default();
        counts.align(&reference, &hypothesis, distance(&reference, &hypothesis));
        counts
    }

    /// Returns the number of edits.
    pub fn errors(&self) -> u64 {
        self.substitutions + self.deletions + self.insertions
    }

    /// Adds the counts of `other`.
    pub fn add(&mut self, other: &Self) {
        self.hits += other.hits;
        self.substitutions += other.substitutions;
        self.deletions += other.deletions;
        self.insertions += other.insertions;
    }

    /// Counts the edits from `a` to `b`, at most `most`.
    fn align(&mut self, a: &[u32], b: &[u32], most: usize) {
        let (a, b, same) = without_common_ends(a, b);
        self.hits += same as u64;
        let most = most.min(a.len().max(b.len()));
        let band = a.len().min(2 * most + 1);
        if band * b.len() / 4 < MATRIX_BYTES || a.len() < 65 || b.len() < 10 {
            return self.trace(a, b, most);
        }
        // Each half has its own fewest edits; `a` is cut where their sum is smallest.
        let (left, right) = b.split_at(b.len() / 2);
        let begin = last_row(a, left, most);
        let [a_reversed, right_reversed] =
            [a, right].map(|part| part.iter().rev().copied().collect::<Vec<_>>());
        let mut end = last_row(&a_reversed, &right_reversed, most);
        end.reverse();
        let edits = begin.iter().zip(&end).map(|(before, after)| before + after);
        let cut = edits.enumerate().min_by_key(|(_, edits)| *edits).map_or(0, |(cut, _)| cut);
        self.align(&a[..cut], left, begin[cut] as usize);
        self.align(&a[cut..], right, end[cut] as usize);
    }

    /// Like [`EditCounts::align`], by backtracking through a stored matrix.
    fn trace(&mut self, a: &[u32], b: &[u32], most: usize) {
        let (mut kept, mut rows) = (Vec::new(), Vec::with_capacity(b.len()));
        Matrix::new(a, most).sweep(b, |first, blocks| {
            rows.push((first, kept.len()));
            kept.extend_from_slice(blocks);
        });
        rows.push((0, kept.len()));
        // Difference of the distances at the `i`th and the previous symbol of `a`, after `j` symbols of `b`.
        let step = |i: usize, j: usize| {
            let (first, start) = rows[j - 1];
            let block = ((i - 1) / 64).checked_sub(first).and_then(|at| kept[start..rows[j].1].get(at));
            block.map_or(0, |block| block.difference(i - 1))
        };
        let (mut i, mut j) = (a.len(), b.len());
        while i > 0 && j > 0 {
            if step(i, j) > 0 {
                self.deletions += 1;
                i -= 1;
            } else if j > 1 && step(i, j - 1) < 0 {
                self.insertions += 1;
                j -= 1;
            } else {
                (i, j) = (i - 1, j - 1);
                *if a[i] == b[j] { &mut self.hits } else { &mut self.substitutions } += 1;
            }
        }
        self.deletions += i as u64;
        self.insertions += j as u64;
    }
}

/// Maximum size of the stored matrix at two bits per entry, as in RapidFuzz.
const MATRIX_BYTES: usize = 1 << 20;

/// A number above every distance.
const FAR: u32 = u32::MAX / 4;

/// Returns the sequences without their common ends, and the number of symbols in these ends.
fn without_common_ends<'a>(a: &'a [u32], b: &'a [u32]) -> (&'a [u32], &'a [u32], usize) {
    let prefix = a.iter().zip(b).take_while(|(one, other)| one == other).count();
    let (a, b) = (&a[prefix..], &b[prefix..]);
    let suffix = a.iter().rev().zip(b.iter().rev()).take_while(|(one, other)| one == other).count();
    (&a[..a.len() - suffix], &b[..b.len() - suffix], prefix + suffix)
}

/// Returns the fewest edits from `a` to `b`; for short sequences an upper bound (Ukkonen, 1985: a band around the diagonal
/// that is doubled until it is wide enough).
fn distance(a: &[u32], b: &[u32]) -> usize {
    let (a, b, _) = without_common_ends(a, b);
    let most = a.len().max(b.len());
    if most <= 256 {
        // A bound suffices for small matrices.
        return most;
    }
    let mut band = a.len().abs_diff(b.len()).max(63);
    loop {
        let edits = last_row(a, b, band.min(most)).last().map_or(0, |edits| *edits as usize);
        if edits <= band || band >= most {
            return edits;
        }
        band *= 2;
    }
}

/// Returns the fewest edits from every prefix of `a` to `b`, correct where they are at most `most`.
fn last_row(a: &[u32], b: &[u32], most: usize) -> Vec<u32> {
    let mut row = vec![FAR; a.len() + 1];
    let (mut from, mut differences) = (0, Vec::new());
    let edits = Matrix::new(a, most).sweep(b, |first, blocks| {
        from = 64 * first;
        differences.clear();
        differences.extend_from_slice(blocks);
    });
    let Some(mut edits) = edits else { return row };
    row[from] = edits;
    for (at, place) in row[from + 1..].iter_mut().take(64 * differences.len()).enumerate() {
        edits = edits.wrapping_add_signed(differences[at / 64].difference(at));
        *place = edits;
    }
    row
}

/// Differences of the distances at 64 positions to those at the previous positions.
#[derive(Debug, Clone, Copy)]
struct Block {
    /// Positions where the difference is 1.
    plus: u64,
    /// Positions where the difference is -1.
    minus: u64,
}

impl Block {
    fn difference(&self, place: usize) -> i32 {
        let bit = |bits: u64| (bits >> (place % 64) & 1) as i32;
        bit(self.plus) - bit(self.minus)
    }
}

/// The distances between the prefixes of two sequences, in a band around the diagonal.
struct Matrix {
    /// Positions of each symbol in the sequence, ascending, symbol after symbol.
    places: Vec<usize>,
    /// Start of each symbol in `places`.
    begins: Vec<usize>,
    blocks: Vec<Block>,
    length: usize,
    most: usize,
}

impl Matrix {
    fn new(a: &[u32], most: usize) -> Self {
        let symbols = a.iter().max().map_or(0, |symbol| *symbol as usize + 1);
        let mut begins = vec![0; symbols + 2];
        // Counted with an offset of one, so that the pass over the sequence moves each start to its final value.
        a.iter().for_each(|symbol| begins[*symbol as usize + 2] += 1);
        for symbol in 2..begins.len() {
            begins[symbol] += begins[symbol - 1];
        }
        let mut places = vec![0; a.len()];
        for (at, symbol) in a.iter().enumerate() {
            let next = &mut begins[*symbol as usize + 1];
            places[*next] = at;
            *next += 1;
        }
        // Before any symbol of the other sequence, each position is one deletion further than the previous one. The same
        // is an upper bound for positions that the band did not reach yet.
        let blocks = vec![Block { plus: u64::MAX, minus: 0 }; a.len().div_ceil(64)];
        Self { places, begins, blocks, length: a.len(), most }
    }

    /// Returns the positions of `symbol` in `range`.
    fn places_of(&self, symbol: u32, range: Range<usize>) -> &[usize] {
        let symbol = symbol as usize;
        let (Some(begin), Some(end)) = (self.begins.get(symbol), self.begins.get(symbol + 1)) else {
            return &[];
        };
        let places = &self.places[*begin..*end];
        let places = &places[places.partition_point(|at| *at < range.start)..];
        &places[..places.partition_point(|at| *at < range.end)]
    }

    /// Calls `each` with the first block of the band and the blocks from there on, after every symbol of `b`. Returns the
    /// distance before the first of the last blocks; `None` if the band left the matrix, or there is no symbol.
    fn sweep(&mut self, b: &[u32], mut each: impl FnMut(usize, &[Block])) -> Option<u32> {
        let (mut top, mut edits) = (0, 0);
        let mut equal = vec![0; self.blocks.len()];
        for (j, symbol) in (1..).zip(b) {
            let first = usize::saturating_sub(j, self.most + 1) / 64;
            let end = self.length.min(j + self.most).div_ceil(64);
            if first >= end {
                return None;
            }
            for block in &self.blocks[top..first] {
                edits = edits + block.plus.count_ones() - block.minus.count_ones();
            }
            top = first;
            edits += 1;
            let places = self.places_of(*symbol, 64 * first..64 * end);
            places.iter().for_each(|at| equal[at / 64] |= 1 << (at % 64));
            // Above the band, as above the matrix, distances increase by one.
            let mut carry = (1, 0);
            for (block, equal) in self.blocks[first..end].iter_mut().zip(&mut equal[first..end]) {
                carry = block.advance(*equal, carry);
                *equal = 0;
            }
            each(first, &self.blocks[first..end]);
        }
        (!b.is_empty()).then_some(edits)
    }
}

impl Block {
    /// Advances by a symbol that occurs at the positions set in `equal`. `carry` states whether the distance before the
    /// first position increases or decreases; the result states the same for the last position.
    fn advance(&mut self, equal: u64, (grows, falls): (u64, u64)) -> (u64, u64) {
        let matched = equal | falls;
        let diagonal = ((matched & self.plus).wrapping_add(self.plus) ^ self.plus) | matched | self.minus;
        let right_plus = self.minus | !(diagonal | self.plus);
        let right_minus = diagonal & self.plus;
        let carry = (right_plus >> 63, right_minus >> 63);
        let right_plus = right_plus << 1 | grows;
        let right_minus = right_minus << 1 | falls;
        self.plus = right_minus | !(diagonal | right_plus);
        self.minus = right_plus & diagonal;
        carry
    }
}

#[cfg(test)]
mod tests {
    use opendr_engine::Random;

    use super::*;

    fn counts(a: &str, b: &str) -> [u64; 4] {
        let counts = EditCounts::of(a.as_bytes(), b.as_bytes());
        [counts.hits, counts.substitutions, counts.deletions, counts.insertions]
    }

    #[test]
    fn edits_by_hand() {
        assert_eq!(counts("", ""), [0, 0, 0, 0]);
        assert_eq!(counts("abc", ""), [0, 0, 3, 0]);
        assert_eq!(counts("", "abc"), [0, 0, 0, 3]);
        assert_eq!(counts("kitten", "sitting"), [4, 2, 0, 1]);
        assert_eq!(counts("abcd", "bcde"), [3, 0, 1, 1]);
    }

    /// Compares with the plain matrix, and checks the sums of the counts.
    fn check(a: &[u8], b: &[u8]) {
        let mut row: Vec<usize> = (0..=b.len()).collect();
        for (i, symbol) in a.iter().enumerate() {
            let mut diagonal = row[0];
            row[0] = i + 1;
            for (j, other) in b.iter().enumerate() {
                let edits = (diagonal + usize::from(symbol != other)).min(row[j] + 1).min(row[j + 1] + 1);
                diagonal = std::mem::replace(&mut row[j + 1], edits);
            }
        }
        let counts = EditCounts::of(a, b);
        assert_eq!(counts.errors(), row[b.len()] as u64);
        assert_eq!(counts.hits + counts.substitutions + counts.deletions, a.len() as u64);
        assert_eq!(counts.hits + counts.substitutions + counts.insertions, b.len() as u64);
    }

    #[test]
    fn edits_of_random_texts() {
        let mut random = Random::new(3);
        for round in 0..200 {
            let letters = 2 + round % 4;
            let mut text = |length: usize| -> Vec<u8> {
                let length = random.below(length);
                (0..length).map(|_| random.below(letters) as u8).collect()
            };
            let (a, b) = (text(150), text(150));
            check(&a, &b);
        }
    }

    #[test]
    fn edits_of_halved_texts() {
        let mut random = Random::new(4);
        let a: Vec<u8> = (0..3000).map(|_| random.below(3) as u8).collect();
        let b: Vec<u8> = (0..2500).map(|_| random.below(3) as u8).collect();
        check(&a, &b);
        // A few edits only: a narrow band.
        let mut c = a.clone();
        c.remove(2900);
        c.insert(40, 7);
        c[1500] = 9;
        check(&a, &c);
        assert_eq!(EditCounts::of(&a, &c).errors(), 3);
    }
}
