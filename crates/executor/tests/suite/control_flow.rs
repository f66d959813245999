//! Branches and loops.

use opendr_engine::ErrorKind;
use opendr_executor::Data;
use opendr_onnx::proto::{GraphProto, NodeProto};

use crate::graphs::{BOOL, F32, I64, floats, graph, ints, node, open, run, value, with_graph, with_int};

/// Returns `y = condition ? x * w : x - captured`, where `captured` is `x + x`.
pub fn branches(condition: &str, nodes: &[NodeProto]) -> GraphProto {
    let then = graph(&[node("MatMul", &["x", "w"], &["a"])], &[], &[value("a", F32, &[])], &[]);
    let otherwise = graph(&[node("Sub", &["x", "captured"], &["b"])], &[], &[value("b", F32, &[])], &[]);
    let branch = with_graph(node("If", &[condition], &["y"]), "then_branch", then);
    let branch = with_graph(branch, "else_branch", otherwise);
    let nodes = [&[node("Add", &["x", "x"], &["captured"])], nodes, &[branch]].concat();
    graph(
        &nodes,
        &[value("x", F32, &[-1, 2]), value("c", BOOL, &[])],
        &[value("y", F32, &[-1, -1])],
        &[floats("w", &[2, 2], &[1.0, 2.0, 3.0, 4.0]), ints("one", &[], &[1]), ints("zero", &[], &[0])],
    )
}

#[test]
fn a_branch_reads_values_around_it() {
    let mut executor = open(branches("c", &[])).unwrap();
    for _ in 0..2 {
        let x = Data::F32(&[1.0, 1.0]);
        let taken = run(&mut executor, &[(&[1, 2], x), (&[], Data::Bool(&[1]))]).unwrap();
        assert_eq!(taken, [(vec![1, 2], vec![4.0, 6.0])]);
        let other = run(&mut executor, &[(&[1, 2], x), (&[], Data::Bool(&[0]))]).unwrap();
        assert_eq!(other, [(vec![1, 2], vec![-1.0, -1.0])]);
        let x = Data::F32(&[1.0, 0.0, 0.0, 1.0]);
        let larger = run(&mut executor, &[(&[2, 2], x), (&[], Data::Bool(&[1]))]).unwrap();
        assert_eq!(larger, [(vec![2, 2], vec![1.0, 2.0, 3.0, 4.0])]);
    }
}

#[test]
fn a_branch_that_the_shapes_determine_is_a_part_of_the_plan() {
    let rows = [
        node("Shape", &["x"], &["shape"]),
        node("Gather", &["shape", "zero"], &["rows"]),
        node("Equal", &["rows", "one"], &["is_one"]),
    ];
    let mut executor = open(branches("is_one", &rows)).unwrap();
    let x = Data::F32(&[1.0, 1.0]);
    let inputs = [(&[1, 2][..], x), (&[][..], Data::Bool(&[0]))];
    assert_eq!(run(&mut executor, &inputs).unwrap(), [(vec![1, 2], vec![4.0, 6.0])]);
    let x = Data::F32(&[1.0, 1.0, 2.0, 2.0]);
    let inputs = [(&[2, 2][..], x), (&[][..], Data::Bool(&[0]))];
    assert_eq!(run(&mut executor, &inputs).unwrap(), [(vec![2, 2], vec![-1.0, -1.0, -2.0, -2.0])]);
}

/// Returns a loop that adds `x` to a sum, collects the sums, and goes on while the sum is below the limit.
pub fn sums() -> GraphProto {
    let body = graph(
        &[
            node("Add", &["before", "x"], &["after"]),
            node("ReduceMax", &["after"], &["largest"]),
            node("Less", &["largest", "limit"], &["goes_on"]),
            node("Identity", &["after"], &["scanned"]),
        ],
        &[value("i", I64, &[]), value("c", BOOL, &[]), value("before", F32, &[2])],
        &[value("goes_on", BOOL, &[]), value("after", F32, &[2]), value("scanned", F32, &[2])],
        &[],
    );
    let mut body = body;
    body.node[1] = with_int(body.node[1].clone(), "keepdims", 0);
    let looped = with_graph(node("Loop", &["trips", "", "start"], &["last", "all"]), "body", body);
    graph(
        &[looped],
        &[value("x", F32, &[2]), value("trips", I64, &[]), value("limit", F32, &[])],
        &[value("last", F32, &[2]), value("all", F32, &[-1, 2])],
        &[floats("start", &[2], &[0.0, 0.0])],
    )
}

