//! Rigid bodies of planar worlds as solids, for other simulators.

use crate::planar::Body;

/// A body on a table: prisms that stand on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Solid {
    /// Place of the centre of mass, m, and angle, rad.
    pub pose: [f64; 3],
    /// How far sliding prisms are from their place, m.
    pub slide: f64,
    /// Mass, kg; none for a body that never moves.
    pub mass: Option<f64>,
    /// Moment of inertia about the vertical axis, kg m^2.
    pub inertia: f64,
    /// Parts of the body.
    pub prisms: Vec<Prism>,
}

/// A convex polygon, extruded upwards.
#[derive(Debug, Clone, PartialEq)]
pub struct Prism {
    /// Corners in the frame of the solid, counter-clockwise, m; a single one is the centre of a disc.
    pub corners: Vec<[f64; 2]>,
    /// Radius of the disc, m.
    pub radius: f64,
    /// Direction along the x-axis of the solid in which the slide moves the prism: 1, -1 or 0.
    pub slides: f64,
}

impl Solid {
    pub(crate) fn of(body: &Body) -> Self {
        let [x, y] = body.pose.place;
        let prisms = body.parts().iter().map(|part| Prism {
            corners: part.shape.corners().to_vec(),
            radius: part.shape.radius,
            slides: part.slides,
        });
        Self {
            pose: [x, y, body.pose.angle],
            slide: body.slide,
            mass: body.mass.is_finite().then_some(body.mass),
            inertia: body.inertia,
            prisms: prisms.collect(),
        }
    }
}
