//! Optimisation of a graph of poses.

use opendr_engine::{Error, Result};

use super::envelope::Envelope;
use crate::geometry::{Pose, Similarity3, exponential, scaled};

/// A measured motion between two poses of the graph.
#[derive(Debug, Clone, PartialEq)]
pub struct Edge {
    /// Numbers of the two poses.
    pub between: [usize; 2],
    /// Pose of the second in the first, with the scale of the second's map in that of the first's; 1 where scale is observed.
    pub motion: Similarity3,
    /// Standard deviations of rotation in radians, translation in metres, and the logarithm of scale.
    pub deviations: [f64; 3],
    /// Whether the measurement may be wrong, as a recognised place may be: its weight falls with its error.
    pub is_doubtful: bool,
}

/// A graph of poses that is optimised on SE(3), or on Sim(3) where scale drifts, by Levenberg and Marquardt's method (G. Grisetti et al.,
/// A tutorial on graph-based SLAM, 2010; H. Strasdat, J. Montiel and A. Davison, Scale drift-aware large scale monocular SLAM, 2010).
#[derive(Debug, Clone, Default)]
pub struct PoseGraph {
    /// Poses with their scales. The first is fixed.
    pub nodes: Vec<Similarity3>,
    /// Measured motions.
    pub edges: Vec<Edge>,
    /// Whether scales are optimised too.
    pub with_scale: bool,
}

/// What an optimisation did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct GraphReport {
    /// Weighted sum of squared errors before and after.
    pub errors: [f64; 2],
    /// Number of iterations.
    pub iterations: usize,
}

/// Numbers of a pose: rotation, translation, logarithm of scale.
const SIZE: usize = 7;
/// Square of the error, in standard deviations, at which a doubtful edge has half its weight.
const DOUBT: f64 = 25.0;

type Residual = [f64; SIZE];

impl PoseGraph {
    /// Moves the nodes to the least sum of squared errors.
    ///
    /// # Errors
    /// `InvalidInput` for an edge between nodes that do not exist or are one, with a deviation that is not positive, or numbers that are
    /// not finite.
    pub fn optimise(&mut self, most_iterations: usize) -> Result<GraphReport> {
        self.check()?;
        let (mut damping, mut iterations) = (1e-6, 0);
        let first_error = self.error(&self.nodes);
        let mut error = first_error;
        let mut work = Work::default();
        let firsts = self.firsts();
        while iterations < most_iterations && damping < 1e8 {
            iterations += 1;
            self.assemble(&firsts, damping, &mut work);
            if !work.matrix.solve(&mut work.right) {
                damping *= 10.0;
                continue;
            }
            work.moved.clear();
            work.moved.extend(
                self.nodes.iter().zip(work.right.chunks_exact(SIZE)).map(|(node, step)| moved(node, step)),
            );
            let next = self.error(&work.moved);
            if next.is_nan() || next > error {
                damping *= 10.0;
                continue;
            }
            let gain = error - next;
            self.nodes.copy_from_slice(&work.moved);
            (error, damping) = (next, (damping / 5.0).max(1e-9));
            if gain < 1e-7 * error + 1e-12 {
                break;
            }
        }
        Ok(GraphReport { errors: [first_error, error], iterations })
    }

    fn check(&self) -> Result<()> {
        let count = self.nodes.len();
        for (number, edge) in self.edges.iter().enumerate() {
            let [a, b] = edge.between;
            let is_positive = edge.deviations.iter().all(|part| *part > 0.0 && part.is_finite());
            if a >= count
                || b >= count
                || a == b
                || !is_positive
                || !edge.motion.pose.is_finite()
                || edge.motion.scale.is_nan()
                || edge.motion.scale <= 0.0
            {
                return Err(Error::invalid_input(format!(
                    "edge {number} of the pose graph joins {a} and {b} of {count} poses with deviations {:?} and scale {}; join two different poses with positive numbers",
                    edge.deviations, edge.motion.scale
                )));
            }
        }
        Ok(())
    }

    /// Returns the first column of each row of the matrix.
    fn firsts(&self) -> Vec<usize> {
        let mut firsts: Vec<usize> = (0..self.nodes.len()).collect();
        for edge in &self.edges {
            let [low, high] = [edge.between[0].min(edge.between[1]), edge.between[0].max(edge.between[1])];
            firsts[high] = firsts[high].min(low);
        }
        firsts.iter().flat_map(|first| [first * SIZE; SIZE]).collect()
    }

