//! Sums of products over named axes.

use opendr_executor::Data;

use crate::graphs::{F32, floats, graph, node, open, run, value, with_text};

/// Equation, shapes of the inputs, shape and elements of the result (NumPy's `einsum`). Element `i` of an input is `i % 7 - 2`.
type Case = (&'static str, &'static [&'static [usize]], &'static [usize], &'static [f64]);

const CASES: &[Case] = &[
    ("ij,jk->ik", &[&[2, 3], &[3, 2]], &[2, 2], &[4.0, 1.0, 4.0, 10.0]),
    ("ij,jk", &[&[2, 3], &[3, 2]], &[2, 2], &[4.0, 1.0, 4.0, 10.0]),
    ("bij,bjk->bik", &[&[2, 2, 3], &[2, 3, 1]], &[2, 2, 1], &[5.0, -4.0, -3.0, 8.0]),
    ("i,j->ij", &[&[2], &[3]], &[2, 3], &[4.0, 2.0, 0.0, 2.0, 1.0, 0.0]),
    ("ii->i", &[&[3, 3]], &[3], &[-2.0, 2.0, -1.0]),
    ("ij->", &[&[2, 3]], &[], &[3.0]),
    ("ij->ji", &[&[2, 3]], &[3, 2], &[-2.0, 1.0, -1.0, 2.0, 0.0, 3.0]),
    ("...ij,jk->...ik", &[&[2, 2, 3], &[3, 2]], &[2, 2, 2], &[4.0, 1.0, 4.0, 10.0, -10.0, -9.0, 4.0, 7.0]),
    (
        "bhwc,hkc->bhwk",
        &[&[1, 2, 2, 3], &[2, 2, 3]],
        &[1, 2, 2, 2],
        &[5.0, -4.0, -4.0, 14.0, 21.0, -4.0, -4.0, 5.0],
    ),
    ("ij,jk,kl->il", &[&[2, 2], &[2, 3], &[3, 2]], &[2, 2], &[-12.0, -12.0, 4.0, 10.0]),
    ("ij,ij->i", &[&[2, 3], &[2, 3]], &[2], &[5.0, 14.0]),
    ("ij,k->i", &[&[2, 3], &[2]], &[2], &[9.0, -18.0]),
    ("iij,j->i", &[&[2, 2, 3], &[3]], &[2], &[5.0, -1.0]),
    ("...,...", &[&[2, 3], &[1, 3]], &[2, 3], &[4.0, 1.0, 0.0, -2.0, -2.0, 0.0]),
];

fn numbers(shape: &[usize]) -> Vec<f32> {
    (0..shape.iter().product()).map(|i: usize| (i % 7) as f32 - 2.0).collect()
}

#[test]
fn equations_give_what_numpy_gives() {
    for &(equation, shapes, shape, wanted) in CASES {
        let names: Vec<String> = (0..shapes.len()).map(|i| format!("x{i}")).collect();
        let names: Vec<&str> = names.iter().map(String::as_str).collect();
        let einsum = with_text(node("Einsum", &names, &["y"]), "equation", equation);
        let dims = |shape: &[usize]| shape.iter().map(|&dim| dim as i64).collect::<Vec<_>>();
        // All inputs, and the first input with constants for the others.
        for variable in [shapes.len(), 1] {
            let inputs: Vec<_> = names
                .iter()
                .zip(shapes)
                .take(variable)
                .map(|(name, shape)| value(name, F32, &dims(shape)))
                .collect();
            let constants: Vec<_> = names
                .iter()
                .zip(shapes)
                .skip(variable)
                .map(|(name, shape)| floats(name, &dims(shape), &numbers(shape)))
                .collect();
            let output = [value("y", F32, &dims(shape))];
            let mut executor =
                open(graph(std::slice::from_ref(&einsum), &inputs, &output, &constants)).unwrap();
            let data: Vec<Vec<f32>> = shapes.iter().map(|shape| numbers(shape)).collect();
            let inputs: Vec<(&[usize], Data<'_>)> = shapes
                .iter()
                .zip(&data)
                .take(variable)
                .map(|(shape, data)| (*shape, Data::F32(data)))
                .collect();
            let outputs = run(&mut executor, &inputs).unwrap();
            assert_eq!(outputs, [(shape.to_vec(), wanted.to_vec())], "{equation}");
        }
    }
}

#[test]
fn equations_that_do_not_fit_are_errors() {
    for equation in
        ["", "ij", "ij,jk->iz", "ij,jk->ii", "i->i", "ij,jk,kl->il", "i1,jk->ik", "...ij,jk->ij..."]
    {
        let einsum = with_text(node("Einsum", &["a", "b"], &["y"]), "equation", equation);
        let inputs = [value("a", F32, &[2, 3]), value("b", F32, &[3, 2])];
        let opened = open(graph(&[einsum], &inputs, &[value("y", F32, &[-1])], &[]));
        assert_eq!(opened.is_err(), equation != "...ij,jk->ij...", "{equation}");
    }
}
