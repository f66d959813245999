//! Closing of loops.

use opendr_engine::Result;

use super::visual_odometry::VisualOdometry;
use crate::geometry::{Pose, Similarity3, scaled};
use crate::loops::{Edge, GraphReport, PoseGraph};

/// What closing loops found and did.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopReport {
    /// Number of new pairs of key frames that see one place.
    pub loops: usize,
    /// Number of all key frames.
    pub key_frames: usize,
    /// Optimisation of the pose graph; `None` without loops.
    pub graph: Option<GraphReport>,
}

/// Deviations of measured motions: of rotation in radians, of translation relative to its length, of the logarithm of scale.
const ODOMETRY: [f64; 3] = [0.003, 0.03, 0.01];
/// Smallest deviation of a translation, in metres.
const LEAST: f64 = 0.003;
/// Deviations of recognised places: of rotation in radians, of translation relative to the median depth, of the logarithm of scale.
const PLACE: [f64; 3] = [0.004, 0.008, 0.03];
const ITERATIONS: usize = 40;

impl VisualOdometry {
    /// Recognises places that key frames since the last call saw again, and moves all key frames, with the frames between them and what is
    /// followed, to the poses that agree best with all measured motions. It takes about a millisecond per new key frame, and longer where
    /// loops were found; call it at the end, or now and then.
    ///
    /// # Errors
    /// None for poses that tracking returned.
    pub fn close_loops(&mut self) -> Result<LoopReport> {
        let count = self.archive.records.len();
        let before = self.loops.len();
        let mut candidates = Vec::new();
        for number in self.searched..count {
            let view = std::mem::take(&mut self.archive.records[number].view);
            self.archive.similar(&view, number.saturating_sub(self.params.loop_gap), &mut candidates);
            for key in candidates.drain(..) {
                let threshold = 2.0 * self.params.threshold;
                let place =
                    self.archive.recognise(&self.camera, &view, key, threshold, self.params.loop_inliers);
                self.loops
                    .extend(place.map(|place| self.loop_edge(key, number, &place.motion, &place.pairs)));
            }
            self.archive.records[number].view = view;
        }
        self.searched = count;
        let loops = self.loops.len() - before;
        if loops == 0 {
            return Ok(LoopReport { loops, key_frames: count, graph: None });
        }
        let graph = self.optimise()?;
        Ok(LoopReport { loops, key_frames: count, graph: Some(graph) })
    }

    fn loop_edge(&self, key: usize, number: usize, motion: &Pose, pairs: &[[usize; 2]]) -> Edge {
        let [old, new] = [key, number].map(|at| &self.archive.records[at].points);
        let mut depths: Vec<f64> = pairs.iter().map(|[own, _]| f64::from(old[*own][2])).collect();
        depths.sort_by(f64::total_cmp);
        let mut scales: Vec<f64> = pairs
            .iter()
            .filter_map(|[own, its]| {
                let depth = motion.point_in_frame(old[*own].map(f64::from))[2];
                let scale = depth / f64::from(new[*its][2]);
                (scale.is_finite() && scale > 0.0).then_some(scale)
            })
            .collect();
        scales.sort_by(f64::total_cmp);
        let is_scaled = !self.observes_scale() && scales.len() >= 8;
        let scale = if is_scaled { scales[scales.len() / 2] } else { 1.0 };
        let depth = depths[depths.len() / 2];
        let by_scale = if is_scaled { PLACE[2] } else { 10.0 };
        Edge {
            between: [key, number],
            motion: Similarity3 { scale, pose: *motion },
            deviations: [PLACE[0], PLACE[1] * depth, by_scale],
            is_doubtful: true,
        }
    }

    fn optimise(&mut self) -> Result<GraphReport> {
        let with_scale = !self.observes_scale();
        let records = &mut self.archive.records;
        let mut edges = self.loops.clone();
        for number in 1..records.len() {
            let link = records[number].link;
            if link >= number {
                continue;
            }
            let (from, to) = (records[link].pose, records[number].pose);
            let motion = *records[number].motion.get_or_insert_with(|| between(&from, &to));
            let way = motion.pose.position.iter().map(|part| part * part).sum::<f64>().sqrt();
            let deviations = [ODOMETRY[0], (ODOMETRY[1] * way).max(LEAST), ODOMETRY[2]];
            edges.push(Edge { between: [link, number], motion, deviations, is_doubtful: false });
        }
        let nodes = records.iter().map(|record| record.pose).collect();
        let mut graph = PoseGraph { nodes, edges, with_scale };
        let report = graph.optimise(ITERATIONS)?;
        let last = records.last().map(|record| record.pose);
        for (record, node) in records.iter_mut().zip(&graph.nodes) {
            record.pose = *node;
        }
        if let (Some(old), Some(new)) = (last, graph.nodes.last().copied()) {
            self.move_window(&old, &new);
        }
        Ok(report)
    }

    /// Moves what is followed with the newest key frame, in whose scale it remains.
    fn move_window(&mut self, old: &Similarity3, new: &Similarity3) {
        let ratio = new.scale / old.scale;
        let rotation = new.pose.then(&Pose { position: [0.0; 3], ..old.pose }.inverse()).rotation;
        let turn = Pose { rotation, position: [0.0; 3] };
        let point = |point: [f64; 3]| {
            let aside = std::array::from_fn(|axis| ratio * (point[axis] - old.pose.position[axis]));
            let moved = turn.point(aside);
            std::array::from_fn(|axis| moved[axis] + new.pose.position[axis])
        };
        let pose = |pose: &Pose| Pose { position: point(pose.position), ..turn.then(pose) };
        for landmark in &mut self.landmarks {
            landmark.point = landmark.point.map(point);
        }
        for frame in &mut self.window {
            frame.pose = pose(&frame.pose);
        }
        self.pose = pose(&self.pose);
        self.motion.position = scaled(self.motion.position, ratio);
        for frame in &self.window {
            self.archive.records[frame.key as usize].pose.pose = frame.pose;
        }
    }
}

/// Returns the second in the first.
fn between(first: &Similarity3, second: &Similarity3) -> Similarity3 {
    let motion = first.pose.inverse().then(&second.pose);
    let position = scaled(motion.position, 1.0 / first.scale);
    Similarity3 { scale: second.scale / first.scale, pose: Pose { position, ..motion } }
}
