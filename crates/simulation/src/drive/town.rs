//! The town along a road.

use opendr_engine::overlap::RotatedRectangle;
use opendr_engine::{Random, Result};

use super::DriveOptions;
use super::course::{Place, Road};
use super::finish::{Finish, Kind};
use crate::raycast::{Body, Scene, Shape, Vector};
use crate::sine_cosine::sine_cosine;

/// Bodies of a town with their finishes.
#[derive(Debug, Clone, Default)]
pub(super) struct Town {
    pub scene: Scene,
    pub finishes: Vec<Finish>,
    /// The road, every two metres.
    lane: Vec<[f64; 2]>,
}

/// A box on the ground.
struct Block {
    place: Place,
    /// Length along the road, depth across it, height.
    size: [f64; 3],
    /// Free space to the middle of the road.
    clearance: f64,
}

impl Town {
    pub fn new(road: &Road, options: &DriveOptions, random: &mut Random) -> Result<Self> {
        let lane = (0..(road.length / 2.0) as usize + 30).map(|at| road.at(2.0 * at as f64).position);
        let mut town = Self { lane: lane.collect(), ..Self::default() };
        let mut finish = |kind, random: &mut Random| Finish {
            kind,
            colour: colour(random),
            contrast: options.texture,
            seed: random.bits() as u32,
        };
        let ground = Finish { colour: [0.36, 0.36, 0.35], ..finish(Kind::Road, random) };
        town.add(Body::upright(Shape::HalfSpace, [0.0; 3], 0)?, ground);
        for side in [1.0, -1.0] {
            let mut distance = -15.0;
            while distance < road.length + 60.0 {
                let width = f64::from(random.uniform(7.0, 18.0));
                let depth = f64::from(random.uniform(6.0, 12.0));
                let gap = f64::from(random.uniform(0.0, 4.0));
                let aside = side * (f64::from(random.uniform(6.5, 10.0)) + depth / 2.0);
                let kind = Kind::Facade([random.uniform(1.6, 3.0), random.uniform(2.4, 3.4)]);
                let height = f64::from(random.uniform(5.0, 18.0));
                let place = beside(road.at(distance + width / 2.0), aside);
                let block = Block { place, size: [width, depth, height], clearance: 5.5 };
                town.add_block(&block, finish(kind, random))?;
                distance += width + gap;
            }
            let mut distance = f64::from(random.uniform(2.0, 12.0));
            while distance < road.length + 40.0 {
                let aside = side * f64::from(random.uniform(4.2, 5.4));
                let place = beside(road.at(distance), aside);
                match random.below(4) {
                    0 => town.add_tree(place, random, &mut finish)?,
                    _ => {
                        let size =
                            [random.uniform(1.2, 4.6), random.uniform(0.8, 1.9), random.uniform(0.8, 2.4)];
                        let size = size.map(f64::from);
                        let block = Block { place, size, clearance: 2.6 };
                        town.add_block(&block, finish(Kind::Paint, random))?;
                    }
                }
                distance += f64::from(random.uniform(5.0, 16.0));
            }
        }
        // What closes the view at the end of the road.
        let end = road.at(road.length + 55.0);
        let kind = Kind::Facade([2.4, 3.0]);
        let block = Block { place: end, size: [10.0, 40.0, 16.0], clearance: 0.0 };
        if options.course != super::Course::Loop {
            town.add_block(&block, finish(kind, random))?;
        }
        Ok(town)
    }

    fn add(&mut self, body: Body, finish: Finish) {
        self.scene.add(body);
        self.finishes.push(finish);
    }

    /// Adds a box, unless it would stand on the road.
    fn add_block(&mut self, block: &Block, finish: Finish) -> Result<()> {
        let Block { place: Place { position: [x, y], yaw }, size, clearance, .. } = block;
        let around = [size[0] + 2.0 * clearance, size[1] + 2.0 * clearance];
        let floor = RotatedRectangle { center: [*x, *y], size: around, angle: *yaw };
        if *clearance > 0.0 && self.is_on_road(&floor) {
            return Ok(());
        }
        let half = size.map(|side| (side / 2.0) as f32);
        let (sine, cosine) = sine_cosine(yaw / 2.0);
        let rotation = [cosine as f32, 0.0, 0.0, sine as f32];
        let body = Body::new(Shape::Box { half }, [*x as f32, *y as f32, half[2]], rotation, 0)?;
        self.add(body, finish);
        Ok(())
    }

    /// Adds a trunk with a crown.
    fn add_tree(
        &mut self,
        place: Place,
        random: &mut Random,
        finish: &mut impl FnMut(Kind, &mut Random) -> Finish,
    ) -> Result<()> {
        let [x, y] = place.position.map(|part| part as f32);
        let floor = RotatedRectangle { center: place.position, size: [5.0; 2], angle: place.yaw };
        if self.is_on_road(&floor) {
            return Ok(());
        }
        let height = random.uniform(3.0, 4.5);
        let trunk = Shape::Cylinder { radius: random.uniform(0.1, 0.25), half_height: height / 2.0 };
        let bark = Finish { colour: [0.35, 0.27, 0.2], ..finish(Kind::Paint, random) };
        self.add(Body::upright(trunk, [x, y, height / 2.0], 0)?, bark);
        let crown = Shape::Sphere { radius: random.uniform(0.8, 1.6) };
        let leaves = Finish { colour: [0.25, 0.42, 0.2], ..finish(Kind::Paint, random) };
        self.add(Body::upright(crown, [x, y, height + 0.4], 0)?, leaves);
        Ok(())
    }

    fn is_on_road(&self, floor: &RotatedRectangle) -> bool {
        let (sine, cosine) = sine_cosine(floor.angle);
        self.lane.iter().any(|point| {
            let [x, y] = [point[0] - floor.center[0], point[1] - floor.center[1]];
            let [along, across] = [cosine * x + sine * y, cosine * y - sine * x];
            along.abs() < floor.size[0] / 2.0 && across.abs() < floor.size[1] / 2.0
        })
    }
}

/// Returns the place at a distance to the left of the road.
fn beside(Place { position: [x, y], yaw }: Place, left: f64) -> Place {
    let (sine, cosine) = sine_cosine(yaw);
    Place { position: [x - left * sine, y + left * cosine], yaw }
}

fn colour(random: &mut Random) -> Vector {
    let level = random.uniform(0.3, 0.75);
    [(); 3].map(|()| level * random.uniform(0.75, 1.15))
}
