//! Surroundings of persons: a room, or a street, with things that are no persons.

use opendr_engine::{Random, Result};

use super::surface::{Surface, colour};
use crate::raycast::{Body, Shape, Vector};

/// Surroundings around the origin; the floor has the height 0.
#[derive(Debug, Clone)]
pub(super) struct Place {
    pub bodies: Vec<(Body, Surface)>,
    /// Direction to the light.
    pub light: Vector,
    /// Share of light from everywhere.
    pub ambient: f32,
    /// Colours of the sky at the horizon and at the zenith.
    pub sky: [Vector; 2],
    /// Half of the side in which persons stand, metres.
    pub half: f32,
}

/// Label of bodies that are no persons.
pub(super) const THING: u16 = 0;

impl Place {
    /// Draws a room or, more often, a street.
    pub fn draw(random: &mut Random) -> Result<Self> {
        let mut place = if random.chance(0.45) { Self::room(random)? } else { Self::street(random)? };
        for _ in 0..random.below(9) {
            place.add_thing(random)?;
        }
        Ok(place)
    }

    fn new(half: f32, random: &mut Random) -> Result<Self> {
        let floor = Body::upright(Shape::HalfSpace, [0.0; 3], THING)?;
        let aside = random.uniform(-1.2, 1.2);
        Ok(Self {
            bodies: vec![(floor, Surface::material(random))],
            light: [aside, random.uniform(-1.2, 1.2), random.uniform(0.5, 1.6)],
            ambient: random.uniform(0.35, 0.8),
            sky: [[0.8, 0.86, 0.93], [0.4, 0.6, 0.85]].map(|sky| {
                let tint = random.uniform(0.55, 1.05);
                sky.map(|part: f32| (tint * part).min(1.0))
            }),
            half,
        })
    }

    fn room(random: &mut Random) -> Result<Self> {
        let half = random.uniform(2.5, 5.0);
        let mut room = Self::new(half, random)?;
        let (high, thick) = (random.uniform(1.3, 2.2), 0.1);
        let wall = Surface::material(random);
        for (axis, side) in [(0, 1.0), (0, -1.0), (1, 1.0), (1, -1.0)] {
            let (mut position, mut size) = ([0.0, 0.0, high], [half + 1.5, half + 1.5, high]);
            (position[axis], size[axis]) = (side * (half + 1.4), thick);
            room.add(Shape::Box { half: size }, position, wall)?;
            for _ in 0..random.below(4) {
                let mut at = position;
                at[1 - axis] = random.uniform(-half, half);
                at[2] = random.uniform(0.9, 2.0 * high - 0.6);
                at[axis] -= side * thick;
                let mut picture =
                    [random.uniform(0.2, 0.8), random.uniform(0.2, 0.8), random.uniform(0.2, 0.5)];
                picture[axis] = 0.03;
                room.add(Shape::Box { half: picture }, at, Surface::material(random))?;
            }
        }
        Ok(room)
    }

    fn street(random: &mut Random) -> Result<Self> {
        let half = random.uniform(4.0, 9.0);
        let mut street = Self::new(half, random)?;
        for _ in 0..3 + random.below(9) {
            let angle = random.uniform(0.0, std::f32::consts::TAU);
            let far = half + random.uniform(4.0, 20.0);
            let size = [random.uniform(1.0, 5.0), random.uniform(1.0, 5.0), random.uniform(1.5, 7.0)];
            let position = [far * angle.cos(), far * angle.sin(), size[2]];
            street.add(Shape::Box { half: size }, position, Surface::material(random))?;
        }
        for _ in 0..random.below(8) {
            street.add_tree(random)?;
        }
        Ok(street)
    }

    fn add(&mut self, shape: Shape, position: Vector, surface: Surface) -> Result<()> {
        self.bodies.push((Body::upright(shape, position, THING)?, surface));
        Ok(())
    }

    fn add_tree(&mut self, random: &mut Random) -> Result<()> {
        let [x, y] = self.edge(random);
        let half_height = random.uniform(0.8, 1.8);
        let trunk = Shape::Cylinder { radius: random.uniform(0.06, 0.25), half_height };
        self.add(trunk, [x, y, half_height], Surface::plain([0.3, 0.22, 0.15]))?;
        let leaves =
            Surface::plain([random.uniform(0.1, 0.4), random.uniform(0.25, 0.55), random.uniform(0.05, 0.2)]);
        for _ in 0..2 + random.below(4) {
            let radius = random.uniform(0.5, 1.3);
            let [dx, dy] = [random.uniform(-0.7, 0.7), random.uniform(-0.7, 0.7)];
            let height = 2.0 * half_height + random.uniform(-0.2, 0.9);
            self.add(Shape::Sphere { radius }, [x + dx, y + dy, height], leaves)?;
        }
        Ok(())
    }

    /// A box, pole, ball or column where persons stand: as high as persons, too, so that height alone does not tell them apart.
    fn add_thing(&mut self, random: &mut Random) -> Result<()> {
        let [x, y] = [(); 2].map(|()| random.uniform(-self.half, self.half));
        let surface =
            if random.chance(0.5) { Surface::material(random) } else { Surface::plain(colour(random)) };
        let half = [random.uniform(0.1, 0.6), random.uniform(0.1, 0.6), random.uniform(0.1, 0.9)];
        match random.below(4) {
            0 | 1 => self.add(Shape::Box { half }, [x, y, half[2]], surface),
            2 => {
                let shape = Shape::Cylinder { radius: 0.4 * half[0], half_height: half[2] };
                self.add(shape, [x, y, half[2]], surface)
            }
            _ => self.add(Shape::Sphere { radius: 0.5 * half[0] }, [x, y, 0.5 * half[0] + half[1]], surface),
        }
    }

    fn edge(&self, random: &mut Random) -> [f32; 2] {
        let angle = random.uniform(0.0, std::f32::consts::TAU);
        let far = self.half + random.uniform(0.5, 8.0);
        [far * angle.cos(), far * angle.sin()]
    }
}
