//! Meshes of cars: a side view with few corners, narrower towards the roof, on four wheels.

use opendr_engine::{Random, Result};

use crate::raycast::{Mesh, Vector};

/// Side view of a car, from the rear bumper over the roof to the front; x is a fraction of the length (0 rear), y of the height.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CarShape {
    /// With a trunk.
    Sedan,
    /// Cut off at the rear.
    Hatchback,
    /// Estate with a long roof.
    Estate,
    /// High, with a steep windscreen.
    Suv,
}

impl CarShape {
    /// All shapes.
    pub const ALL: [Self; 4] = [Self::Sedan, Self::Hatchback, Self::Estate, Self::Suv];

    /// Returns the corners from the rear bumper over the roof to the front bumper.
    fn profile(self) -> [[f32; 2]; 8] {
        match self {
            Self::Sedan => [
                [0.0, 0.2],
                [0.01, 0.62],
                [0.14, 0.66],
                [0.28, 0.98],
                [0.52, 1.0],
                [0.7, 0.66],
                [0.97, 0.52],
                [1.0, 0.2],
            ],
            Self::Hatchback => [
                [0.0, 0.2],
                [0.01, 0.58],
                [0.04, 0.68],
                [0.16, 0.96],
                [0.5, 1.0],
                [0.72, 0.64],
                [0.96, 0.5],
                [1.0, 0.2],
            ],
            Self::Estate => [
                [0.0, 0.2],
                [0.01, 0.62],
                [0.03, 0.7],
                [0.1, 0.97],
                [0.55, 1.0],
                [0.72, 0.65],
                [0.97, 0.52],
                [1.0, 0.2],
            ],
            Self::Suv => [
                [0.0, 0.24],
                [0.01, 0.62],
                [0.02, 0.7],
                [0.07, 0.97],
                [0.6, 1.0],
                [0.74, 0.68],
                [0.97, 0.6],
                [1.0, 0.24],
            ],
        }
    }

    /// Returns a mesh of this shape within `[length, width, height]`, with its origin at the middle of the floor and the front along x;
    /// corners vary a little at random.
    ///
    /// # Errors
    /// `InvalidInput` when a size is not finite.
    pub fn mesh(self, [length, width, height]: Vector, random: &mut Random) -> Result<Mesh> {
        let profile = self.profile().map(|[along, up]| {
            let vary = |random: &mut Random| random.uniform(-0.02, 0.02);
            let fixed = !(0.3..=0.99).contains(&up);
            let (along_by, up_by) = (vary(random), vary(random));
            let along = if fixed { along } else { (along + along_by).clamp(0.0, 1.0) };
            [(along - 0.5) * length, if fixed { up } else { (up + up_by).min(1.0) } * height]
        });
        let lean = random.uniform(0.1, 0.2);
        let half = |up: f32| width / 2.0 * (1.0 - lean * ((up / height - 0.6) / 0.4).max(0.0));
        let mut vertices = Vec::with_capacity(16 + 32);
        for [x, z] in profile {
            vertices.push([x, -half(z), z]);
            vertices.push([x, half(z), z]);
        }
        let count = profile.len() as u32;
        let mut faces = Vec::new();
        for at in 0..count {
            let (a, b) = (2 * at, 2 * ((at + 1) % count));
            faces.extend([[a, a + 1, b], [b, a + 1, b + 1]]);
        }
        for side in 0..2 {
            // A triangle fan around the middle of the side.
            vertices.push([0.0, width / 2.0 * if side == 0 { -1.0 } else { 1.0 }, 0.4 * height]);
            let middle = vertices.len() as u32 - 1;
            faces.extend((0..count).map(|at| [middle, 2 * at + side, 2 * ((at + 1) % count) + side]));
        }
        for (along, side) in [(-0.32, -1.0), (-0.32, 1.0), (0.31, -1.0), (0.31, 1.0)] {
            wheel(&mut vertices, &mut faces, along * length, side * (width / 2.0 - 0.02), 0.42 * height);
        }
        Mesh::new(&vertices, &faces)
    }
}

/// Adds the outer side of a wheel: a square on its corner, enough for a lidar.
fn wheel(vertices: &mut Vec<Vector>, faces: &mut Vec<[u32; 3]>, x: f32, y: f32, size: f32) {
    let first = vertices.len() as u32;
    let half = size / 2.0;
    vertices.extend([[x - half, y, half], [x, y, 0.0], [x + half, y, half], [x, y, size]]);
    faces.extend([[first, first + 1, first + 2], [first, first + 2, first + 3]]);
}
