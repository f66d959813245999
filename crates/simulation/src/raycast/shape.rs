//! Shapes in their own frame: intersections with rays, and distances.

use std::sync::Arc;

use super::{Directions, HeightField, LANES, Mesh, Vector, length, unit};

/// A shape, centred in its own frame.
#[derive(Debug, Clone, PartialEq)]
pub enum Shape {
    /// A ball.
    Sphere {
        /// Radius in metres.
        radius: f32,
    },
    /// A box from minus to plus `half` along each axis.
    Box {
        /// Half of the edge lengths, in metres.
        half: Vector,
    },
    /// A cylinder around the z axis.
    Cylinder {
        /// Radius in metres.
        radius: f32,
        /// Half of the height, in metres.
        half_height: f32,
    },
    /// All points with z <= 0.
    HalfSpace,
    /// Terrain, solid below its surface.
    HeightField(Arc<HeightField>),
    /// A triangle mesh; it has no inside.
    Mesh(Arc<Mesh>),
}

impl Shape {
    /// Returns whether all sizes are positive and finite.
    pub(super) fn is_valid(&self) -> bool {
        let positive = |size: f32| size > 0.0 && size < 1e6;
        match self {
            Self::Sphere { radius } => positive(*radius),
            Self::Box { half } => half.iter().copied().all(positive),
            Self::Cylinder { radius, half_height } => positive(*radius) && positive(*half_height),
            Self::HalfSpace | Self::HeightField(_) | Self::Mesh(_) => true,
        }
    }

    /// Returns the radius of the bounding ball around the centre.
    pub(crate) fn reach(&self) -> f32 {
        match self {
            Self::Sphere { radius } => *radius,
            Self::Box { half } => length(*half),
            Self::Cylinder { radius, half_height } => length([*radius, *half_height, 0.0]),
            Self::HalfSpace => f32::INFINITY,
            Self::HeightField(field) => field.surface().reach(),
            Self::Mesh(mesh) => mesh.reach(),
        }
    }

    /// Returns the distance of a point from the surface; negative inside a solid. It is exact, as sphere tracing needs.
    pub fn distance(&self, point: Vector) -> f32 {
        let [x, y, z] = point;
        match self {
            Self::Sphere { radius } => length(point) - radius,
            Self::Box { half } => {
                let over: Vector = std::array::from_fn(|axis| point[axis].abs() - half[axis]);
                let inside = over[0].max(over[1]).max(over[2]).min(0.0);
                length(over.map(|side| side.max(0.0))) + inside
            }
            Self::Cylinder { radius, half_height } => {
                let (aside, above) = (length([x, y, 0.0]) - radius, z.abs() - half_height);
                length([aside.max(0.0), above.max(0.0), 0.0]) + aside.max(above).min(0.0)
            }
            Self::HalfSpace => z,
            Self::HeightField(field) => field.distance(point),
            Self::Mesh(mesh) => mesh.distance(point),
        }
    }

    /// Returns the outward normal of the surface at the point nearest to `point`.
    pub(super) fn normal(&self, point: Vector) -> Vector {
        let [x, y, z] = point;
        match self {
            Self::Sphere { .. } => unit(point),
            Self::Box { half } => {
                let over: Vector = std::array::from_fn(|axis| point[axis].abs() - half[axis]);
                let axis = (1..3).fold(0, |best, axis| if over[axis] > over[best] { axis } else { best });
                std::array::from_fn(|at| if at == axis { 1.0_f32.copysign(point[axis]) } else { 0.0 })
            }
            Self::Cylinder { radius, half_height } => match z.abs() - half_height > x.hypot(y) - radius {
                true => [0.0, 0.0, 1.0_f32.copysign(z)],
                false => unit([x, y, 0.0]),
            },
            Self::HalfSpace => [0.0, 0.0, 1.0],
            Self::HeightField(field) => field.surface().normal(point),
            Self::Mesh(mesh) => mesh.normal(point),
        }
    }

    /// Shortens the rays from `origin` that hit the surface, from either side, before they end. Lengths of rays are
    /// in lengths of their directions.
    #[inline(always)]
    pub(super) fn meet(&self, origin: Vector, directions: &Directions, distances: &mut [f32; LANES]) {
        match self {
            Self::Sphere { radius } => meet_sphere(*radius, origin, directions, distances),
            Self::Box { half } => meet_box(*half, origin, directions, distances),
            Self::Cylinder { radius, half_height } => {
                meet_cylinder(*radius, *half_height, origin, directions, distances);
            }
            Self::HalfSpace => meet_half_space(origin, directions, distances),
            Self::HeightField(field) => field.surface().meet(origin, directions, distances),
            Self::Mesh(mesh) => mesh.meet(origin, directions, distances),
        }
    }
}

