//! Random generation of obstacles and walls.

use opendr_engine::{Random, Result};

use super::{CorridorOptions, FINISH, HALF_TRACK, HEIGHT, RADIUS, START};
use crate::raycast::{Body, Scene, Shape, Vector};

/// The world of one flight: obstacles, walls if drawn, the ground.
#[derive(Debug, Clone, Default)]
pub struct CorridorWorld {
    scene: Scene,
    /// Number of obstacles, which are the first bodies.
    obstacles: usize,
    walls: Option<f32>,
    start: f32,
}

/// Labels of the bodies.
const GROUND: u16 = 0;
const WALL: u16 = 1;
const CYLINDER: u16 = 2;
const BOX: u16 = 3;
const SPHERE: u16 = 4;
/// Maximum number of each shape.
const MAX_PER_SHAPE: usize = 5;
/// x of the ends of the walls, their height and thickness.
const WALL_ENDS: (f32, f32) = (-11.0, 19.0);
const WALL_HEIGHT: f32 = 6.0;
const WALL_THICKNESS: f32 = 0.2;

impl CorridorWorld {
    /// Generates a new world with the distribution of OpenDR's `ObstacleRandomizer`.
    pub(super) fn generate(&mut self, random: &mut Random, options: &CorridorOptions) -> Result<()> {
        self.scene.clear();
        self.start = random.uniform(-0.5, 0.5);
        self.walls = random.chance(options.walls).then(|| random.uniform(4.0, 10.0) / 2.0);
        let spread = (options.max_obstacles - options.min_obstacles) as usize;
        self.obstacles = options.min_obstacles as usize + random.below(spread + 1);
        let [cylinders, boxes, _] = self.counts(random);
        for number in 0..self.obstacles {
            let label = match number {
                _ if number < cylinders => CYLINDER,
                _ if number < cylinders + boxes => BOX,
                _ => SPHERE,
            };
            self.scene.add(obstacle(random, label)?);
        }
        self.add_walls()?;
        self.scene.add(Body::upright(Shape::HalfSpace, [0.0; 3], GROUND)?);
        Ok(())
    }

    /// Returns the numbers of cylinders, boxes and spheres, drawn again while there are too many of one.
    fn counts(&self, random: &mut Random) -> [usize; 3] {
        loop {
            let mut counts = [0; 3];
            (0..self.obstacles).for_each(|_| counts[random.below(3)] += 1);
            if counts.iter().all(|count| *count <= MAX_PER_SHAPE) {
                return counts;
            }
        }
    }

    fn add_walls(&mut self) -> Result<()> {
        let Some(aside) = self.walls else { return Ok(()) };
        let (begin, end) = WALL_ENDS;
        let half = [(end - begin) / 2.0, WALL_THICKNESS / 2.0, WALL_HEIGHT / 2.0];
        for side in [-1.0, 1.0] {
            let middle = [(begin + end) / 2.0, side * (aside + half[1]), half[2]];
            self.scene.add(Body::upright(Shape::Box { half }, middle, WALL)?);
        }
        Ok(())
    }

    /// Returns the start of the flight.
    pub fn start(&self) -> Vector {
        [START, self.start, HEIGHT]
    }

    /// Returns the scene: obstacles, then walls, then the ground. Labels: 0 ground, 1 wall, 2 cylinder, 3 box, 4 sphere.
    pub fn scene(&self) -> &Scene {
        &self.scene
    }

    /// Returns the obstacles without walls and ground.
    pub fn obstacles(&self) -> &[Body] {
        &self.scene.bodies()[..self.obstacles]
    }

    /// Returns the distance of the walls from the middle; none without walls.
    pub fn walls(&self) -> Option<f32> {
        self.walls
    }

    /// Returns whether a ball of `radius` touches an obstacle.
    pub(super) fn is_occupied(&self, centre: Vector, radius: f32) -> bool {
        self.obstacles().iter().any(|body| body.distance(centre) < radius)
    }

    /// Returns whether a path to the finish exists at the height of the flight, on a grid of 0.1 m: an upper bound for any
    /// controller.
    pub fn is_passable(&self) -> bool {
        const STEPS: f32 = 10.0;
        let columns = ((FINISH - START) * STEPS) as usize + 1;
        let rows = (2.0 * HALF_TRACK * STEPS) as usize + 1;
        let is_free = |column: usize, row: usize| {
            let point = [START + column as f32 / STEPS, row as f32 / STEPS - HALF_TRACK, HEIGHT];
            self.scene.distance(point) >= RADIUS
        };
        let mut visited = vec![false; columns * rows];
        let mut open = vec![(0, ((self.start + HALF_TRACK) * STEPS) as usize)];
        while let Some((column, row)) = open.pop() {
            if column >= columns || row >= rows || std::mem::replace(&mut visited[column * rows + row], true)
            {
                continue;
            }
            if !is_free(column, row) {
                continue;
            }
            if column == columns - 1 {
                return true;
            }
            // Negative indices wrap to values beyond the grid.
            open.extend([(column.wrapping_sub(1), row), (column, row.wrapping_sub(1))]);
            open.extend([(column, row + 1), (column + 1, row)]);
        }
        false
    }
}

fn obstacle(random: &mut Random, label: u16) -> Result<Body> {
    let aside = 2.5 * random.normal() as f32;
    let position = [random.uniform(-7.0, 20.0), aside, random.uniform(2.0, 3.0)];
    // Four normal numbers are a uniformly distributed rotation.
    let rotation = [(); 4].map(|()| random.normal() as f32);
    let mut size = |low: f32, high: f32| random.uniform(low, high) / 2.0;
    let shape = match label {
        CYLINDER => Shape::Cylinder { radius: size(1.0, 3.0), half_height: size(1.0, 3.0) },
        BOX => Shape::Box { half: [(); 3].map(|()| size(0.5, 2.5)) },
        _ => Shape::Sphere { radius: size(1.0, 3.0) },
    };
    Body::new(shape, position, rotation, label)
}
