//! Colours and patterns of surfaces.

use opendr_engine::Random;

use crate::raycast::Vector;

/// A pattern of two colours, 0 to 1, in metres of the body's frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Surface {
    colours: [Vector; 2],
    pattern: Pattern,
    /// Size of the pattern, metres.
    size: f32,
    /// Share of the fine irregularity of the brightness.
    grain: f32,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Pattern {
    Plain,
    Squares,
    /// Across an axis.
    Stripes(usize),
    /// Smooth noise.
    Clouds,
    /// Rows of offset bricks, in the plane of the two other axes.
    Bricks,
}

impl Surface {
    /// Creates a surface of one colour.
    pub fn plain(colour: Vector) -> Self {
        Self { colours: [colour; 2], pattern: Pattern::Plain, size: 1.0, grain: 0.08 }
    }

    /// Draws a fabric: most are plain.
    pub fn fabric(random: &mut Random) -> Self {
        let colours = [colour(random), colour(random)];
        let pattern = match random.below(8) {
            0 => Pattern::Squares,
            1 => Pattern::Stripes(2),
            2 => Pattern::Stripes(1),
            3 => Pattern::Clouds,
            _ => Pattern::Plain,
        };
        Self { colours, pattern, size: random.uniform(0.02, 0.12), grain: random.uniform(0.03, 0.25) }
    }

    /// Draws a floor, wall or piece of furniture.
    pub fn material(random: &mut Random) -> Self {
        let first = colour(random);
        let contrast = random.uniform(0.6, 1.3);
        let second =
            if random.chance(0.5) { first.map(|part| (contrast * part).min(1.0)) } else { colour(random) };
        let pattern = match random.below(7) {
            0 => Pattern::Squares,
            1 => Pattern::Stripes(random.below(3)),
            2 | 3 => Pattern::Clouds,
            4 => Pattern::Bricks,
            _ => Pattern::Plain,
        };
        Self {
            colours: [first, second],
            pattern,
            size: random.uniform(0.08, 0.9),
            grain: random.uniform(0.05, 0.4),
        }
    }

    /// Returns the colour at a point of the body's frame.
    pub fn colour(&self, point: Vector) -> Vector {
        let [x, y, z] = point.map(|part| part / self.size);
        let share = match self.pattern {
            Pattern::Plain => 0.0,
            Pattern::Squares => odd(x.floor() + y.floor() + z.floor()),
            Pattern::Stripes(axis) => odd([x, y, z][axis].floor()),
            Pattern::Clouds => noise([x, y, z]),
            Pattern::Bricks => {
                let row = (2.0 * z).floor();
                let aside = (x + y + 0.5 * odd(row)).rem_euclid(1.0);
                let joint = (2.0 * z).rem_euclid(1.0) < 0.1 || aside < 0.05;
                if joint { 1.0 } else { 0.0 }
            }
        };
        let fine = noise(point.map(|part| 60.0 * part)) - 0.5;
        let light = 1.0 + self.grain * fine;
        std::array::from_fn(|part| {
            let [first, second] = self.colours.map(|colour| colour[part]);
            light * (first + share * (second - first))
        })
    }
}

/// Draws a colour, mostly of low saturation, as most of what people wear and live in.
pub(super) fn colour(random: &mut Random) -> Vector {
    let level = random.uniform(0.08, 1.0);
    let saturation = random.uniform(0.0, 1.0);
    let saturation = saturation * saturation;
    std::array::from_fn(|_| level * (1.0 - saturation * random.uniform(0.0, 0.95)))
}

fn odd(cell: f32) -> f32 {
    cell.rem_euclid(2.0)
}

/// Value noise, 0 to 1, with trilinear interpolation between whole numbers.
pub(super) fn noise(point: Vector) -> f32 {
    let low = point.map(f32::floor);
    let [x, y, z] = std::array::from_fn(|axis| {
        let share = point[axis] - low[axis];
        share * share * (3.0 - 2.0 * share)
    });
    let corner =
        |dx: i32, dy: i32, dz: i32| hash([low[0] as i32 + dx, low[1] as i32 + dy, low[2] as i32 + dz]);
    let line = |dy: i32, dz: i32| {
        let first = corner(0, dy, dz);
        first + x * (corner(1, dy, dz) - first)
    };
    let plane = |dz: i32| {
        let first = line(0, dz);
        first + y * (line(1, dz) - first)
    };
    let first = plane(0);
    first + z * (plane(1) - first)
}

/// A number 0 to 1 for a cell.
fn hash(cell: [i32; 3]) -> f32 {
    let mut bits = cell
        .iter()
        .fold(0x9e37_79b9_u32, |bits, part| (bits ^ *part as u32).wrapping_mul(0x85eb_ca6b).rotate_left(13));
    bits ^= bits >> 16;
    (bits.wrapping_mul(0xc2b2_ae35) >> 8) as f32 / (1 << 24) as f32
}