/// Returns the nearer of entry and exit that is ahead and before the ray's end. The loops over lanes have no branches, so
/// that the compiler vectorises them.
#[inline(always)]
fn shortened(end: f32, entry: f32, exit: f32, meets: bool) -> f32 {
    let distance = if entry > 0.0 { entry } else { exit };
    if meets & (distance > 0.0) & (distance < end) { distance } else { end }
}

#[inline(always)]
pub(super) fn meet_half_space(origin: Vector, directions: &Directions, distances: &mut [f32; LANES]) {
    for lane in 0..LANES {
        let distance = -origin[2] / directions[2][lane];
        distances[lane] = shortened(distances[lane], distance, distance, true);
    }
}

/// Haines et al., Precision improvements for ray/sphere intersection (Ray Tracing Gems, 2019): the discriminant from the
/// ray's point nearest to the centre, since the textbook's cancels for far spheres.
#[inline(always)]
pub(super) fn meet_sphere(
    radius: f32,
    [x, y, z]: Vector,
    directions: &Directions,
    distances: &mut [f32; LANES],
) {
    for lane in 0..LANES {
        let [dx, dy, dz] = [directions[0][lane], directions[1][lane], directions[2][lane]];
        let inverse = 1.0 / (dx * dx + dy * dy + dz * dz);
        let nearest = -(x * dx + y * dy + z * dz) * inverse;
        let [px, py, pz] = [x + nearest * dx, y + nearest * dy, z + nearest * dz];
        let square = radius * radius - (px * px + py * py + pz * pz);
        let half = (square.max(0.0) * inverse).sqrt();
        distances[lane] = shortened(distances[lane], nearest - half, nearest + half, square >= 0.0);
    }
}

/// The slab method (Kay and Kajiya, 1986).
#[inline(always)]
pub(super) fn meet_box(half: Vector, origin: Vector, directions: &Directions, distances: &mut [f32; LANES]) {
    for lane in 0..LANES {
        let (mut entry, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
        for axis in 0..3 {
            let (first, second) = slab(half[axis], origin[axis], directions[axis][lane]);
            entry = larger(first, entry);
            exit = smaller(second, exit);
        }
        distances[lane] = shortened(distances[lane], entry, exit, entry <= exit);
    }
}

/// Returns the distances at which a ray enters and leaves `-half..=half` along one axis.
#[inline(always)]
fn slab(half: f32, origin: f32, direction: f32) -> (f32, f32) {
    let inverse = 1.0 / direction;
    let (one, other) = ((-half - origin) * inverse, (half - origin) * inverse);
    (smaller(one, other), larger(one, other))
}

/// One instruction, unlike `f32::min`, which handles NaN. NaN occurs for a ray within a face; the second argument is the right
/// result then.
#[inline(always)]
fn smaller(one: f32, other: f32) -> f32 {
    if one < other { one } else { other }
}

#[inline(always)]
fn larger(one: f32, other: f32) -> f32 {
    if one > other { one } else { other }
}

#[inline(always)]
pub(super) fn meet_cylinder(
    radius: f32,
    half_height: f32,
    [x, y, z]: Vector,
    directions: &Directions,
    distances: &mut [f32; LANES],
) {
    for lane in 0..LANES {
        let [dx, dy, dz] = [directions[0][lane], directions[1][lane], directions[2][lane]];
        let across = dx * dx + dy * dy;
        let moment = x * dy - y * dx;
        let square = radius * radius * across - moment * moment;
        let inverse = 1.0 / across.max(1e-30);
        let (nearest, half) = (-(x * dx + y * dy) * inverse, square.max(0.0).sqrt() * inverse);
        // A ray along the axis is always or never within the radius.
        let is_along = across < 1e-12;
        let within = is_along & (x * x + y * y <= radius * radius);
        let aside_entry = if within { f32::NEG_INFINITY } else { nearest - half };
        let aside_exit = if within { f32::INFINITY } else { nearest + half };
        let (entry, exit) = slab(half_height, z, dz);
        let (entry, exit) = (larger(entry, aside_entry), smaller(exit, aside_exit));
        let meets = (within | (!is_along & (square >= 0.0))) & (entry <= exit);
        distances[lane] = shortened(distances[lane], entry, exit, meets);
    }
}
