//! Shapes that depend on the elements of the inputs.

use opendr_executor::Data;
use opendr_onnx::proto::GraphProto;

use crate::graphs::{BOOL, F32, I64, floats, graph, ints, node, open, run, value, with_int};

/// Returns the elements of `x` above 0, doubled.
pub fn positive() -> GraphProto {
    graph(
        &[
            node("Greater", &["x", "zero"], &["above"]),
            node("NonZero", &["above"], &["places"]),
            node("Transpose", &["places"], &["rows"]),
            node("GatherND", &["x", "rows"], &["found"]),
            node("Add", &["found", "found"], &["y"]),
        ],
        &[value("x", F32, &[-1])],
        &[value("y", F32, &[-1]), value("above", BOOL, &[-1])],
        &[floats("zero", &[], &[0.0])],
    )
}

#[test]
fn a_selection_has_as_many_elements_as_it_finds() {
    let mut executor = open(positive()).unwrap();
    for x in [&[1.0, -1.0, 2.0][..], &[-1.0, -2.0, -3.0], &[3.0, 4.0], &[1.0, -1.0, 2.0]] {
        let wanted: Vec<f64> = x.iter().filter(|x| **x > 0.0).map(|x| 2.0 * f64::from(*x)).collect();
        let outputs = run(&mut executor, &[(&[x.len()], Data::F32(x))]).unwrap();
        assert_eq!(outputs[0], (vec![wanted.len()], wanted));
        assert_eq!(outputs[1].0, [x.len()]);
    }
}

#[test]
fn more_selections_than_plans_are_kept() {
    let mut executor = open(positive()).unwrap();
    for length in (1..20).chain([3]) {
        let x = vec![1.5; length];
        let outputs = run(&mut executor, &[(&[length], Data::F32(&x))]).unwrap();
        assert_eq!(outputs[0], (vec![length], vec![3.0; length]));
    }
}

#[test]
fn sizes_may_be_inputs_and_sums() {
    // `Slice(Reshape(x, shape), 0, sum(counts))`, and a range as long as the sum.
    let sum = with_int(node("ReduceSum", &["counts"], &["end"]), "keepdims", 0);
    let model = graph(
        &[
            node("Reshape", &["x", "shape"], &["r"]),
            sum,
            node("Unsqueeze", &["end", "first"], &["ends"]),
            node("Slice", &["r", "first", "ends", "first"], &["y"]),
            node("Range", &["zero", "end", "one"], &["range"]),
        ],
        &[value("x", F32, &[6]), value("shape", I64, &[2]), value("counts", I64, &[2])],
        &[value("y", F32, &[-1, -1]), value("range", I64, &[-1])],
        &[ints("first", &[1], &[0]), ints("zero", &[], &[0]), ints("one", &[], &[1])],
    );
    let mut executor = open(model).unwrap();
    let x = Data::F32(&[0.0, 1.0, 2.0, 3.0, 4.0, 5.0]);
    for (shape, counts, rows) in [([3, 2], [1, 1], 2), ([2, 3], [1, 0], 1), ([3, 2], [1, 2], 3)] {
        let inputs = [(&[6][..], x), (&[2], Data::I64(&shape)), (&[2], Data::I64(&counts))];
        let outputs = run(&mut executor, &inputs).unwrap();
        let columns = shape[1] as usize;
        assert_eq!(outputs[0].0, [rows, columns]);
        assert_eq!(outputs[0].1, (0..rows * columns).map(|x| x as f64).collect::<Vec<_>>());
        assert_eq!(outputs[1].1, (0..rows).map(|x| x as f64).collect::<Vec<_>>());
    }
}

#[test]
fn weights_may_be_computed() {
    // The weights and the bias of a convolution depend on an input.
    let model = graph(
        &[
            node("Mul", &["w", "factor"], &["weights"]),
            node("Mul", &["b", "factor"], &["bias"]),
            node("Conv", &["x", "weights", "bias"], &["y"]),
        ],
        &[value("x", F32, &[1, 1, 1, 3]), value("factor", F32, &[1])],
        &[value("y", F32, &[1, 1, 1, 2])],
        &[floats("w", &[1, 1, 1, 2], &[1.0, 2.0]), floats("b", &[1], &[1.0])],
    );
    let mut executor = open(model).unwrap();
    for factor in [1.0, 2.0, 1.0, -3.0] {
        let inputs = [(&[1, 1, 1, 3][..], Data::F32(&[1.0, 2.0, 3.0])), (&[1], Data::F32(&[factor]))];
        let factor = f64::from(factor);
        let wanted = vec![6.0 * factor, 9.0 * factor];
        assert_eq!(run(&mut executor, &inputs).unwrap(), [(vec![1, 1, 1, 2], wanted)]);
    }
}

#[test]
fn a_list_that_does_not_fit_is_an_error_and_the_next_run_works() {
    let model = graph(
        &[node("Reshape", &["x", "shape"], &["y"])],
        &[value("x", F32, &[6]), value("shape", I64, &[2])],
        &[value("y", F32, &[-1, -1])],
        &[],
    );
    let mut executor = open(model).unwrap();
    let x = Data::F32(&[0.0; 6]);
    for (shape, fits) in
        [([2, 3], true), ([4, 4], false), ([i64::MAX, i64::MAX], false), ([-7, 1], false), ([3, 2], true)]
    {
        let inputs = [(&[6][..], x), (&[2], Data::I64(&shape))];
        assert_eq!(run(&mut executor, &inputs).is_ok(), fits, "{shape:?}");
    }
}