    fn error(&self, nodes: &[Similarity3]) -> f64 {
        self.edges
            .iter()
            .map(|edge| {
                let square = squared(&edge.residual(nodes));
                if edge.is_doubtful { DOUBT * (1.0 + square / DOUBT).ln() } else { square }
            })
            .sum()
    }

    fn assemble(&self, firsts: &[usize], damping: f64, work: &mut Work) {
        work.matrix.reshape(firsts);
        work.right.clear();
        work.right.resize(SIZE * self.nodes.len(), 0.0);
        for edge in &self.edges {
            let residual = edge.residual(&self.nodes);
            let weight = if edge.is_doubtful { 1.0 / (1.0 + squared(&residual) / DOUBT) } else { 1.0 };
            let slopes = edge.between.map(|number| self.slopes(edge, number));
            for (side, number) in edge.between.into_iter().enumerate() {
                for row in 0..SIZE {
                    let at = SIZE * number + row;
                    work.right[at] -= weight * product(&slopes[side][row], &residual);
                    for (other_side, other) in edge.between.into_iter().enumerate() {
                        for column in 0..SIZE {
                            let other_at = SIZE * other + column;
                            if other_at <= at {
                                let value = product(&slopes[side][row], &slopes[other_side][column]);
                                work.matrix.add(at, other_at, weight * value);
                            }
                        }
                    }
                }
            }
        }
        for at in 0..SIZE * self.nodes.len() {
            let is_fixed = at < SIZE || (at % SIZE == SIZE - 1 && !self.with_scale);
            let added = if is_fixed { 1e12 } else { damping * work.matrix.diagonal(at) + 1e-9 };
            work.matrix.add(at, at, added);
            if is_fixed {
                work.right[at] = 0.0;
            }
        }
    }

    /// Returns the derivatives of an edge's residual by the numbers of a node, by central differences.
    fn slopes(&self, edge: &Edge, number: usize) -> [Residual; SIZE] {
        const STEP: f64 = 1e-6;
        std::array::from_fn(|at| {
            if at == SIZE - 1 && !self.with_scale {
                return [0.0; SIZE];
            }
            let [above, below] = [STEP, -STEP].map(|step| {
                let mut steps = [0.0; SIZE];
                steps[at] = step;
                let node = moved(&self.nodes[number], &steps);
                let ends = edge.between.map(|end| if end == number { node } else { self.nodes[end] });
                edge.residual_of(ends)
            });
            std::array::from_fn(|part| (above[part] - below[part]) / (2.0 * STEP))
        })
    }
}

/// Memory of an iteration.
#[derive(Debug, Default)]
struct Work {
    matrix: Envelope,
    right: Vec<f64>,
    moved: Vec<Similarity3>,
}

impl Edge {
    fn residual(&self, nodes: &[Similarity3]) -> Residual {
        self.residual_of(self.between.map(|number| nodes[number]))
    }

    /// Returns the errors in standard deviations.
    fn residual_of(&self, [first, second]: [Similarity3; 2]) -> Residual {
        let aside = first.pose.point_in_frame(second.pose.position);
        let turned = Pose { position: [0.0; 3], ..first.pose }.inverse().then(&second.pose).rotation;
        let measured = &self.motion;
        let back = Pose { position: [0.0; 3], ..measured.pose }.inverse();
        let rotation = back.then(&Pose { rotation: turned, position: [0.0; 3] }).rotation_vector();
        let shift = scaled(aside, 1.0 / first.scale);
        let scale = (second.scale / (first.scale * measured.scale)).ln();
        let [by_rotation, by_shift, by_scale] = self.deviations.map(|deviation| 1.0 / deviation);
        let [a, b, c] = scaled(rotation, by_rotation);
        let [x, y, z] = std::array::from_fn(|axis| by_shift * (shift[axis] - measured.pose.position[axis]));
        [a, b, c, x, y, z, by_scale * scale]
    }
}

/// Returns the node rotated in its own frame, moved in the world, and scaled.
fn moved(node: &Similarity3, step: &[f64]) -> Similarity3 {
    let turn = Pose { rotation: exponential([step[0], step[1], step[2]]), position: [0.0; 3] };
    let rotation = node.pose.then(&turn).rotation;
    let position = std::array::from_fn(|axis| node.pose.position[axis] + step[3 + axis]);
    Similarity3 { scale: node.scale * step[6].exp(), pose: Pose { rotation, position } }
}

fn product(a: &Residual, b: &Residual) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

fn squared(residual: &Residual) -> f64 {
    product(residual, residual)
}
