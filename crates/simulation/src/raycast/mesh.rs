//! Triangle meshes with a bounding volume hierarchy.

use opendr_engine::{Error, Result};

use super::triangle::Triangle;
use super::{Directions, LANES, Vector, dot, length, minus, unit};

/// A triangle mesh with a tree of bounding boxes, so that rays and distances test few triangles.
#[derive(Debug, Clone, PartialEq)]
pub struct Mesh {
    nodes: Vec<Node>,
    triangles: Vec<Triangle>,
    reach: f32,
}

/// A bounding box. A leaf has triangles; any other node is followed by its first child and stores the index of its second.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Node {
    low: Vector,
    high: Vector,
    /// Index of the first triangle, or of the second child.
    begin: u32,
    /// Number of triangles; 0 for a node with children.
    count: u32,
}

/// Maximum triangles of a leaf.
const LEAF: usize = 4;
/// Maximum depth of the tree: halving of 2^22 triangles, with reserve.
const DEPTH: usize = 32;
const MAX_TRIANGLES: usize = 1 << 22;

impl Mesh {
    /// Creates a mesh of triangles with three `vertices` each, counter-clockwise seen from outside.
    ///
    /// # Errors
    /// `InvalidInput` for no triangle or more than 2^22, for an invalid vertex index, and for a coordinate that is not finite
    /// or not below 1e6.
    pub fn new(vertices: &[Vector], faces: &[[u32; 3]]) -> Result<Self> {
        if faces.is_empty() || faces.len() > MAX_TRIANGLES {
            return Err(Error::invalid_input(format!(
                "the mesh has {} triangles; give 1 to {MAX_TRIANGLES}",
                faces.len()
            )));
        }
        let is_wrong = |vertex: &Vector| !vertex.iter().all(|part| part.abs() < 1e6);
        if let Some(at) = vertices.iter().position(is_wrong) {
            return Err(Error::invalid_input(format!(
                "vertex {at} of the mesh is {:?}; give finite numbers below 1e6",
                vertices[at]
            )));
        }
        let triangle = |face: &[u32; 3]| {
            let corner = |number: u32| vertices.get(number as usize).copied();
            Some(Triangle::new([corner(face[0])?, corner(face[1])?, corner(face[2])?]))
        };
        let mut triangles = Vec::with_capacity(faces.len());
        for (at, face) in faces.iter().enumerate() {
            triangles.push(triangle(face).ok_or_else(|| {
                let count = vertices.len();
                Error::invalid_input(format!(
                    "triangle {at} of the mesh has the vertices {face:?} of {count}; give indices below {count}"
                ))
            })?);
        }
        Ok(Self::of(triangles))
    }

    /// Builds the tree; `triangles` must not be empty.
    pub(super) fn of(mut triangles: Vec<Triangle>) -> Self {
        let mut nodes = Vec::with_capacity(2 * triangles.len().div_ceil(LEAF));
        let corners = triangles.iter().flat_map(Triangle::corners);
        let reach = corners.map(length).fold(0.0, f32::max);
        divide(&mut triangles, 0, &mut nodes);
        Self { nodes, triangles, reach }
    }

    /// Returns the number of triangles.
    pub fn triangles(&self) -> usize {
        self.triangles.len()
    }

    pub(super) fn reach(&self) -> f32 {
        self.reach
    }

    /// Returns the distance of a point from the surface; never negative.
    pub fn distance(&self, point: Vector) -> f32 {
        self.nearest(point).0
    }

    /// Returns the normal of the triangle nearest to a point.
    pub(super) fn normal(&self, point: Vector) -> Vector {
        unit(self.nearest(point).1.normal())
    }

    /// Compiled into each caller, with the vectors that the caller has.
    #[inline(always)]
    pub(super) fn meet(&self, origin: Vector, directions: &Directions, distances: &mut [f32; LANES]) {
        let inverse = directions.map(|axis| axis.map(|part| 1.0 / part));
        let mut stack = [0; DEPTH];
        let mut open = 1;
        while open > 0 {
            open -= 1;
            let at = stack[open];
            let node = &self.nodes[at as usize];
            if !node.is_met(origin, &inverse, distances) {
                continue;
            }
            if node.count > 0 {
                for triangle in self.triangles_of(node) {
                    triangle.meet(origin, directions, distances);
                }
                continue;
            }
            // The nearer child shortens rays before the farther one is tested.
            let [near, far] = self.in_order([at + 1, node.begin], origin);
            (stack[open], stack[open + 1]) = (far, near);
            open += 2;
        }
    }

