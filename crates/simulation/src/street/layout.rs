//! Layout of a street: its objects and their places.

use std::f32::consts::{FRAC_PI_2, PI};
use std::sync::Arc;

use opendr_engine::overlap::RotatedRectangle;
use opendr_engine::target::LidarBox;
use opendr_engine::{Random, Result};

use super::CarShape;
use crate::raycast::{Body, Scene, Shape, Vector};

/// Kind of an object of a street.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StreetKind {
    /// A car, of the sizes of KITTI's cars.
    Car,
    /// A pedestrian.
    Pedestrian,
    /// A truck: a box on wheels.
    Truck,
    /// Walls, poles and tree trunks.
    Structure,
    /// Crowns, hedges and bushes, which rays enter.
    Vegetation,
    /// The ground.
    Ground,
}

/// An object with its ground truth.
#[derive(Debug, Clone, PartialEq)]
pub struct StreetObject {
    /// Kind of the object.
    pub kind: StreetKind,
    /// Box of the object, in the lidar's frame.
    pub bounding_box: LidarBox,
    /// Reflectance of its surface, 0 to 1.
    pub reflectance: f32,
}

/// A street, in the frame of the lidar.
#[derive(Debug, Clone, Default)]
pub struct Street {
    /// Bodies of the street; the label of a body is an index into [`Street::objects`].
    pub scene: Scene,
    /// All objects.
    pub objects: Vec<StreetObject>,
    pub(super) ground: Ground,
    floors: Vec<RotatedRectangle>,
}

/// A slightly inclined plane.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Ground {
    height: f32,
    slopes: [f32; 2],
}

impl Ground {
    pub fn at(&self, x: f32, y: f32) -> f32 {
        self.height + self.slopes[0] * x + self.slopes[1] * y
    }
}

/// Height of KITTI's lidar above the ground, in metres.
const MOUNT: f32 = 1.73;
/// Extent of the street: ahead, and to either side, in metres.
const AHEAD: f32 = 62.0;
const ASIDE: f32 = 30.0;
/// Footprint of the car that carries the lidar.
pub(super) const OWN: RotatedRectangle =
    RotatedRectangle { center: [0.0, 0.0], size: [6.0, 2.6], angle: 0.0 };
/// Number of attempts to find a free place.
const TRIES: usize = 12;

impl Street {
    /// Creates a random street.
    ///
    /// # Errors
    /// None for the sizes used.
    pub fn new(random: &mut Random) -> Result<Self> {
        let slopes = [0.008 * random.normal() as f32, 0.008 * random.normal() as f32];
        let ground = Ground { height: -MOUNT + 0.03 * random.normal() as f32, slopes };
        let mut street = Self { ground, floors: vec![OWN], ..Self::default() };
        // Quaternion of a small rotation of the plane's normal: half of the slopes.
        let rotation = [1.0, slopes[1] / 2.0, -slopes[0] / 2.0, 0.0];
        street.push(StreetKind::Ground, LidarBox { center: [0.0; 3], size: [0.0; 3], yaw: 0.0 }, random);
        street.scene.add(Body::new(Shape::HalfSpace, [0.0, 0.0, ground.height], rotation, 0)?);

        let road = match random.below(8) {
            0 => random.uniform(-0.8, 0.8),
            1 => FRAC_PI_2 + random.uniform(-0.2, 0.2),
            _ => 0.1 * random.normal() as f32,
        };
        for _ in 0..4 + random.below(12) {
            street.add_car(road, random)?;
        }
        for _ in 0..random.below(2) {
            street.add_truck(road, random)?;
        }
        for _ in 0..random.below(6) {
            street.add_pedestrian(random)?;
        }
        for _ in 0..random.below(5) {
            street.add_wall(road, random)?;
        }
        for _ in 0..random.below(8) {
            street.add_pole(random)?;
        }
        for _ in 0..random.below(6) {
            street.add_tree(random)?;
        }
        for _ in 0..random.below(8) {
            street.add_bush(road, random)?;
        }
        Ok(street)
    }

    /// Adds an object and returns its label.
    fn push(&mut self, kind: StreetKind, place: LidarBox, random: &mut Random) -> u16 {
        let reflectance = match kind {
            StreetKind::Car | StreetKind::Truck => random.uniform(0.02, 0.9),
            StreetKind::Ground => random.uniform(0.1, 0.4),
            _ => random.uniform(0.05, 0.6),
        };
        self.objects.push(StreetObject { kind, bounding_box: place, reflectance });
        u16::try_from(self.objects.len() - 1).unwrap_or(u16::MAX)
    }

