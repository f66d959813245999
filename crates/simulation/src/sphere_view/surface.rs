//! Surfaces that every direction from their centre meets once: a mesh for rays, and maps of colour and normal for shading.

use std::sync::Arc;

use opendr_engine::Result;
use opendr_engine::data::Image;

use super::octahedron;
use crate::raycast::{Mesh, Vector, along, cross, dot, minus, unit};

/// What a surface is in a direction of length 1 from its centre.
pub(super) trait Form {
    /// Distance from the centre.
    fn radius(&self, direction: Vector) -> f32;

    /// Shares of red, green and blue light that are reflected.
    fn colour(&self, direction: Vector) -> [f32; 3];
}

/// A surface around its centre.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Surface {
    pub mesh: Arc<Mesh>,
    /// Vertices of the mesh, in rows of the square of directions.
    grid: Arc<[Vector]>,
    side: usize,
    texels: Vec<Texel>,
}

/// Colour and normal of a direction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Texel {
    pub colour: [f32; 3],
    pub normal: Vector,
}

impl Surface {
    /// Creates the surface of a form, with `2 cells^2` triangles and `side^2` texels.
    pub fn new(cells: usize, side: usize, form: &impl Form) -> Result<Self> {
        let row = cells + 1;
        let vertex = |at: usize| {
            let direction = octahedron::direction([at % row, at / row].map(|at| place(at, cells)));
            along([0.0; 3], direction, form.radius(direction))
        };
        let grid: Arc<[Vector]> = (0..row * row).map(vertex).collect();
        let middle = |at: usize| (2 * at + 1) as f32 / side as f32 - 1.0;
        let texel = |at: usize| {
            let direction = octahedron::direction([middle(at % side), middle(at / side)]);
            Texel { colour: form.colour(direction), normal: normal(direction, form) }
        };
        Ok(Self {
            mesh: Arc::new(Mesh::new(&grid, &faces(cells))?),
            grid,
            side,
            texels: (0..side * side).map(texel).collect(),
        })
    }

    /// Returns the colour and normal where a ray from the centre to `point` meets the surface.
    pub fn texel(&self, point: Vector) -> Texel {
        let place = octahedron::point(point).map(|part| {
            let at = (0.5 * (part + 1.0) * self.side as f32) as usize;
            at.min(self.side - 1)
        });
        self.texels[place[1] * self.side + place[0]]
    }

    /// Returns the surface for another renderer.
    pub fn textured_mesh(&self) -> Result<TexturedMesh> {
        let row = self.grid.len().isqrt();
        let share = |at: usize| 0.5 * (1.0 + place(at, row - 1));
        let coordinate = |at: usize| [share(at % row), 1.0 - share(at / row)];
        let levels = self.texels.iter().flat_map(|texel| texel.colour);
        let levels = levels.map(|level| (255.0 * level).round() as u8).collect();
        Ok(TexturedMesh {
            vertices: self.grid.to_vec(),
            texture_coordinates: (0..self.grid.len()).map(coordinate).collect(),
            faces: faces(row - 1),
            texture: Image::from_rgb8(levels, self.side, self.side)?,
        })
    }
}

/// A triangle mesh with a texture.
#[derive(Debug, Clone, PartialEq)]
pub struct TexturedMesh {
    /// Vertices.
    pub vertices: Vec<Vector>,
    /// Place of each vertex in the texture: to the right from 0 to 1, and upwards from 0 to 1.
    pub texture_coordinates: Vec<[f32; 2]>,
    /// Vertices of each triangle, counter-clockwise seen from outside.
    pub faces: Vec<[u32; 3]>,
    /// Shares of reflected light, as levels of 255.
    pub texture: Image,
}

/// The coordinate, in -1..=1, of line `at` of `count`.
fn place(at: usize, count: usize) -> f32 {
    2.0 * at as f32 / count as f32 - 1.0
}

/// Returns the triangles of a grid of `cells` times `cells`.
fn faces(cells: usize) -> Vec<[u32; 3]> {
    let corner = |column: usize, line: usize| (line * (cells + 1) + column) as u32;
    let cell = |cell: usize| {
        let (x, y) = (cell % cells, cell / cells);
        let [a, b, c, d] = [corner(x, y), corner(x + 1, y), corner(x, y + 1), corner(x + 1, y + 1)];
        // The diagonal runs along the fold of the square, so that no triangle lies across an edge of the octahedron.
        match (2 * x < cells) == (2 * y < cells) {
            true => [[a, b, c], [b, d, c]],
            false => [[a, b, d], [a, d, c]],
        }
    };
    (0..cells * cells).flat_map(cell).collect()
}

/// The outward normal, from differences over a hundredth of the radius.
fn normal(direction: Vector, form: &impl Form) -> Vector {
    const STEP: f32 = 0.01;
    let aside = if direction[2].abs() < 0.9 { [0.0, 0.0, 1.0] } else { [1.0, 0.0, 0.0] };
    let first = unit(cross(aside, direction));
    let second = cross(direction, first);
    let at = |tangent: Vector, step: f32| {
        let near = unit(along(direction, tangent, step));
        along([0.0; 3], near, form.radius(near))
    };
    let slope = |tangent: Vector| minus(at(tangent, STEP), at(tangent, -STEP));
    let outward = unit(cross(slope(first), slope(second)));
    if dot(outward, direction) < 0.0 { outward.map(|part| -part) } else { outward }
}

/// The radius of an ellipsoid in a direction.
pub(super) fn ellipsoid(half: Vector, direction: Vector) -> f32 {
    let square: f32 = (0..3).map(|axis| (direction[axis] / half[axis]).powi(2)).sum();
    1.0 / square.sqrt()
}

/// 1 at `centre`, falling smoothly to 0 at a distance of `width`; of points with any number of coordinates.
pub(super) fn bump<const N: usize>(at: [f32; N], centre: [f32; N], width: [f32; N]) -> f32 {
    let square: f32 = (0..N).map(|axis| ((at[axis] - centre[axis]) / width[axis]).powi(2)).sum();
    let left = (1.0 - square).max(0.0);
    left * left
}

/// 0 below `low`, 1 above `high`, smooth between.
pub(super) fn step(value: f32, low: f32, high: f32) -> f32 {
    let part = ((value - low) / (high - low)).clamp(0.0, 1.0);
    part * part * (3.0 - 2.0 * part)
}

/// A colour between two.
pub(super) fn mix(from: [f32; 3], to: [f32; 3], share: f32) -> [f32; 3] {
    let share = share.clamp(0.0, 1.0);
    std::array::from_fn(|part| from[part] + share * (to[part] - from[part]))
}

/// An ellipsoid of one colour.
#[derive(Debug, Clone, Copy)]
pub(super) struct Plain {
    pub half: Vector,
    pub colour: [f32; 3],
}

impl Form for Plain {
    fn radius(&self, direction: Vector) -> f32 {
        ellipsoid(self.half, direction)
    }

    fn colour(&self, _: Vector) -> [f32; 3] {
        self.colour
    }
}
