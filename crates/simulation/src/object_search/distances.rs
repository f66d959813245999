//! Lengths of shortest paths on the grid.

use super::CELL;
use super::grid::{CELLS, column_row, index};

/// Lengths of the shortest paths from one cell to all others, by steps to the eight neighbours (Dial, Algorithm 360, 1969).
#[derive(Debug, Clone)]
pub(super) struct Distances {
    lengths: Vec<u32>,
    /// Cells by length, modulo the number of buckets.
    buckets: [Vec<u32>; BUCKETS],
}

const BUCKETS: usize = 15;
/// Lengths of a straight and of a diagonal step, in tenths of a cell.
const STRAIGHT: u32 = 10;
const DIAGONAL: u32 = 14;
const NEIGHBOURS: [([i32; 2], u32); 8] = [
    ([1, 0], STRAIGHT),
    ([-1, 0], STRAIGHT),
    ([0, 1], STRAIGHT),
    ([0, -1], STRAIGHT),
    ([1, 1], DIAGONAL),
    ([1, -1], DIAGONAL),
    ([-1, 1], DIAGONAL),
    ([-1, -1], DIAGONAL),
];

impl Default for Distances {
    fn default() -> Self {
        Self { lengths: vec![u32::MAX; CELLS], buckets: std::array::from_fn(|_| Vec::new()) }
    }
}

impl Distances {
    /// Computes the lengths from `start` over the cells that `free` allows; the start need not be free.
    pub fn compute(&mut self, start: usize, free: impl Fn(usize) -> bool) {
        self.lengths.fill(u32::MAX);
        self.buckets.iter_mut().for_each(Vec::clear);
        let Some(first) = self.lengths.get_mut(start) else { return };
        *first = 0;
        self.buckets[0].push(start as u32);
        let (mut length, mut waiting) = (0, 1);
        while waiting > 0 {
            while let Some(cell) = self.buckets[length as usize % BUCKETS].pop() {
                waiting -= 1;
                if self.lengths[cell as usize] != length {
                    continue;
                }
                let [x, y] = column_row(cell as usize);
                for ([right, down], step) in NEIGHBOURS {
                    let Some(next) = index([x + right, y + down]).filter(|next| free(*next)) else {
                        continue;
                    };
                    if length + step < self.lengths[next] {
                        self.lengths[next] = length + step;
                        self.buckets[(length + step) as usize % BUCKETS].push(next as u32);
                        waiting += 1;
                    }
                }
            }
            length += 1;
        }
    }

    /// Returns the length of the path to a cell in metres; none if there is no path.
    pub fn metres(&self, cell: usize) -> Option<f64> {
        self.lengths
            .get(cell)
            .filter(|length| **length < u32::MAX)
            .map(|length| f64::from(*length) * CELL / f64::from(STRAIGHT))
    }

    /// Writes the cells of a shortest path to `end`, without the start; none if there is no path.
    pub fn path_to(&self, end: usize, path: &mut Vec<usize>) {
        path.clear();
        if self.metres(end).is_none() {
            return;
        }
        let mut cell = end;
        while self.lengths[cell] > 0 {
            path.push(cell);
            let [x, y] = column_row(cell);
            let before = NEIGHBOURS.iter().filter_map(|([right, down], step)| {
                let near = index([x + right, y + down])?;
                (self.lengths[near].checked_add(*step)? == self.lengths[cell]).then_some(near)
            });
            // Every length but 0 has a cell before it.
            cell = before.min().unwrap_or(cell);
            if path.len() > CELLS {
                break;
            }
        }
        path.reverse();
    }
}
