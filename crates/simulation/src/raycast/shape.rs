//! Shapes in their own frame: where a ray meets them, how far away they are.

use super::{LANES, Vector, length};

/// A shape centred in its own frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Shape {
    /// All points at `radius` or less from the centre.
    Sphere {
        /// In metres.
        radius: f32,
    },
    /// From minus to plus `half` along each axis.
    Box {
        /// Half of the length of each edge.
        half: Vector,
    },
    /// Around the z axis.
    Cylinder {
        /// In metres.
        radius: f32,
        /// Half of the height.
        half_height: f32,
    },
    /// All points with z of 0 or less.
    HalfSpace,
}

/// Directions of several rays: one array for each axis.
pub(super) type Directions = [[f32; LANES]; 3];

impl Shape {
    /// Whether all sizes are positive and finite.
    pub(super) fn is_valid(&self) -> bool {
        let positive = |size: f32| size > 0.0 && size < 1e6;
        match *self {
            Self::Sphere { radius } => positive(radius),
            Self::Box { half } => half.into_iter().all(positive),
            Self::Cylinder { radius, half_height } => positive(radius) && positive(half_height),
            Self::HalfSpace => true,
        }
    }

    /// The distance of a point from the surface; negative inside. Exact, so a ball of that radius is free.
    pub fn distance(&self, point: Vector) -> f32 {
        let [x, y, z] = point;
        match *self {
            Self::Sphere { radius } => length(point) - radius,
            Self::Box { half } => {
                let over: Vector = std::array::from_fn(|axis| point[axis].abs() - half[axis]);
                let inside = over[0].max(over[1]).max(over[2]).min(0.0);
                length(over.map(|side| side.max(0.0))) + inside
            }
            Self::Cylinder { radius, half_height } => {
                let (aside, above) = (x.hypot(y) - radius, z.abs() - half_height);
                aside.max(0.0).hypot(above.max(0.0)) + aside.max(above).min(0.0)
            }
            Self::HalfSpace => z,
        }
    }

    /// The direction away from the surface nearest to a point.
    pub(super) fn normal(&self, point: Vector) -> Vector {
        let [x, y, z] = point;
        match *self {
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
        }
    }

    /// Writes how far each ray from `origin` goes until it meets the surface, from either side; infinite where it never does. The directions are
    /// unit vectors. The loops have no branches: the compiler turns them into vectors.
    pub(super) fn meet(&self, origin: Vector, directions: &Directions, distances: &mut [f32; LANES]) {
        match *self {
            Self::Sphere { radius } => meet_sphere(radius, origin, directions, distances),
            Self::Box { half } => meet_box(half, origin, directions, distances),
            Self::Cylinder { radius, half_height } => {
                meet_cylinder(radius, half_height, origin, directions, distances);
            }
            Self::HalfSpace => {
                for lane in 0..LANES {
                    let distance = -origin[2] / directions[2][lane];
                    distances[lane] = if distance > 0.0 { distance } else { f32::INFINITY };
                }
            }
        }
    }
}

/// The nearer of entry and exit that lies ahead.
#[inline(always)]
fn ahead(entry: f32, exit: f32, meets: bool) -> f32 {
    let distance = if entry > 0.0 { entry } else { exit };
    if meets & (distance > 0.0) { distance } else { f32::INFINITY }
}

/// Haines et al., Precision improvements for ray/sphere intersection (Ray Tracing Gems, 2019): the discriminant from the
/// ray's point nearest to the centre, since the textbook's cancels for far spheres.
#[inline(always)]
fn meet_sphere(radius: f32, origin: Vector, directions: &Directions, distances: &mut [f32; LANES]) {
    let [x, y, z] = origin;
    for lane in 0..LANES {
        let [dx, dy, dz] = [directions[0][lane], directions[1][lane], directions[2][lane]];
        let nearest = -(x * dx + y * dy + z * dz);
        let [px, py, pz] = [x + nearest * dx, y + nearest * dy, z + nearest * dz];
        let square = radius * radius - (px * px + py * py + pz * pz);
        let half = square.max(0.0).sqrt();
        distances[lane] = ahead(nearest - half, nearest + half, square >= 0.0);
    }
}

/// The slab method (Kay and Kajiya, 1986).
#[inline(always)]
fn meet_box(half: Vector, origin: Vector, directions: &Directions, distances: &mut [f32; LANES]) {
    for lane in 0..LANES {
        let (mut entry, mut exit) = (f32::NEG_INFINITY, f32::INFINITY);
        for axis in 0..3 {
            let (first, second) = slab(half[axis], origin[axis], directions[axis][lane]);
            entry = entry.max(first);
            exit = exit.min(second);
        }
        distances[lane] = ahead(entry, exit, entry <= exit);
    }
}

/// The distances at which a ray enters and leaves `-half..=half` along one axis.
#[inline(always)]
fn slab(half: f32, origin: f32, direction: f32) -> (f32, f32) {
    let inverse = 1.0 / direction;
    // NaN on a face that the ray lies in: `min` and `max` pass over it.
    let (one, other) = ((-half - origin) * inverse, (half - origin) * inverse);
    (one.min(other), one.max(other))
}

#[inline(always)]
fn meet_cylinder(
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
        // A ray along the axis is within the radius always or never.
        let within = (across < 1e-12) & (x * x + y * y <= radius * radius);
        let (aside_entry, aside_exit) = match within {
            true => (f32::NEG_INFINITY, f32::INFINITY),
            false => (nearest - half, nearest + half),
        };
        let (entry, exit) = slab(half_height, z, dz);
        let (entry, exit) = (entry.max(aside_entry), exit.min(aside_exit));
        let meets = (within | ((across >= 1e-12) & (square >= 0.0))) & (entry <= exit);
        distances[lane] = ahead(entry, exit, meets);
    }
}

fn unit(vector: Vector) -> Vector {
    let size = length(vector);
    if size > 0.0 { vector.map(|part| part / size) } else { [0.0, 0.0, 1.0] }
}
