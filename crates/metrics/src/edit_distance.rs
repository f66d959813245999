//! The fewest edits that turn one sequence into another, told apart as RapidFuzz does (which jiwer counts with).
//!
//! Several alignments can have the fewest edits but differ in their hits. RapidFuzz prefers, from the end backwards, a
//! deletion to an insertion to a substitution or hit, after ends that are alike are cut off, and halves what is too
//! large for a matrix (Hirschberg); so does this. The matrix is gone through 64 places at once (Myers, 1999; Hyyrö, 2003).

use std::collections::HashMap;
use std::hash::Hash;
use std::ops::Range;

/// How a sequence differs from its reference.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct EditCounts {
    /// Symbols of the reference that are there.
    pub hits: u64,
    /// Symbols of the reference that are replaced.
    pub substitutions: u64,
    /// Symbols of the reference that are missing.
    pub deletions: u64,
    /// Symbols that the reference does not have.
    pub insertions: u64,
}

impl EditCounts {
    /// Of `hypothesis` against `reference`. Takes time in proportion to the length times the number of edits.
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

    /// All edits.
    pub fn errors(&self) -> u64 {
        self.substitutions + self.deletions + self.insertions
    }

    /// Adds other counts.
    pub fn add(&mut self, other: &Self) {
        self.hits += other.hits;
        self.substitutions += other.substitutions;
        self.deletions += other.deletions;
        self.insertions += other.insertions;
    }

    /// Counts the edits from `a` to `b`, of which there are at most `most`.
    fn align(&mut self, a: &[u32], b: &[u32], most: usize) {
        let (a, b, same) = without_common_ends(a, b);
        self.hits += same as u64;
        let most = most.min(a.len().max(b.len()));
        let band = a.len().min(2 * most + 1);
        if band * b.len() / 4 < MATRIX_BYTES || a.len() < 65 || b.len() < 10 {
            return self.trace(a, b, most);
        }
        // The halves have their own fewest edits: where both together are fewest, `a` is cut.
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

    /// As [`EditCounts::align`], backwards through a matrix that is kept.
    fn trace(&mut self, a: &[u32], b: &[u32], most: usize) {
        let (mut kept, mut rows) = (Vec::new(), Vec::with_capacity(b.len()));
        Matrix::new(a, most).sweep(b, |first, blocks| {
            rows.push((first, kept.len()));
            kept.extend_from_slice(blocks);
        });
        rows.push((0, kept.len()));
        // How much further the `i`th place of `a` is than the one before it, after `j` symbols of `b`.
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

/// Two bits for each place, as RapidFuzz keeps them, may take less than this.
const MATRIX_BYTES: usize = 1 << 20;

/// Further than any distance.
const FAR: u32 = u32::MAX / 4;

/// What is between the ends that `a` and `b` share, and how many symbols those have.
fn without_common_ends<'a>(a: &'a [u32], b: &'a [u32]) -> (&'a [u32], &'a [u32], usize) {
    let prefix = a.iter().zip(b).take_while(|(one, other)| one == other).count();
    let (a, b) = (&a[prefix..], &b[prefix..]);
    let suffix = a.iter().rev().zip(b.iter().rev()).take_while(|(one, other)| one == other).count();
    (&a[..a.len() - suffix], &b[..b.len() - suffix], prefix + suffix)
}

/// The fewest edits from `a` to `b`, or, of short ones, a bound (Ukkonen, 1985: a band around the diagonal, doubled until
/// it is wide enough).
fn distance(a: &[u32], b: &[u32]) -> usize {
    let (a, b, _) = without_common_ends(a, b);
    let most = a.len().max(b.len());
    if most <= 256 {
        // A bound will do where the matrix is small anyway.
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

/// The fewest edits from every beginning of `a` to `b`, right where they are at most `most`.
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

/// Differences between the distances at 64 places and those at the places before them.
#[derive(Debug, Clone, Copy)]
struct Block {
    /// Where it is 1.
    plus: u64,
    /// Where it is -1.
    minus: u64,
}

impl Block {
    fn difference(&self, place: usize) -> i32 {
        let bit = |bits: u64| (bits >> (place % 64) & 1) as i32;
        bit(self.plus) - bit(self.minus)
    }
}

/// The distances between the beginnings of a sequence and those of another, in a band around the diagonal.
struct Matrix {
    /// Where in the sequence each symbol stands, ascending, symbol after symbol.
    places: Vec<usize>,
    /// Where in `places` each symbol begins.
    begins: Vec<usize>,
    blocks: Vec<Block>,
    length: usize,
    most: usize,
}

impl Matrix {
    fn new(a: &[u32], most: usize) -> Self {
        let symbols = a.iter().max().map_or(0, |symbol| *symbol as usize + 1);
        let mut begins = vec![0; symbols + 2];
        // Counted one too far, so that going through the sequence moves each beginning to where it belongs.
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
        // Before any symbol of the other sequence, every place is one deletion further than the one before. So is, as an
        // upper bound, a place that the band did not reach yet.
        let blocks = vec![Block { plus: u64::MAX, minus: 0 }; a.len().div_ceil(64)];
        Self { places, begins, blocks, length: a.len(), most }
    }

    /// Where `symbol` stands among the places `range`.
    fn places_of(&self, symbol: u32, range: Range<usize>) -> &[usize] {
        let symbol = symbol as usize;
        let (Some(begin), Some(end)) = (self.begins.get(symbol), self.begins.get(symbol + 1)) else {
            return &[];
        };
        let places = &self.places[*begin..*end];
        let places = &places[places.partition_point(|at| *at < range.start)..];
        &places[..places.partition_point(|at| *at < range.end)]
    }

    /// Hands the first block of the band and the blocks from there to `each` after every symbol of `b`. Gives the
    /// distance before the first of the last ones; `None` where the band left the matrix, or there is no symbol.
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
            // Above the band, as above the matrix, distances grow by one.
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
    /// Goes on by a symbol that stands where `equal` is set. `carry`: whether the distance just before the first place
    /// grows or falls by that; gives the same of the last place.
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

    /// The plain matrix, and what the counts must add up to.
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
    fn fewest_edits_of_random_texts() {
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
    fn fewest_edits_of_texts_that_are_halved() {
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
