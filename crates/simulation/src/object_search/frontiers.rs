//! Where the robot can drive next: frontiers of its map, and objects that it has seen.

use super::distances::Distances;
use super::episode::Episode;
use super::grid::{CELLS, cell_of, column_row, disc, index, middle};
use super::sensor::is_clear;
use super::{Cell, KnownMap, OBJECTS};

/// A place to drive to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Candidate {
    /// Cell to drive to.
    pub target: usize,
    /// Cell to look at: in the middle of a frontier, or an object.
    pub look: usize,
    /// The object; none for a frontier.
    pub object: Option<usize>,
    /// Length of the way, metres.
    pub length: f64,
    /// Cells of the frontier.
    pub size: usize,
    /// Shares of unknown cells around the place, near it and farther.
    pub unknown: [f64; 2],
}

/// Candidates of a map, by the length of the way.
#[derive(Debug, Clone)]
pub(super) struct Frontiers {
    pub distances: Distances,
    pub candidates: Vec<Candidate>,
    /// Frontier cells that could not be resolved.
    given_up: Vec<bool>,
    taken: Vec<bool>,
    cluster: Vec<usize>,
}

/// Smallest frontier, in cells.
const SMALLEST: usize = 3;
/// From how far a frontier and an object are approached, in cells.
const REACH: f64 = 4.0;
const OBJECT_REACH: f64 = 9.0;
/// Radii around a place in which unknown cells are counted, in cells.
const AROUND: [f64; 2] = [12.0, 25.0];
/// Radius around a place that is given up, in cells.
const GIVEN_UP: f64 = 5.0;

impl Default for Frontiers {
    fn default() -> Self {
        Self {
            distances: Distances::default(),
            candidates: Vec::new(),
            given_up: vec![false; CELLS],
            taken: vec![false; CELLS],
            cluster: Vec::new(),
        }
    }
}

impl Frontiers {
    /// Forgets what was given up.
    pub fn reset(&mut self) {
        self.given_up.fill(false);
        self.candidates.clear();
    }

    /// Gives up the frontier around a cell.
    pub fn give_up(&mut self, look: usize) {
        disc(look, GIVEN_UP, |cell| self.given_up[cell] = true);
    }

    /// Sets whether a cell was given up.
    pub fn set_given_up(&mut self, cell: usize, given_up: bool) {
        self.given_up[cell] = given_up;
    }

    /// Returns the cells that were given up.
    pub fn given_up(&self) -> &[bool] {
        &self.given_up
    }

    /// Finds all candidates.
    pub fn find(&mut self, episode: &Episode) {
        let map = &episode.map;
        self.candidates.clear();
        let [x, y, _] = episode.pose;
        let Some(start) = cell_of([x, y]) else { return };
        self.distances.compute(start, |cell| map.is_passable(cell));
        for object in (0..OBJECTS).filter(|at| episode.seen[*at] && !episode.found[*at]) {
            let look = episode.plan.objects().get(object).and_then(|place| cell_of(*place));
            let nearest = look.and_then(|look| Some((look, self.nearest(map, look, OBJECT_REACH)?)));
            let Some((look, (target, length))) = nearest else { continue };
            self.candidates.push(Candidate {
                target,
                look,
                object: Some(object),
                length,
                size: 0,
                unknown: AROUND.map(|radius| unknown_share(map, look, radius)),
            });
        }
        self.taken.fill(false);
        for cell in 0..CELLS {
            if self.is_open(episode, cell) {
                let found = self.cluster_at(episode, cell);
                self.candidates.extend(found);
            }
        }
        self.candidates.sort_by(|one, other| one.length.total_cmp(&other.length));
    }

    fn is_open(&self, episode: &Episode, cell: usize) -> bool {
        !self.taken[cell] && !self.given_up[cell] && episode.map.is_frontier(cell)
    }

    /// Collects the frontier that a cell belongs to; none if it is small or out of reach.
    fn cluster_at(&mut self, episode: &Episode, first: usize) -> Option<Candidate> {
        self.cluster.clear();
        self.cluster.push(first);
        self.taken[first] = true;
        let mut at = 0;
        while let Some(cell) = self.cluster.get(at) {
            let [x, y] = column_row(*cell);
            for near in (-1..=1).flat_map(|down| (-1..=1).map(move |right| [x + right, y + down])) {
                let Some(near) = index(near).filter(|near| self.is_open(episode, *near)) else { continue };
                self.taken[near] = true;
                self.cluster.push(near);
            }
            at += 1;
        }
        if self.cluster.len() < SMALLEST {
            return None;
        }
        let (size, count) = (self.cluster.len(), self.cluster.len() as f64);
        let sum = self
            .cluster
            .iter()
            .map(|cell| middle(*cell))
            .fold([0.0; 2], |sum, place| [sum[0] + place[0], sum[1] + place[1]]);
        let centre = sum.map(|part| part / count);
        let from_centre = |cell: &&usize| super::grid::distance(middle(**cell), centre);
        let look =
            *self.cluster.iter().min_by(|one, other| from_centre(one).total_cmp(&from_centre(other)))?;
        let ways = self.cluster.iter().filter_map(|cell| self.nearest(&episode.map, *cell, REACH));
        let (target, length) = ways.min_by(|one, other| one.1.total_cmp(&other.1))?;
        let unknown = AROUND.map(|radius| unknown_share(&episode.map, look, radius));
        Some(Candidate { target, look, object: None, length, size, unknown })
    }

    /// Returns the cell with the shortest way among those from which a cell can be seen, and the length of its way.
    fn nearest(&self, map: &KnownMap, cell: usize, reach: f64) -> Option<(usize, f64)> {
        let mut best: Option<(usize, f64)> = None;
        disc(cell, reach, |near| {
            if let Some(length) = self.distances.metres(near)
                && best.is_none_or(|(_, shortest)| length < shortest)
                && is_clear(map, near, cell)
            {
                best = Some((near, length));
            }
        });
        best
    }
}

/// Returns the share of unknown cells within `radius` cells of a cell.
fn unknown_share(map: &KnownMap, centre: usize, radius: f64) -> f64 {
    let (mut unknown, mut all) = (0_u32, 0_u32);
    disc(centre, radius, |cell| {
        all += 1;
        unknown += u32::from(map.cell(cell) == Cell::Unknown);
    });
    f64::from(unknown) / f64::from(all.max(1))
}