#[test]
fn a_loop_ends_by_its_condition_or_its_number_of_iterations() {
    let mut executor = open(sums()).unwrap();
    let mut looped = |trips: i64, limit: f32| {
        let inputs =
            [(&[2][..], Data::F32(&[1.0, 2.0])), (&[], Data::I64(&[trips])), (&[], Data::F32(&[limit]))];
        run(&mut executor, &inputs).unwrap()
    };
    let three = looped(3, 100.0);
    assert_eq!(three[0], (vec![2], vec![3.0, 6.0]));
    assert_eq!(three[1], (vec![3, 2], vec![1.0, 2.0, 2.0, 4.0, 3.0, 6.0]));
    // The condition is read after an iteration.
    assert_eq!(looped(10, 4.0)[1], (vec![2, 2], vec![1.0, 2.0, 2.0, 4.0]));
    let none = looped(0, 4.0);
    assert_eq!((&none[0], &none[1]), (&(vec![2], vec![0.0, 0.0]), &(vec![0, 2], vec![])));
}

#[test]
fn an_endless_loop_is_an_error() {
    let mut executor = open(sums()).unwrap();
    let inputs =
        [(&[2][..], Data::F32(&[0.0, 0.0])), (&[], Data::I64(&[i64::MAX])), (&[], Data::F32(&[1.0]))];
    let error = run(&mut executor, &inputs).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    assert!(error.to_string().contains("do not end"), "{error}");
}

/// Returns a loop in a loop, whose body grows its value: `y` has `outer * inner` elements more than `x`.
pub fn growing() -> GraphProto {
    let inputs = |state: &str| [value("i", I64, &[]), value("c", BOOL, &[]), value(state, F32, &[-1])];
    let inner = graph(
        &[node("Identity", &["c"], &["d"]), node("Concat", &["b", "one"], &["grown"])],
        &inputs("b"),
        &[value("d", BOOL, &[]), value("grown", F32, &[-1])],
        &[],
    );
    let mut inner = inner;
    inner.node[1] = with_int(inner.node[1].clone(), "axis", 0);
    let inner = with_graph(node("Loop", &["trips", "", "a"], &["r"]), "body", inner);
    let outer = graph(
        &[node("Identity", &["c"], &["e"]), inner],
        &inputs("a"),
        &[value("e", BOOL, &[]), value("r", F32, &[-1])],
        &[],
    );
    let outer = with_graph(node("Loop", &["trips", "", "x"], &["y"]), "body", outer);
    graph(
        &[outer],
        &[value("x", F32, &[1]), value("trips", I64, &[])],
        &[value("y", F32, &[-1])],
        &[floats("one", &[1], &[1.0])],
    )
}

#[test]
fn loops_nest_and_their_values_may_grow() {
    let mut executor = open(growing()).unwrap();
    let grown = run(&mut executor, &[(&[1], Data::F32(&[7.0])), (&[], Data::I64(&[3]))]).unwrap();
    assert_eq!(grown[0].0, [10]);
    assert_eq!(grown[0].1[..2], [7.0, 1.0]);
}

#[test]
fn deep_nesting_and_missing_graphs_are_errors() {
    let nested = |depth: usize| {
        let mut inner = graph(&[node("Relu", &["x"], &["a"])], &[], &[value("a", F32, &[1])], &[]);
        for _ in 0..depth {
            let branch = with_graph(node("If", &["c"], &["a"]), "then_branch", inner.clone());
            inner =
                graph(&[with_graph(branch, "else_branch", inner.clone())], &[], &inner.output.clone(), &[]);
            // Both branches would double the size of the file with each level.
            let taken = inner.node[0].attribute[1].g.take().unwrap();
            let shallow = graph(&[node("Relu", &["x"], &["a"])], &[], &taken.output, &[]);
            inner.node[0].attribute[1].g = Some(shallow);
        }
        inner.input = vec![value("x", F32, &[1]), value("c", BOOL, &[])];
        open(inner)
    };
    let inputs = [(&[1][..], Data::F32(&[-1.0])), (&[][..], Data::Bool(&[1]))];
    assert_eq!(run(&mut nested(10).unwrap(), &inputs).unwrap(), [(vec![1], vec![0.0])]);
    assert_eq!(nested(17).unwrap_err().kind(), ErrorKind::Format);
    let mut missing = sums();
    missing.node[0].attribute.clear();
    assert_eq!(open(missing).unwrap_err().kind(), ErrorKind::Format);
}
