//! What the robot knows of the floor plan.

use opendr_engine::environment::{Snapshot, StateReader};
use opendr_engine::{Error, Result};

use super::floor_plan::WITH_MARGIN;
use super::grid::{CELLS, beside, cell_of, disc};

/// What is known of a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Cell {
    /// Not seen yet.
    #[default]
    Unknown,
    /// Without obstacles.
    Free,
    /// A wall or furniture.
    Occupied,
}

/// The map that the camera has revealed.
#[derive(Debug, Clone)]
pub struct KnownMap {
    cells: Vec<Cell>,
    /// Cells too near to known obstacles to drive through.
    near: Vec<bool>,
    known: usize,
}

impl Default for KnownMap {
    fn default() -> Self {
        Self { cells: vec![Cell::Unknown; CELLS], near: vec![false; CELLS], known: 0 }
    }
}

impl KnownMap {
    /// Returns what is known at a place in metres; occupied outside the plan.
    pub fn at(&self, place: [f64; 2]) -> Cell {
        cell_of(place).map_or(Cell::Occupied, |cell| self.cells[cell])
    }

    /// Returns the share of cells that are known.
    pub fn known_share(&self) -> f64 {
        self.known as f64 / CELLS as f64
    }

    pub(super) fn cell(&self, cell: usize) -> Cell {
        self.cells[cell]
    }

    pub(super) fn note(&mut self, cell: usize, occupied: bool) {
        if self.cells[cell] != Cell::Unknown {
            return;
        }
        self.known += 1;
        self.cells[cell] = if occupied { Cell::Occupied } else { Cell::Free };
        if occupied {
            disc(cell, WITH_MARGIN, |near| self.near[near] = true);
        }
    }

    /// Returns whether the robot can drive through a cell.
    pub(super) fn is_passable(&self, cell: usize) -> bool {
        self.cells[cell] == Cell::Free && !self.near[cell]
    }

    /// Returns whether a cell is free and next to an unknown one.
    pub(super) fn is_frontier(&self, cell: usize) -> bool {
        self.cells[cell] == Cell::Free && beside(cell).any(|near| self.cells[near] == Cell::Unknown)
    }

    pub(super) fn clear(&mut self) {
        self.cells.fill(Cell::Unknown);
        self.near.fill(false);
        self.known = 0;
    }

    pub(super) fn save(&self, snapshot: &mut Snapshot) {
        for cells in self.cells.chunks(32) {
            let word = cells.iter().rev().fold(0_u64, |word, cell| word << 2 | *cell as u64);
            snapshot.push(word);
        }
    }

    pub(super) fn load(&mut self, state: &mut StateReader<'_>) -> Result<()> {
        self.clear();
        for first in (0..CELLS).step_by(32) {
            let mut word = state.word()?;
            for cell in first..(first + 32).min(CELLS) {
                match word & 3 {
                    0 => (),
                    kind @ 1..=2 => self.note(cell, kind == 2),
                    _ => return Err(Error::format("a snapshot with a cell of no kind")),
                }
                word >>= 2;
            }
        }
        Ok(())
    }
}