    fn nearest(&self, point: Vector) -> (f32, &Triangle) {
        let mut best = (f32::INFINITY, &self.triangles[0]);
        let mut stack = [0; DEPTH];
        let mut open = 1;
        while open > 0 {
            open -= 1;
            let at = stack[open];
            let node = &self.nodes[at as usize];
            if node.distance(point) >= best.0 {
                continue;
            }
            if node.count > 0 {
                for triangle in self.triangles_of(node) {
                    let distance = length(minus(point, triangle.nearest(point)));
                    if distance < best.0 {
                        best = (distance, triangle);
                    }
                }
                continue;
            }
            let [near, far] = self.in_order([at + 1, node.begin], point);
            (stack[open], stack[open + 1]) = (far, near);
            open += 2;
        }
        best
    }

    fn triangles_of(&self, node: &Node) -> &[Triangle] {
        &self.triangles[node.begin as usize..(node.begin + node.count) as usize]
    }

    /// Returns two nodes, the nearer to a point first.
    fn in_order(&self, [a, b]: [u32; 2], point: Vector) -> [u32; 2] {
        let distance = |number: u32| {
            let node = &self.nodes[number as usize];
            let aside = minus(point, node.middle());
            dot(aside, aside)
        };
        if distance(a) <= distance(b) { [a, b] } else { [b, a] }
    }
}

impl Node {
    fn middle(&self) -> Vector {
        std::array::from_fn(|axis| (self.low[axis] + self.high[axis]) / 2.0)
    }

    fn distance(&self, point: Vector) -> f32 {
        let over = |axis: usize| (self.low[axis] - point[axis]).max(point[axis] - self.high[axis]).max(0.0);
        length([over(0), over(1), over(2)])
    }

    /// Returns whether a ray of the packet enters the box before its end.
    #[inline(always)]
    fn is_met(&self, origin: Vector, inverse: &Directions, distances: &[f32; LANES]) -> bool {
        let mut met = false;
        for lane in 0..LANES {
            let (mut entry, mut exit) = (0.0_f32, distances[lane]);
            for axis in 0..3 {
                let one = (self.low[axis] - origin[axis]) * inverse[axis][lane];
                let other = (self.high[axis] - origin[axis]) * inverse[axis][lane];
                // NaN, for a ray within a side of the box, leaves both unchanged.
                entry = entry.max(one.min(other));
                exit = exit.min(one.max(other));
            }
            // With a margin, so that rounding loses no triangle within a side of its box.
            met |= entry <= exit * 1.000_001;
        }
        met
    }
}

/// Sorts triangles into tree order and appends the nodes; `first` is the index of the first triangle.
fn divide(triangles: &mut [Triangle], first: u32, nodes: &mut Vec<Node>) {
    let (mut low, mut high) = ([f32::INFINITY; 3], [f32::NEG_INFINITY; 3]);
    for corner in triangles.iter().flat_map(Triangle::corners) {
        low = std::array::from_fn(|axis| low[axis].min(corner[axis]));
        high = std::array::from_fn(|axis| high[axis].max(corner[axis]));
    }
    let at = nodes.len();
    nodes.push(Node { low, high, begin: first, count: triangles.len() as u32 });
    if triangles.len() <= LEAF {
        return;
    }
    let side = minus(high, low);
    let axis = (1..3).fold(0, |best, axis| if side[axis] > side[best] { axis } else { best });
    let place = |triangle: &Triangle| triangle.corners().iter().map(|corner| corner[axis]).sum::<f32>();
    let middle = triangles.len() / 2;
    triangles.select_nth_unstable_by(middle, |a, b| place(a).total_cmp(&place(b)));
    let (left, right) = triangles.split_at_mut(middle);
    divide(left, first, nodes);
    let second = nodes.len() as u32;
    divide(right, first + middle as u32, nodes);
    (nodes[at].begin, nodes[at].count) = (second, 0);
}
