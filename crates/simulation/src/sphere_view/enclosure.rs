//! The enclosure of a subject: four panels around the line of sight to its front.

use opendr_engine::Result;

use crate::raycast::{Body, Shape, Vector};

/// Number of panels.
pub(super) const PANELS: usize = 4;
/// Distance of the panels from the axis, radii.
const HALF: f32 = 1.05;
/// Half of the thickness of a panel, radii.
const THICKNESS: f32 = 0.04;
/// Length of the enclosure behind the subject's middle, radii.
const BEHIND: f32 = 0.9;

/// Returns the panels in the subject's frame; `length` is that in front of the subject's middle, in radii.
pub(super) fn panels(length: f32) -> Result<[Body; PANELS]> {
    let (middle, half) = (0.5 * (length - BEHIND), 0.5 * (length + BEHIND));
    let aside = |position: Vector, half: Vector| Body::upright(Shape::Box { half }, position, 0);
    let (wide, high) = ([half, THICKNESS, HALF], [half, HALF, THICKNESS]);
    Ok([
        aside([middle, HALF, 0.0], wide)?,
        aside([middle, -HALF, 0.0], wide)?,
        aside([middle, 0.0, HALF], high)?,
        aside([middle, 0.0, -HALF], high)?,
    ])
}