    /// Returns a free place of `size` (length, width, height) among those that `choose` (x, y, yaw) proposes, and occupies it.
    fn place(
        &mut self,
        size: Vector,
        margin: f32,
        random: &mut Random,
        mut choose: impl FnMut(&mut Random) -> [f32; 3],
    ) -> Option<LidarBox> {
        for _ in 0..TRIES {
            let [x, y, yaw] = choose(random);
            let around = [size[0] + margin, size[1] + margin].map(f64::from);
            let center = [x, y].map(f64::from);
            let floor = RotatedRectangle { center, size: around, angle: f64::from(yaw) };
            if self.floors.iter().all(|other| floor.intersection_area(other) == 0.0) {
                self.floors.push(floor);
                let z = f64::from(self.ground.at(x, y));
                let yaw = f64::from(yaw);
                return Some(LidarBox { center: [center[0], center[1], z], size: size.map(f64::from), yaw });
            }
        }
        None
    }

    fn add_car(&mut self, road: f32, random: &mut Random) -> Result<()> {
        let shape = CarShape::ALL[random.below(4)];
        let higher = if shape == CarShape::Suv { 0.12 } else { 0.0 };
        let size = [
            (3.88 + 0.42 * random.normal() as f32).clamp(3.0, 5.2),
            (1.63 + 0.1 * random.normal() as f32).clamp(1.4, 1.95),
            (1.52 + higher + 0.1 * random.normal() as f32).clamp(1.3, 1.95),
        ];
        let lane = [0.0, 0.0, 3.5, -3.2, -4.5, 6.5, 9.5, -8.0][random.below(8)];
        let parked_across = random.chance(0.12);
        let anywhere = random.chance(0.2);
        let place = self.place(size, 0.4, random, |random| {
            let turned = if random.chance(0.5) { 0.0 } else { PI };
            let yaw = road + turned + 0.04 * random.normal() as f32;
            let yaw = if parked_across { yaw + FRAC_PI_2 } else { yaw };
            if anywhere {
                let yaw = if random.chance(0.5) { yaw } else { random.uniform(-PI, PI) };
                return [random.uniform(3.0, 55.0), random.uniform(-24.0, 24.0), yaw];
            }
            let (sin, cos) = road.sin_cos();
            let along = random.uniform(3.0, 55.0);
            // Cross traffic is placed ahead.
            let (along, ahead) =
                if cos.abs() < 0.5 { (along - 28.0, random.uniform(8.0, 30.0)) } else { (along, 0.0) };
            let aside = lane + 0.3 * random.normal() as f32;
            [ahead + along * cos - aside * sin, along * sin + aside * cos, yaw]
        });
        let Some(place) = place.filter(is_within) else { return Ok(()) };
        let mesh = shape.mesh(size, random)?;
        let label = self.push(StreetKind::Car, place, random);
        self.add(Shape::Mesh(Arc::new(mesh)), place.center, place.yaw, label)
    }

    fn add_truck(&mut self, road: f32, random: &mut Random) -> Result<()> {
        let size = [random.uniform(5.5, 11.0), random.uniform(2.2, 2.6), random.uniform(2.5, 3.6)];
        let place = self.place(size, 0.4, random, |random| {
            [random.uniform(8.0, 55.0), random.uniform(-12.0, 12.0), road]
        });
        let Some(place) = place else { return Ok(()) };
        let label = self.push(StreetKind::Truck, place, random);
        let half = [size[0] / 2.0, size[1] / 2.0, (size[2] - 0.4) / 2.0];
        let [x, y, z] = place.center;
        self.add(Shape::Box { half }, [x, y, z + 0.4 + f64::from(half[2])], place.yaw, label)
    }

    fn add_pedestrian(&mut self, random: &mut Random) -> Result<()> {
        let height = (1.74 + 0.09 * random.normal() as f32).clamp(1.2, 2.0);
        let size = [0.8, 0.6, height];
        let place = self.place(size, 0.2, random, |random| {
            [random.uniform(4.0, 45.0), random.uniform(-15.0, 15.0), random.uniform(-PI, PI)]
        });
        let Some(place) = place else { return Ok(()) };
        let label = self.push(StreetKind::Pedestrian, place, random);
        let [x, y, z] = place.center;
        let body = height - 0.26;
        let trunk = Shape::Cylinder { radius: random.uniform(0.18, 0.28), half_height: body / 2.0 };
        self.add(trunk, [x, y, z + f64::from(body) / 2.0], 0.0, label)?;
        self.add(Shape::Sphere { radius: 0.13 }, [x, y, z + f64::from(height) - 0.13], 0.0, label)
    }

