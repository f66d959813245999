//! Products and convolutions of bytes beside their definition, and networks that ONNX Runtime has quantised dynamically.

use opendr_executor::Data;
use opendr_onnx::proto::{DataType, TensorProto};

use crate::graphs::{F32, graph, node, open, run, value, with_int};

fn bytes(name: &str, dims: &[i64], kind: DataType, raw_data: &[u8]) -> TensorProto {
    TensorProto {
        name: name.to_owned(),
        dims: dims.to_vec(),
        data_type: kind as i32,
        raw_data: raw_data.to_vec(),
        ..TensorProto::default()
    }
}

/// Pseudo-random bytes, the same every time.
fn noise(count: usize, seed: u64) -> Vec<u8> {
    let mut state = seed.wrapping_mul(0x9e37_79b9_7f4a_7c15) | 1;
    let mut next = || {
        state ^= state << 13;
        state ^= state >> 7;
        state ^= state << 17;
        (state >> 40) as u8
    };
    (0..count).map(|_| next()).collect()
}

#[test]
fn products_equal_their_definition() {
    let (rows, depth, columns) = (5, 37, 19);
    let (a, b) = (noise(rows * depth, 1), noise(depth * columns, 2));
    let (a_zero, b_zeros) = (131, noise(columns, 3));
    let mut wanted = vec![0.0; rows * columns];
    for (at, wanted) in wanted.iter_mut().enumerate() {
        let (row, column) = (at / columns, at % columns);
        for step in 0..depth {
            let a = f64::from(a[row * depth + step]) - f64::from(a_zero);
            let b = b[step * columns + column] as i8;
            *wanted += a * (f64::from(b) - f64::from(b_zeros[column] as i8));
        }
    }
    let sizes = [rows as i64, depth as i64, columns as i64];
    let zeros = bytes("b_zeros", &sizes[2..], DataType::Int8, &b_zeros);
    let weights = bytes("b", &sizes[1..], DataType::Int8, &b);
    let product = node("MatMulInteger", &["a", "b", "a_zero", "b_zeros"], &["y"]);
    let inputs = [
        value("a", DataType::Uint8, &sizes[..2]),
        value("a_zero", DataType::Uint8, &[]),
        value("b", DataType::Int8, &sizes[1..]),
    ];
    let output = [value("y", DataType::Int32, &[sizes[0], sizes[2]])];
    let signed: Vec<i8> = b.iter().map(|&byte| byte as i8).collect();
    let data =
        [(&[rows, depth][..], Data::U8(&a)), (&[], Data::U8(&[131])), (&[depth, columns], Data::I8(&signed))];
    let constant = graph(std::slice::from_ref(&product), &inputs[..2], &output, &[weights, zeros.clone()]);
    let by_weights = run(&mut open(constant).unwrap(), &data[..2]).unwrap();
    assert_eq!(by_weights, [(vec![rows, columns], wanted.clone())]);
    let variable = graph(&[product], &inputs, &output, &[zeros]);
    assert_eq!(run(&mut open(variable).unwrap(), &data).unwrap(), [(vec![rows, columns], wanted)]);
}

#[test]
fn convolutions_equal_their_definition() {
    for (groups, channels, outputs) in [(1, 3, 4), (2, 2, 3), (4, 1, 1)] {
        let (all, made) = (groups * channels, groups * outputs);
        let (x, w) = (noise(all * 25, 4), noise(made * channels * 9, 5));
        let mut wanted = vec![0.0; made * 9];
        for (at, wanted) in wanted.iter_mut().enumerate() {
            let (output, row, column) = (at / 9, at / 3 % 3, at % 3);
            for tap in 0..channels * 9 {
                let (channel, down, across) = (tap / 9, tap / 3 % 3, tap % 3);
                let (y, x_at) = (2 * row + down, 2 * column + across);
                // One pixel is added on each side.
                if (1..6).contains(&y) && (1..6).contains(&x_at) {
                    let channel_at = output / outputs * channels + channel;
                    let x = f64::from(x[(channel_at * 5 + y - 1) * 5 + x_at - 1]) - 7.0;
                    *wanted += x * (f64::from(w[output * channels * 9 + tap]) - 120.0);
                }
            }
        }
        let conv =
            with_int(node("ConvInteger", &["x", "w", "x_zero", "w_zero"], &["y"]), "group", groups as i64);
        let mut conv = conv;
        for (name, values) in [("pads", vec![1; 4]), ("strides", vec![2; 2])] {
            conv.attribute.push(opendr_onnx::proto::AttributeProto {
                name: name.to_owned(),
                ints: values,
                ..Default::default()
            });
        }
        let model = graph(
            &[conv],
            &[value("x", DataType::Uint8, &[1, all as i64, 5, 5]), value("x_zero", DataType::Uint8, &[])],
            &[value("y", DataType::Int32, &[1, made as i64, 3, 3])],
            &[
                bytes("w", &[made as i64, channels as i64, 3, 3], DataType::Uint8, &w),
                bytes("w_zero", &[], DataType::Uint8, &[120]),
            ],
        );
        let data = [(&[1, all, 5, 5][..], Data::U8(&x)), (&[], Data::U8(&[7]))];
        assert_eq!(
            run(&mut open(model).unwrap(), &data).unwrap(),
            [(vec![1, made, 3, 3], wanted)],
            "{groups}"
        );
    }
}

#[test]
fn a_dynamically_quantised_layer_is_near_the_layer() {
    // What ONNX Runtime's `quantize_dynamic` makes of a product with weights [[0.5, -1], [0.25, 1]].
    let model = graph(
        &[
            node("DynamicQuantizeLinear", &["x"], &["q", "scale", "zero"]),
            node("MatMulInteger", &["q", "w", "zero", "w_zero"], &["sums"]),
            node("Cast", &["sums"], &["floats"]),
            node("Mul", &["scale", "w_scale"], &["both"]),
            node("Mul", &["floats", "both"], &["y"]),
        ],
        &[value("x", F32, &[1, 2])],
        &[value("y", F32, &[1, 2])],
        &[
            bytes("w", &[2, 2], DataType::Int8, &[64, 128, 32, 127]),
            bytes("w_zero", &[], DataType::Int8, &[0]),
            crate::graphs::floats("w_scale", &[], &[1.0 / 128.0]),
        ],
    );
    let mut model = model;
    model.node[2] = with_int(model.node[2].clone(), "to", 1);
    let mut executor = open(model).unwrap();
    for x in [[1.0_f32, 2.0], [-3.0, 0.5], [0.0, 0.0]] {
        let y = run(&mut executor, &[(&[1, 2], Data::F32(&x))]).unwrap();
        let wanted = [0.5 * x[0] + 0.25 * x[1], x[1] - x[0]];
        for (y, wanted) in y[0].1.iter().zip(wanted) {
            assert!((y - f64::from(wanted)).abs() < 0.05, "{y} {wanted}");
        }
    }
}
