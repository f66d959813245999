//! Parts of a subject, each a body with a surface.

use opendr_engine::Result;

use super::surface::{Form, Surface, Texel, TexturedMesh};
use crate::raycast::{Body, Shape, Vector};

/// A generated subject: the parts that a camera sees, all within a radius of 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Asset {
    parts: Vec<Part>,
}

/// A surface somewhere on the subject.
#[derive(Debug, Clone, PartialEq)]
struct Part {
    body: Body,
    surface: Surface,
}

impl Asset {
    pub(super) fn empty() -> Self {
        Self { parts: Vec::new() }
    }

    /// Adds a part: a surface around `position`, turned by a quaternion `[w, x, y, z]`.
    pub(super) fn add(
        &mut self,
        [cells, side]: [usize; 2],
        (position, rotation): (Vector, [f32; 4]),
        form: &impl Form,
    ) -> Result<()> {
        let surface = Surface::new(cells, side, form)?;
        let shape = Shape::Mesh(surface.mesh.clone());
        self.parts.push(Part { body: Body::new(shape, position, rotation, 0)?, surface });
        Ok(())
    }

    /// Returns the bodies of the parts.
    pub fn bodies(&self) -> impl Iterator<Item = &Body> {
        self.parts.iter().map(|part| &part.body)
    }

    /// Returns the parts for another renderer: the body, and the texture of its mesh.
    ///
    /// # Errors
    /// None of a generated asset.
    pub fn textured_parts(&self) -> Result<Vec<(&Body, TexturedMesh)>> {
        self.parts.iter().map(|part| Ok((&part.body, part.surface.textured_mesh()?))).collect()
    }

    /// Triangles of all parts.
    pub fn triangles(&self) -> usize {
        self.parts.iter().map(|part| part.surface.mesh.triangles()).sum()
    }

    /// Colour and normal, in the part's frame, at a point of part `number`; `None` for a number without a part.
    pub(super) fn texel(&self, number: usize, point: Vector) -> Option<(Texel, &Body)> {
        let part = self.parts.get(number)?;
        Some((part.surface.texel(part.body.point_in_body(point)), &part.body))
    }
}
