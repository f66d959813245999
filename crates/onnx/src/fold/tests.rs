use super::super::array::Data;
use super::*;

fn one(operator: Operator, inputs: &[Array]) -> Option<Array> {
    let inputs: Vec<Option<&Array>> = inputs.iter().map(Some).collect();
    evaluate(&operator, &inputs).and_then(|outputs| outputs.into_iter().next())
}

fn ints(values: &[i64]) -> Array {
    Array::ints(values.to_vec())
}

fn matrix() -> Array {
    Array::new(vec![2, 3], Data::Int((0..6).collect())).unwrap()
}

#[test]
fn movement_operators() {
    let transpose = Operator::new("Transpose").ints("perm", [1, 0]);
    assert_eq!(one(transpose, &[matrix()]).unwrap().as_ints(), Some(&[0, 3, 1, 4, 2, 5][..]));
    let slice = |start, end, step| {
        let inputs = [matrix(), ints(&[start]), ints(&[end]), ints(&[1]), ints(&[step])];
        one(Operator::new("Slice"), &inputs).unwrap().as_ints().unwrap().to_vec()
    };
    assert_eq!(slice(-2, i64::MAX, 1), [1, 2, 4, 5]);
    assert_eq!(slice(-1, i64::MIN, -2), [2, 0, 5, 3]);
    assert_eq!(slice(2, 1, 1), [0i64; 0]);
    let gather = Operator::new("Gather").int("axis", 1);
    let picked = one(gather, &[matrix(), ints(&[-1, 0])]).unwrap();
    assert_eq!((picked.dims(), picked.as_ints()), (&[2, 2][..], Some(&[2, 0, 5, 3][..])));
    let concat = Operator::new("Concat").int("axis", 1);
    assert_eq!(one(concat, &[matrix(), matrix()]).unwrap().dims(), [2, 6]);
    let tiled = one(Operator::new("Tile"), &[matrix(), ints(&[2, 1])]).unwrap();
    assert_eq!((tiled.dims(), tiled.data().len()), (&[4, 3][..], 12));
    let split = Operator::new("Split").int("axis", 1);
    let parts = evaluate(&split, &[Some(&matrix()), Some(&ints(&[1, 2]))]).unwrap();
    assert_eq!(parts[1].as_ints(), Some(&[1, 2, 4, 5][..]));
    let scattered = one(
        Operator::new("ScatterND"),
        &[
            matrix(),
            Array::new(vec![1, 1], Data::Int(vec![1])).unwrap(),
            Array::new(vec![1, 3], Data::Int(vec![7; 3])).unwrap(),
        ],
    );
    assert_eq!(scattered.unwrap().as_ints(), Some(&[0, 1, 2, 7, 7, 7][..]));
}

#[test]
fn arithmetic_broadcasts() {
    let sum = one(Operator::new("Add"), &[matrix(), ints(&[10, 20, 30])]).unwrap();
    assert_eq!(sum.as_ints(), Some(&[10, 21, 32, 13, 24, 35][..]));
    let remainder = one(Operator::new("Mod"), &[ints(&[-7, 7, 6]), ints(&[3, -3, 3])]).unwrap();
    assert_eq!(remainder.as_ints(), Some(&[2, -2, 0][..]));
    let less = one(Operator::new("Less"), &[ints(&[1, 2]), ints(&[2])]).unwrap();
    assert_eq!(less.data(), &Data::Bool(vec![true, false]));
    let range = one(Operator::new("Range"), &[Array::int(5), Array::int(0), Array::int(-2)]).unwrap();
    assert_eq!(range.as_ints(), Some(&[5, 3, 1][..]));
    let mean = Operator::new("ReduceMean").ints("axes", [0]).int("keepdims", 0);
    let floats = Array::new(vec![2, 2], Data::Float(vec![1.0, 2.0, 3.0, 6.0])).unwrap();
    assert_eq!(one(mean, &[floats]).unwrap().as_floats(), Some(&[2.0, 4.0][..]));
}

#[test]
fn unknown_elements_stay_unknown_until_removed() {
    let shape = Array::partial(vec![Some(1), None, Some(3)]);
    let doubled = one(Operator::new("Mul"), &[shape, ints(&[2])]).unwrap();
    assert_eq!(doubled.data(), &Data::Partial(vec![Some(2), None, Some(6)]));
    let last = one(Operator::new("Gather").int("axis", 0), &[doubled, ints(&[2])]).unwrap();
    assert_eq!(last.as_ints(), Some(&[6][..]));
}

#[test]
fn invalid_and_huge_operands_are_declined() {
    let huge = Array::ints(vec![1 << 40]);
    assert_eq!(one(Operator::new("Expand"), &[Array::int(1), huge.clone()]), None);
    assert_eq!(one(Operator::new("Tile"), &[ints(&[1]), huge]), None);
    assert_eq!(one(Operator::new("Div"), &[ints(&[1]), ints(&[0])]), None);
    assert_eq!(one(Operator::new("Add"), &[ints(&[1, 2]), ints(&[1, 2, 3])]), None);
    assert_eq!(one(Operator::new("Mul"), &[ints(&[i64::MAX]), ints(&[2])]), None);
    let range = [Array::int(0), Array::int(i64::MAX), Array::int(1)];
    assert_eq!(one(Operator::new("Range"), &range), None);
    let steps = [matrix(), ints(&[0]), ints(&[3]), ints(&[1]), ints(&[i64::MAX])];
    assert_eq!(one(Operator::new("Slice"), &steps).unwrap().as_ints(), Some(&[0, 3][..]));
}