    fn add_wall(&mut self, road: f32, random: &mut Random) -> Result<()> {
        let high = if random.chance(0.5) { random.uniform(3.0, 9.0) } else { random.uniform(0.6, 2.2) };
        let size = [random.uniform(3.0, 25.0), random.uniform(0.15, 4.0), high];
        let across = if random.chance(0.3) { FRAC_PI_2 } else { 0.0 };
        let place = self.place(size, 0.2, random, |random| {
            let aside = random.uniform(6.0, 22.0) * if random.chance(0.5) { 1.0 } else { -1.0 };
            [random.uniform(2.0, AHEAD), aside, road + across]
        });
        self.add_box(place, StreetKind::Structure, random)
    }

    fn add_pole(&mut self, random: &mut Random) -> Result<()> {
        let (radius, height) = (random.uniform(0.04, 0.2), random.uniform(2.0, 7.0));
        let place = self.place([2.0 * radius, 2.0 * radius, height], 0.2, random, anywhere);
        let Some(place) = place else { return Ok(()) };
        let label = self.push(StreetKind::Structure, place, random);
        let [x, y, z] = place.center;
        let shape = Shape::Cylinder { radius, half_height: height / 2.0 };
        self.add(shape, [x, y, z + f64::from(height) / 2.0], 0.0, label)
    }

    fn add_tree(&mut self, random: &mut Random) -> Result<()> {
        let (radius, trunk, crown) =
            (random.uniform(0.1, 0.35), random.uniform(1.2, 3.0), random.uniform(0.8, 2.4));
        let place = self.place([2.0 * radius, 2.0 * radius, trunk + 2.0 * crown], 0.3, random, anywhere);
        let Some(place) = place else { return Ok(()) };
        let [x, y, z] = place.center;
        let label = self.push(StreetKind::Structure, place, random);
        let shape = Shape::Cylinder { radius, half_height: trunk };
        self.add(shape, [x, y, z + f64::from(trunk)], 0.0, label)?;
        let label = self.push(StreetKind::Vegetation, place, random);
        self.add(Shape::Sphere { radius: crown }, [x, y, z + f64::from(trunk + crown)], 0.0, label)
    }

    fn add_bush(&mut self, road: f32, random: &mut Random) -> Result<()> {
        if random.chance(0.5) {
            let size = [random.uniform(0.8, 10.0), random.uniform(0.5, 1.8), random.uniform(0.5, 2.0)];
            let place = self.place(size, 0.2, random, |random| {
                let [x, y, _] = anywhere(random);
                [x, y, road]
            });
            return self.add_box(place, StreetKind::Vegetation, random);
        }
        let radius = random.uniform(0.4, 1.4);
        let size = [2.0 * radius, 2.0 * radius, radius];
        let Some(place) = self.place(size, 0.2, random, anywhere) else { return Ok(()) };
        let label = self.push(StreetKind::Vegetation, place, random);
        self.add(Shape::Sphere { radius }, place.center, 0.0, label)
    }

    fn add_box(&mut self, place: Option<LidarBox>, kind: StreetKind, random: &mut Random) -> Result<()> {
        let Some(place) = place else { return Ok(()) };
        let label = self.push(kind, place, random);
        // Boxes reach into the ground, which is inclined.
        let [x, y, z] = place.center;
        let half = place.size.map(|side| side as f32 / 2.0);
        self.add(Shape::Box { half }, [x, y, z + place.size[2] / 2.0 - 0.2], place.yaw, label)
    }

    fn add(&mut self, shape: Shape, center: [f64; 3], yaw: f64, label: u16) -> Result<()> {
        let (sin, cos) = (yaw as f32 / 2.0).sin_cos();
        self.scene.add(Body::new(shape, center.map(|part| part as f32), [cos, 0.0, 0.0, sin], label)?);
        Ok(())
    }
}

fn anywhere(random: &mut Random) -> [f32; 3] {
    [random.uniform(3.0, AHEAD), random.uniform(-ASIDE, ASIDE), random.uniform(-PI, PI)]
}

/// Returns whether a car is in the lidar's field of view.
fn is_within(place: &LidarBox) -> bool {
    place.center[0] > 2.0 && place.center[0] < f64::from(AHEAD) && place.center[1].abs() < f64::from(ASIDE)
}
