//! Convolutions of large images by fewer products, with what is fused into them, beside their definition.

use opendr_executor::{Data, Executor};
use opendr_kernels::Compute;

use crate::graphs::{F32, bytes, floats, graph, node, run, value, with_int};

/// Height and width: more than 2048 pixels, the last tiles of four not whole.
const SIZE: [usize; 2] = [46, 47];
const CHANNELS: usize = 16;
const OUTPUTS: usize = 20;

fn numbers(count: usize, factor: usize) -> Vec<f32> {
    (0..count).map(|i| (i * factor % 101) as f32 / 50.0 - 1.0).collect()
}

/// Returns the sums of 3x3 taps, padded with a zero on each side.
fn by_definition(x: &[f32], weights: &[f32], bias: &[f32]) -> Vec<f64> {
    let [height, width] = SIZE;
    let at = |channel: usize, row: usize, column: usize| {
        let inside = (1..=height).contains(&row) && (1..=width).contains(&column);
        if inside { f64::from(x[(channel * height + row - 1) * width + column - 1]) } else { 0.0 }
    };
    let mut y = Vec::new();
    for output in 0..OUTPUTS {
        for row in 0..height {
            for column in 0..width {
                let taps = (0..9 * CHANNELS).map(|i| {
                    let (channel, tap) = (i / 9, i % 9);
                    f64::from(weights[output * 9 * CHANNELS + i])
                        * at(channel, row + tap / 3, column + tap % 3)
                });
                y.push(f64::from(bias[output]) + taps.sum::<f64>());
            }
        }
    }
    y
}

#[test]
fn large_images_of_3x3_taps_equal_their_sums_with_what_is_fused() {
    let [height, width] = SIZE;
    let x = numbers(CHANNELS * height * width, 37);
    let weights = numbers(OUTPUTS * CHANNELS * 9, 53);
    let bias = numbers(OUTPUTS, 29);
    let dims = |channels: usize| [1, channels as i64, height as i64, width as i64];
    let conv = |x: &str, y: &str| {
        let mut conv = node("Conv", &[x, "weights", "bias"], &[y]);
        let pads = opendr_onnx::proto::AttributeProto {
            name: "pads".to_owned(),
            ints: vec![1; 4],
            ..Default::default()
        };
        conv.attribute.push(pads);
        conv
    };
    let nodes = [
        node("Sigmoid", &["x"], &["input"]),
        conv("input", "sums"),
        node("Add", &["sums", "one"], &["more"]),
        node("Relu", &["more"], &["positive"]),
        // A residual before the activation function, and parts of a concatenation that are written in place.
        conv("input", "again"),
        node("Add", &["again", "positive"], &["both"]),
        node("Relu", &["both"], &["last"]),
        conv("input", "third"),
        with_int(node("Concat", &["third", "last"], &["y"]), "axis", 1),
    ];
    let constants = [
        floats("weights", &[OUTPUTS as i64, CHANNELS as i64, 3, 3], &weights),
        floats("bias", &[OUTPUTS as i64], &bias),
        floats("one", &[1], &[1.0]),
    ];
    let inputs = [value("x", F32, &dims(CHANNELS))];
    let bytes = bytes(graph(&nodes, &inputs, &[value("y", F32, &dims(2 * OUTPUTS))], &constants));
    let input: Vec<f32> = x.iter().map(|&x| 1.0 / (1.0 + (-x).exp())).collect();
    let sums = by_definition(&input, &weights, &bias);
    let last = sums.iter().map(|&sum| (sum + (sum + 1.0).max(0.0)).max(0.0));
    let wanted: Vec<f64> = sums.iter().copied().chain(last).collect();
    let largest = wanted.iter().fold(0.0, |largest: f64, value| largest.max(value.abs()));
    for threads in [1, 2] {
        let mut executor = Executor::open(&bytes, Compute::with_threads(threads)).unwrap();
        let outputs = run(&mut executor, &[(&[1, CHANNELS, height, width], Data::F32(&x))]).unwrap();
        assert_eq!(outputs[0].0, [1, 2 * OUTPUTS, height, width]);
        for (i, (got, wanted)) in outputs[0].1.iter().zip(&wanted).enumerate() {
            assert!((got - wanted).abs() < 1e-5 * largest, "{i}: {got} in place of {wanted}");
        }
    }
}
