//! Generated floor plans.

use opendr_engine::Random;

use super::distances::Distances;
use super::grid::{CELLS, cell_of, disc, distance, index, middle};
use super::{OBJECTS, ObjectSearchParams, SIDE};

/// A flat: rooms behind walls with doors, furniture, objects, and the robot's start.
#[derive(Debug, Clone)]
pub struct FloorPlan {
    occupied: Vec<bool>,
    /// Cells in which the robot would touch something.
    blocked: Vec<bool>,
    /// Positions of the objects, metres.
    objects: [[f64; 2]; OBJECTS],
    start: [f64; 3],
    /// Length of the shortest way from the start past all objects, metres.
    shortest: f64,
    /// Lengths of the ways from each object.
    ways: Vec<Distances>,
}

/// Radius of the robot, and with a margin, in cells.
pub(super) const RADIUS: f64 = 2.0;
pub(super) const WITH_MARGIN: f64 = 3.0;
/// Width of a door, and the shortest and longest side of a room, in cells.
const DOOR: i32 = 9;
const SHORTEST: i32 = 22;
const LONGEST: i32 = 46;
/// Least distance of objects from each other and from the start, metres.
const APART: f64 = 1.0;
const FROM_START: f64 = 2.0;

/// A rectangle of cells, without its last column and row.
type Rectangle = [i32; 4];

impl FloorPlan {
    /// Generates a plan.
    pub fn generate(random: &mut Random, params: &ObjectSearchParams) -> Self {
        loop {
            if let Some(plan) = Self::attempt(random, params) {
                return plan;
            }
        }
    }

    fn attempt(random: &mut Random, params: &ObjectSearchParams) -> Option<Self> {
        let mut occupied = rooms(random);
        furnish(&mut occupied, random, params.furniture);
        let blocked_with_margin = inflated(&occupied, WITH_MARGIN);
        let free: Vec<_> = (0..CELLS).filter(|cell| !blocked_with_margin[*cell]).collect();
        let start = *free.get(random.below(free.len()))?;
        let mut distances = Distances::default();
        distances.compute(start, |cell| !blocked_with_margin[cell]);
        let mut cells: Vec<usize> = Vec::new();
        for _ in 0..1000 {
            let cell = *free.get(random.below(free.len()))?;
            let apart = cells.iter().all(|other| distance(middle(*other), middle(cell)) > APART);
            if apart && distances.metres(cell).is_some_and(|length| length > FROM_START) {
                cells.push(cell);
            }
            if cells.len() == OBJECTS {
                break;
            }
        }
        let blocked = inflated(&occupied, RADIUS);
        let ways_from = |cell: &usize| {
            let mut ways = Distances::default();
            ways.compute(*cell, |cell| !blocked[cell]);
            ways
        };
        let ways: Vec<_> = cells.iter().map(ways_from).collect();
        let objects: [usize; OBJECTS] = cells.try_into().ok()?;
        let [x, y] = middle(start);
        let yaw = std::f64::consts::TAU * random.unit() - std::f64::consts::PI;
        Some(Self {
            shortest: shortest_tour(&ways, start, &objects)?,
            blocked,
            occupied,
            objects: objects.map(middle),
            start: [x, y, yaw],
            ways,
        })
    }

    /// Returns whether there is a wall or furniture at a place in metres; true outside the plan.
    pub fn is_occupied(&self, place: [f64; 2]) -> bool {
        cell_of(place).is_none_or(|cell| self.occupied[cell])
    }

    /// Returns the positions of the objects, in metres.
    pub fn objects(&self) -> &[[f64; 2]; OBJECTS] {
        &self.objects
    }

    /// Returns x, y and yaw at the start.
    pub fn start(&self) -> [f64; 3] {
        self.start
    }

    /// Returns the length in metres of the shortest way from the start past all objects, of all their orders.
    pub fn shortest(&self) -> f64 {
        self.shortest
    }

    /// Returns the way in metres from a place to an object; none without one.
    pub fn way_to(&self, object: usize, place: [f64; 2]) -> Option<f64> {
        self.ways.get(object)?.metres(cell_of(place)?)
    }

    pub(super) fn occupies(&self, cell: usize) -> bool {
        self.occupied[cell]
    }

    pub(super) fn blocks(&self, place: [f64; 2]) -> bool {
        cell_of(place).is_none_or(|cell| self.blocked[cell])
    }
}

/// Returns walls: rectangles are split until they are rooms, each wall with a door, and some walls with a second one.
fn rooms(random: &mut Random) -> Vec<bool> {
    let mut occupied = vec![false; CELLS];
    let side = SIDE as i32;
    for at in 0..side {
        for border in [[at, 0], [at, side - 1], [0, at], [side - 1, at]] {
            if let Some(cell) = index(border) {
                occupied[cell] = true;
            }
        }
    }
    let mut rectangles: Vec<Rectangle> = vec![[1, 1, side - 1, side - 1]];
    while let Some(rectangle) = rectangles.pop() {
        rectangles.extend(split(&mut occupied, rectangle, random).into_iter().flatten());
    }
    occupied
}

