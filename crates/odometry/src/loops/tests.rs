use opendr_engine::{ErrorKind, Random};

use super::envelope::Envelope;
use super::*;
use crate::geometry::{Pose, Similarity3, distance, exponential};

fn node(scale: f64, pose: Pose) -> Similarity3 {
    Similarity3 { scale, pose }
}

fn between(first: &Similarity3, second: &Similarity3) -> Similarity3 {
    let motion = first.pose.inverse().then(&second.pose);
    let position = motion.position.map(|part| part / first.scale);
    node(second.scale / first.scale, Pose { position, ..motion })
}

/// A circle, its measured motions with a constant error, and the poses that follow from them.
fn circle(count: usize, turn_error: f64, growth: f64) -> (Vec<Similarity3>, PoseGraph) {
    let angle = std::f64::consts::TAU / (count - 1) as f64;
    let mut truth = vec![node(1.0, Pose::IDENTITY)];
    let mut graph = PoseGraph { nodes: vec![truth[0]], with_scale: growth != 1.0, ..PoseGraph::default() };
    let step = |angle: f64| Pose { rotation: exponential([0.0, angle, 0.0]), position: [0.0, 0.0, 1.0] };
    for at in 1..count {
        truth.push(node(1.0, truth[at - 1].pose.then(&step(angle))));
        let motion = node(growth, step(angle + turn_error));
        let last = graph.nodes[at - 1];
        let position = last.point(motion.pose.position);
        graph.nodes.push(node(last.scale * growth, Pose { position, ..last.pose.then(&motion.pose) }));
        let deviations = [0.003, 0.03, 0.01];
        graph.edges.push(Edge { between: [at - 1, at], motion, deviations, is_doubtful: false });
    }
    (truth, graph)
}

fn farthest(truth: &[Similarity3], found: &[Similarity3]) -> f64 {
    truth.iter().zip(found).map(|(a, b)| distance(a.pose.position, b.pose.position)).fold(0.0, f64::max)
}

fn loop_edge(truth: &[Similarity3], first: usize, second: usize) -> Edge {
    let motion = between(&truth[first], &truth[second]);
    Edge { between: [first, second], motion, deviations: [0.004, 0.05, 0.03], is_doubtful: true }
}

#[test]
fn envelopes_solve_sparse_systems() {
    let mut random = Random::new(1);
    let size = 40;
    let firsts: Vec<usize> =
        (0..size).map(|row: usize| if row == 33 { 0 } else { row.saturating_sub(3) }).collect();
    let mut dense = vec![0.0; size * size];
    let mut envelope = Envelope::default();
    envelope.reshape(&firsts);
    for row in 0..size {
        for column in firsts[row]..=row {
            let value = if row == column { 30.0 } else { random.normal() };
            envelope.add(row, column, value);
            (dense[row * size + column], dense[column * size + row]) = (value, value);
        }
    }
    let expected: Vec<f64> = (0..size).map(|_| random.normal()).collect();
    let mut right: Vec<f64> =
        (0..size).map(|row| (0..size).map(|at| dense[row * size + at] * expected[at]).sum()).collect();
    assert!(envelope.solve(&mut right));
    assert!(right.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-10));
    envelope.reshape(&firsts);
    assert!(!envelope.solve(&mut right));
}

#[test]
fn a_closed_loop_removes_drift() {
    for growth in [1.0, 1.004] {
        let (truth, mut graph) = circle(120, 0.002, growth);
        let before = farthest(&truth, &graph.nodes);
        let last = truth.len() - 1;
        graph.edges.push(loop_edge(&truth, 0, last));
        graph.edges.push(loop_edge(&truth, 1, last - 1));
        let report = graph.optimise(60).unwrap();
        let after = farthest(&truth, &graph.nodes);
        assert!(before > 3.0 && after < 0.25 * before, "{before} {after} {report:?}");
        assert!(report.errors[1] < report.errors[0]);
    }
}

#[test]
fn a_wrong_place_among_right_ones_loses_its_weight() {
    let (truth, mut graph) = circle(120, 0.002, 1.0);
    let before = farthest(&truth, &graph.nodes);
    let last = truth.len() - 1;
    for at in 0..4 {
        graph.edges.push(loop_edge(&truth, at, last - at));
    }
    let mut wrong = loop_edge(&truth, 30, 31);
    wrong.between = [30, 90];
    graph.edges.push(wrong);
    graph.optimise(100).unwrap();
    let after = farthest(&truth, &graph.nodes);
    assert!(after < 0.4 * before, "{before} {after}");
}

#[test]
fn impossible_edges_are_refused() {
    let (truth, graph) = circle(5, 0.0, 1.0);
    let edges: [fn(&mut Edge); 5] = [
        |edge| edge.between = [0, 9],
        |edge| edge.between = [2, 2],
        |edge| edge.deviations[1] = 0.0,
        |edge| edge.motion.scale = f64::NAN,
        |edge| edge.motion.pose.position[0] = f64::INFINITY,
    ];
    for change in edges {
        let mut graph = graph.clone();
        let mut edge = loop_edge(&truth, 0, 4);
        change(&mut edge);
        graph.edges.push(edge);
        assert_eq!(graph.optimise(5).unwrap_err().kind(), ErrorKind::InvalidInput);
    }
    assert!(PoseGraph::default().optimise(5).is_ok());
}

#[test]
fn the_place_with_the_same_descriptors_is_most_similar() {
    let mut random = Random::new(2);
    let mut places = Places::new();
    let mut all = Vec::new();
    for _ in 0..50 {
        let descriptors: Vec<_> = (0..100).map(|_| [(); 4].map(|()| random.bits())).collect();
        places.add(&descriptors);
        all.push(descriptors);
    }
    // A tenth of the bits of each descriptor is wrong.
    let again: Vec<_> = all[17]
        .iter()
        .map(|descriptor| {
            let mut noisy = *descriptor;
            (0..26).for_each(|_| {
                let bit = random.below(256);
                noisy[bit / 64] ^= 1 << (bit % 64);
            });
            noisy
        })
        .collect();
    let mut found = Vec::new();
    places.similar(&again, 50, 3, 2, &mut found);
    assert_eq!(found[0], 17);
    assert!(found[1..].iter().all(|place| place.abs_diff(17) > 2));
    places.similar(&again, 0, 3, 2, &mut found);
    assert!(found.is_empty());
}
