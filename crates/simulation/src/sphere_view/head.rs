//! Heads: each number is a person. Persons are distinguished by the front of the head alone.

use opendr_engine::{Random, Result};

use super::surface::{Form, bump, ellipsoid, mix, step};
use super::{Asset, Subject};
use crate::raycast::Vector;

/// Appearance of a face. Lengths are shares of the head's radius, seen from the front: y to the left, z up.
struct Face {
    skin: [f32; 3],
    eyes: Eyes,
    nose: [f32; 2],
    mouth: [f32; 3],
    lips: [f32; 3],
    hairline: f32,
    beard: f32,
    moustache: f32,
    glasses: bool,
    marks: [Mark; 4],
}

struct Eyes {
    aside: f32,
    height: f32,
    size: [f32; 2],
    iris: [f32; 3],
    brow: [f32; 3],
}

/// A patch of another colour: a birthmark, make-up, a shadow of the bone.
struct Mark {
    at: [f32; 2],
    size: [f32; 2],
    colour: [f32; 3],
}

/// Radii of every head: its outline must not identify a person.
const HALF: Vector = [0.82, 0.73, 0.92];
const HAIR: [f32; 3] = [0.16, 0.11, 0.08];
const WHITE: [f32; 3] = [0.93, 0.93, 0.9];

/// The head of a person.
pub(super) fn generate(person: u32) -> Result<Asset> {
    let face = Face::new(&mut Subject::Face.random(0, u64::from(person)));
    let mut asset = Asset::empty();
    asset.add([20, 80], ([0.0; 3], [1.0, 0.0, 0.0, 0.0]), &face)?;
    Ok(asset)
}

impl Face {
    fn new(random: &mut Random) -> Self {
        let mut range = |low: f32, high: f32| random.uniform(low, high);
        let tone = range(0.6, 1.15);
        let skin = [0.8 * tone, range(0.52, 0.7) * tone, range(0.35, 0.6) * tone];
        let eyes = Eyes {
            aside: range(0.24, 0.38),
            height: range(0.1, 0.26),
            size: [range(0.11, 0.18), range(0.06, 0.13)],
            iris: [range(0.05, 0.5), range(0.1, 0.6), range(0.05, 0.8)],
            brow: [range(0.12, 0.26), range(0.03, 0.11), range(-0.6, 0.6)],
        };
        let nose = [range(0.07, 0.16), range(-0.2, -0.05)];
        let mouth = [range(-0.52, -0.32), range(0.14, 0.38), range(0.04, 0.12)];
        let lips = [range(0.4, 0.95), range(0.05, 0.5), range(0.1, 0.6)];
        let hairline = range(0.5, 0.72);
        let marks = std::array::from_fn(|_| Mark {
            at: [range(-0.55, 0.55), range(-0.6, 0.5)],
            size: [range(0.12, 0.34), range(0.12, 0.34)],
            colour: [range(0.1, 1.0), range(0.05, 0.95), range(0.05, 0.95)],
        });
        let beard = if random.chance(0.35) { random.uniform(0.4, 0.9) } else { 0.0 };
        let moustache = if random.chance(0.3) { random.uniform(0.5, 1.0) } else { 0.0 };
        let glasses = random.chance(0.25);
        Self { skin, eyes, nose, mouth, lips, hairline, beard, moustache, glasses, marks }
    }

    /// The colour on the front at a place.
    fn face_colour(&self, y: f32, z: f32) -> [f32; 3] {
        let mut colour = self.skin;
        for mark in &self.marks {
            colour = mix(colour, mark.colour, 0.8 * bump([y, z], mark.at, mark.size));
        }
        let beard = self.beard * step(-z, -self.mouth[0] - 0.12, -self.mouth[0] + 0.1);
        colour = mix(colour, HAIR, beard);
        let below_nose = [0.0, 0.5 * (self.mouth[0] + self.nose[1]) - 0.08];
        colour = mix(colour, HAIR, self.moustache * step(bump([y, z], below_nose, [0.26, 0.09]), 0.1, 0.3));
        let mouth = bump([y, z], [0.0, self.mouth[0]], [self.mouth[1], self.mouth[2]]);
        colour = mix(colour, self.lips, step(mouth, 0.05, 0.3));
        let nose = bump([y, z], [0.0, self.nose[1] - 0.1], [self.nose[0], 0.06]);
        colour = mix(colour, self.skin.map(|part| 0.55 * part), step(nose, 0.1, 0.5));
        let eyes = &self.eyes;
        let at = [y.abs(), z];
        let white = step(bump(at, [eyes.aside, eyes.height], eyes.size), 0.02, 0.2);
        colour = mix(colour, WHITE, white);
        let iris = bump(at, [eyes.aside, eyes.height], [eyes.size[1]; 2]);
        colour = mix(colour, eyes.iris, white * step(iris, 0.1, 0.3));
        let [width, thickness, tilt] = eyes.brow;
        let raised = eyes.height + eyes.size[1] + 0.07 + tilt * (y.abs() - eyes.aside);
        let brow = bump(at, [eyes.aside, raised], [width, thickness + 0.02]);
        colour = mix(colour, HAIR, step(brow, 0.05, 0.3));
        if self.glasses {
            let around = bump(at, [eyes.aside, eyes.height], [0.24, 0.18]);
            let rim = step(around, 0.02, 0.08) * (1.0 - step(around, 0.25, 0.35));
            let bridge = step(bump(at, [0.0, eyes.height + 0.02], [0.12, 0.035]), 0.1, 0.3);
            colour = mix(colour, [0.05; 3], rim.max(bridge));
        }
        colour
    }
}

impl Form for Face {
    fn radius(&self, direction: Vector) -> f32 {
        let [x, y, z] = direction;
        let nose = front(x) * bump([y, z], [0.0, self.nose[1]], [self.nose[0] + 0.04, 0.3]);
        ellipsoid(HALF, direction) + 0.16 * nose + 0.12 * ears(direction)
    }

    fn colour(&self, direction: Vector) -> [f32; 3] {
        let [x, y, z] = direction;
        // Hair covers all but the front: skin at the back would identify a person.
        let hair = step(z - 0.9 * x, self.hairline - 0.55, self.hairline - 0.45).max(step(z, 0.8, 0.85));
        let face = mix(self.face_colour(y, z), HAIR, hair);
        mix(HAIR, face, front(x))
    }
}

/// How much a place belongs to the front.
fn front(x: f32) -> f32 {
    step(x, 0.1, 0.45)
}

fn ears([x, y, z]: Vector) -> f32 {
    bump([x, y.abs(), z], [0.05, 0.98, 0.08], [0.22, 0.25, 0.3])
}
