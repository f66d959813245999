//! The fewest edits that turn one sequence into another, told apart as RapidFuzz does (which jiwer counts with).
//!
//! Several alignments can have the fewest edits but differ in their hits. RapidFuzz prefers, from the end backwards, a
//! deletion to an insertion to a substitution or hit, after ends that are alike are cut off, and halves what is too
//! large for a matrix (Hirschberg); so does this, with as much memory as the matrix of at most 4 Mi places.

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
    pub fn of<T: PartialEq>(reference: &[T], hypothesis: &[T]) -> Self {
        let mut counts = Self::default();
        counts.align(reference, hypothesis, distance(reference, hypothesis));
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
    fn align<T: PartialEq>(&mut self, a: &[T], b: &[T], most: usize) {
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
        let (a_reversed, right_reversed): (Vec<&T>, Vec<&T>) =
            (a.iter().rev().collect(), right.iter().rev().collect());
        let mut end = last_row(&a_reversed, &right_reversed, most);
        end.reverse();
        let edits = begin.iter().zip(&end).map(|(before, after)| before + after);
        let cut = edits.enumerate().min_by_key(|(_, edits)| *edits).map_or(0, |(cut, _)| cut);
        self.align(&a[..cut], left, begin[cut] as usize);
        self.align(&a[cut..], right, end[cut] as usize);
    }

    /// As [`EditCounts::align`], through a matrix of the last step to every place.
    fn trace<T: PartialEq>(&mut self, a: &[T], b: &[T], most: usize) {
        let width = a.len().min(2 * most + 1);
        let first = |j: usize| j.saturating_sub(most).max(1);
        let mut steps = vec![Step::Both; width * b.len()];
        sweep(a, b, most, |i, j, step| steps[(j - 1) * width + i - first(j)] = step);
        let (mut i, mut j) = (a.len(), b.len());
        while i > 0 && j > 0 {
            match steps[(j - 1) * width + i - first(j)] {
                Step::Delete => {
                    self.deletions += 1;
                    i -= 1;
                }
                Step::Insert => {
                    self.insertions += 1;
                    j -= 1;
                }
                Step::Both => {
                    (i, j) = (i - 1, j - 1);
                    *if a[i] == b[j] { &mut self.hits } else { &mut self.substitutions } += 1;
                }
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

/// How the last symbols are accounted for on a shortest way.
#[derive(Clone, Copy)]
enum Step {
    Delete,
    Insert,
    Both,
}

/// What is between the ends that `a` and `b` share, and how many symbols those have.
fn without_common_ends<'a, T: PartialEq>(a: &'a [T], b: &'a [T]) -> (&'a [T], &'a [T], usize) {
    let prefix = a.iter().zip(b).take_while(|(one, other)| one == other).count();
    let (a, b) = (&a[prefix..], &b[prefix..]);
    let suffix = a.iter().rev().zip(b.iter().rev()).take_while(|(one, other)| one == other).count();
    (&a[..a.len() - suffix], &b[..b.len() - suffix], prefix + suffix)
}

/// The fewest edits from `a` to `b`, or, of short ones, a bound (Ukkonen, 1985: a band around the diagonal, doubled until it is wide enough).
fn distance<T: PartialEq>(a: &[T], b: &[T]) -> usize {
    let (a, b, _) = without_common_ends(a, b);
    let most = a.len().max(b.len());
    if most <= 64 {
        // A bound will do where the matrix is small anyway.
        return most;
    }
    let mut band = a.len().abs_diff(b.len()).max(31);
    loop {
        let edits = last_row(a, b, band.min(most)).last().map_or(0, |edits| *edits as usize);
        if edits <= band || band >= most {
            return edits;
        }
        band *= 2;
    }
}

/// The fewest edits from every beginning of `a` to `b`, right where they are at most `most`.
fn last_row<T: PartialEq>(a: &[T], b: &[T], most: usize) -> Vec<u32> {
    sweep(a, b, most, |_, _, _| {})
}

/// Goes through the matrix of distances between the first `i` symbols of `a` and the first `j` of `b`, both from 1, no
/// further than `most` off the diagonal; gives its last row.
fn sweep<T: PartialEq>(a: &[T], b: &[T], most: usize, mut each: impl FnMut(usize, usize, Step)) -> Vec<u32> {
    let mut row: Vec<u32> = (0..=a.len()).map(|i| if i <= most { i as u32 } else { FAR }).collect();
    for (j, symbol) in (1..).zip(b) {
        let begin = usize::saturating_sub(j, most);
        if begin > a.len() {
            return vec![FAR; a.len() + 1];
        }
        // In the row before: the places to the left and above.
        let mut diagonal = row[begin.saturating_sub(1)];
        if begin == 0 {
            row[0] = j as u32;
        } else {
            row[begin - 1] = FAR;
        }
        for i in begin.max(1)..=a.len().min(j + most) {
            let (above, left) = (row[i], row[i - 1]);
            let edits = (diagonal + u32::from(a[i - 1] != *symbol)).min(above + 1).min(left + 1);
            let step = match (edits == left + 1, above + 1 == diagonal) {
                (true, _) => Step::Delete,
                (false, true) => Step::Insert,
                (false, false) => Step::Both,
            };
            each(i, j, step);
            row[i] = edits;
            diagonal = above;
        }
    }
    row
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