/// Builds a wall with a door through a rectangle that is too long for a room; returns the two parts.
fn split(occupied: &mut [bool], [x0, y0, x1, y1]: Rectangle, random: &mut Random) -> Option<[Rectangle; 2]> {
    let (width, height) = (x1 - x0, y1 - y0);
    // Walls run along y in wide rectangles: coordinates are across and along the wall.
    let wide = width >= height;
    let ([from, to], [begin, end]) = if wide { ([x0, x1], [y0, y1]) } else { ([y0, y1], [x0, x1]) };
    if to - from < LONGEST {
        return None;
    }
    let at = |across: i32, along: i32| index(if wide { [across, along] } else { [along, across] });
    let mut between = |low: i32, high: i32| low + random.below((high - low).max(1) as usize) as i32;
    let is_wall = |occupied: &[bool], across, along| at(across, along).is_some_and(|cell| occupied[cell]);
    // A wall must not end in a door.
    let across = (0..30).map(|_| between(from + SHORTEST, to - SHORTEST)).find(|across| {
        (-1..=1).all(|aside| {
            is_wall(occupied, across + aside, begin - 1) && is_wall(occupied, across + aside, end)
        })
    })?;
    for cell in (begin..end).filter_map(|along| at(across, along)) {
        occupied[cell] = true;
    }
    let doors = if end - begin > 3 * DOOR && between(0, 3) == 0 { 2 } else { 1 };
    for _ in 0..doors {
        let first = between(begin + 2, end - DOOR - 2);
        for cell in (first..first + DOOR).filter_map(|along| at(across, along)) {
            occupied[cell] = false;
        }
    }
    Some(if wide {
        [[x0, y0, across, y1], [across + 1, y0, x1, y1]]
    } else {
        [[x0, y0, x1, across], [x0, across + 1, x1, y1]]
    })
}

/// Places boxes wherever all free places stay connected.
fn furnish(occupied: &mut Vec<bool>, random: &mut Random, attempts: u32) {
    let mut distances = Distances::default();
    for _ in 0..attempts {
        let [width, height] = [(); 2].map(|()| 4 + random.below(11) as i32);
        let [x, y] = [(); 2].map(|()| 1 + random.below(SIDE - 2) as i32);
        let cells = (y..y + height).flat_map(|y| (x..x + width).map(move |x| index([x, y])));
        let Some(cells) = cells.collect::<Option<Vec<_>>>() else { continue };
        if cells.iter().any(|cell| occupied[*cell]) {
            continue;
        }
        let mut furnished = occupied.clone();
        cells.iter().for_each(|cell| furnished[*cell] = true);
        if is_connected(&inflated(&furnished, WITH_MARGIN), &mut distances) {
            *occupied = furnished;
        }
    }
}

fn is_connected(blocked: &[bool], distances: &mut Distances) -> bool {
    let Some(first) = blocked.iter().position(|blocked| !blocked) else { return false };
    distances.compute(first, |cell| !blocked[cell]);
    (0..CELLS).all(|cell| blocked[cell] || distances.metres(cell).is_some())
}

/// Returns the cells within `radius` cells of occupied ones.
fn inflated(occupied: &[bool], radius: f64) -> Vec<bool> {
    let mut blocked = vec![false; CELLS];
    for cell in (0..CELLS).filter(|cell| occupied[*cell]) {
        disc(cell, radius, |near| blocked[near] = true);
    }
    blocked
}

/// Returns the length of the shortest way from `start` past all objects; none if one cannot be reached.
fn shortest_tour(ways: &[Distances], start: usize, objects: &[usize; OBJECTS]) -> Option<f64> {
    // Shortest way past the objects of a set that ends at one of them (Held and Karp, 1962).
    let mut best = [[f64::INFINITY; OBJECTS]; 1 << OBJECTS];
    for (last, ways) in ways.iter().enumerate() {
        best[1 << last][last] = ways.metres(start)?;
    }
    for set in 1..1_usize << OBJECTS {
        for last in (0..OBJECTS).filter(|last| set >> last & 1 == 1) {
            for (next, ways) in ways.iter().enumerate().filter(|(next, _)| set >> next & 1 == 0) {
                let length = best[set][last] + ways.metres(objects[last])?;
                let known = &mut best[set | 1 << next][next];
                *known = known.min(length);
            }
        }
    }
    best.last()?.iter().copied().reduce(f64::min).filter(|length| length.is_finite())
}
