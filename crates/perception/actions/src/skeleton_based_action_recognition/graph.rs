//! Skeleton graphs: joints as nodes, bones as edges.

use opendr_engine::target::Skeleton;

opendr_engine::choices! {
    /// Skeleton: its joints and the bones between them.
    pub enum GraphType {
        /// The 25 joints of NTU RGB+D (Kinect v2).
        Ntu = "ntu",
        /// The 18 joints of Kinetics-Skeleton: OpenPose's, and OpenDR's own.
        Kinetics = "kinetics",
        /// COCO's 17 joints.
        Coco = "coco",
        /// JHMDB's 15 joints.
        Jhmdb = "jhmdb",
        /// The 20 joints of Kinect v1, in the order of UTD-MHAD.
        Kinect = "kinect",
    }
}

impl GraphType {
    /// Returns the skeleton.
    pub const fn skeleton(self) -> Skeleton {
        match self {
            Self::Ntu => Skeleton::Ntu25,
            Self::Kinetics => Skeleton::Opendr18,
            Self::Coco => Skeleton::Coco17,
            Self::Jhmdb => Skeleton::Jhmdb15,
            Self::Kinect => Skeleton::Kinect20,
        }
    }

    /// Returns the edges: the skeleton's bones. COCO's skeleton does not connect face and body; here its nose is connected to
    /// both shoulders.
    fn bones(self) -> impl Iterator<Item = [usize; 2]> {
        let neck: &[[usize; 2]] = if self == Self::Coco { &[[0, 5], [0, 6]] } else { &[] };
        self.skeleton().bones().iter().chain(neck).copied()
    }

    /// Returns the number of joints.
    pub const fn joints(self) -> usize {
        self.skeleton().joints().len()
    }

    /// Returns the joint at the centre of the graph.
    const fn centre(self) -> usize {
        match self {
            Self::Ntu => 20,
            Self::Kinetics | Self::Jhmdb => 1,
            Self::Coco => 0,
            Self::Kinect => 2,
        }
    }

    /// Returns the parent of each joint, its neighbour towards the centre; the centre is its own parent.
    pub fn parents(self) -> Vec<usize> {
        let distances = self.distances();
        let parent = |joint: usize| {
            let neighbours = self.bones().filter_map(|[from, to]| match (from == joint, to == joint) {
                (true, _) => Some(to),
                (_, true) => Some(from),
                _ => None,
            });
            neighbours.filter(|other| distances[*other] < distances[joint]).min().unwrap_or(joint)
        };
        (0..self.joints()).map(parent).collect()
    }

    /// Returns the number of bones between each joint and the centre.
    fn distances(self) -> Vec<usize> {
        let mut distances = vec![usize::MAX; self.joints()];
        distances[self.centre()] = 0;
        for _ in 0..self.joints() {
            for [from, to] in self.bones() {
                let (a, b) = (distances[from], distances[to]);
                distances[from] = a.min(b.saturating_add(1));
                distances[to] = b.min(a.saturating_add(1));
            }
        }
        distances
    }

    /// Returns three adjacency matrices `[3, joints, joints]`, row-major: the weight with which a joint (column) receives the
    /// features of joints (rows) at its own distance from the centre, nearer and farther. A column sums to one over the three
    /// matrices.
    ///
    /// The spatial configuration of Yan et al., Spatial Temporal Graph Convolutional Networks for Skeleton-Based Action
    /// Recognition, AAAI 2018, with distances counted in bones.
    pub fn adjacency(self) -> Vec<f32> {
        let (joints, distances) = (self.joints(), self.distances());
        let mut joined = vec![false; joints * joints];
        for joint in 0..joints {
            joined[joint * joints + joint] = true;
        }
        for [from, to] in self.bones() {
            joined[from * joints + to] = true;
            joined[to * joints + from] = true;
        }
        let mut parts = vec![0.0; 3 * joints * joints];
        for to in 0..joints {
            let degree = (0..joints).filter(|from| joined[from * joints + to]).count();
            for from in (0..joints).filter(|from| joined[from * joints + to]) {
                let part = match distances[from].cmp(&distances[to]) {
                    std::cmp::Ordering::Equal => 0,
                    std::cmp::Ordering::Less => 1,
                    std::cmp::Ordering::Greater => 2,
                };
                parts[(part * joints + from) * joints + to] = 1.0 / degree as f32;
            }
        }
        parts
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const ALL: [GraphType; 4] = [GraphType::Ntu, GraphType::Kinetics, GraphType::Coco, GraphType::Jhmdb];

    #[test]
    fn parents_lead_to_the_centre() {
        for graph in ALL {
            let parents = graph.parents();
            for start in 0..graph.joints() {
                let mut joint = start;
                for _ in 0..graph.joints() {
                    joint = parents[joint];
                }
                assert_eq!(joint, graph.centre(), "{}", graph.name());
            }
        }
    }

    #[test]
    fn adjacency_columns_sum_to_one() {
        for graph in ALL {
            let (joints, parts) = (graph.joints(), graph.adjacency());
            for to in 0..joints {
                let column = |part: usize| {
                    (0..joints).map(|from| parts[(part * joints + from) * joints + to]).sum::<f32>()
                };
                let [own, nearer, farther] = [0, 1, 2].map(column);
                assert!((own + nearer + farther - 1.0).abs() < 1e-6);
                assert_eq!(nearer == 0.0, to == graph.centre());
            }
        }
    }
}
