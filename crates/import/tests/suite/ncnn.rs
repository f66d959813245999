//! ncnn models compute what their layers define; damaged ones cause an error with a precise message.

use crate::tiny::run;
use opendr_engine::ErrorKind;
use opendr_import::{ImportOptions, onnx_from_ncnn};

/// Layers and weights of a small model: a convolution in half precision, depthwise and dense layers that gate it, a
/// reshape.
fn model() -> (String, Vec<u8>) {
    let text = "7767517\n\
        8 9\n\
        Input            in    0 1 in 0=3 1=2 2=2\n\
        Convolution      conv  1 1 in a 0=2 1=1 5=1 6=4 9=2 -23310=1,0.5\n\
        Split            two   1 2 a a1 a2\n\
        Pooling          mean  1 1 a1 b 0=1 4=1\n\
        InnerProduct     fc    1 1 b c 0=2 2=4 9=1\n\
        BinaryOp         gate  2 1 a2 c d 0=2\n\
        ConvolutionDepthWise dw 1 1 d e 0=2 1=3 11=1 3=1 4=1 14=0 6=6 7=2 9=3 -23310=2,-1.0,4.0\n\
        Reshape          flat  1 1 e out 0=-1 1=2\n";
    let mut bin = Vec::new();
    let floats =
        |bin: &mut Vec<u8>, values: &[f32]| values.iter().for_each(|value| bin.extend(value.to_le_bytes()));
    // 1, -1, 2, 0.5 in half precision, and the bias.
    bin.extend(0x0130_6B47_u32.to_le_bytes());
    bin.extend([0x3c00_u16, 0xbc00, 0x4000, 0x3800].iter().flat_map(|half| half.to_le_bytes()));
    floats(&mut bin, &[0.5, -1.0]);
    bin.extend([0; 4]);
    floats(&mut bin, &[1.0, 0.0, 0.5, -1.0]);
    bin.extend(0x0002_C056_u32.to_le_bytes());
    floats(&mut bin, &[0.0, 1.0, 0.0, 1.0, 0.0, 1.0]);
    (text.to_owned(), bin)
}

fn import(text: &str, bin: &[u8]) -> opendr_engine::Result<Vec<u8>> {
    onnx_from_ncnn(text.as_bytes(), bin, &ImportOptions::default())
}

/// The model's expected output for an image of two channels.
fn wanted(x: &[f32; 12]) -> Vec<f32> {
    let leaky = |value: f32| if value < 0.0 { 0.5 * value } else { value };
    let a: Vec<Vec<f32>> = [([1.0, -1.0], 0.5), ([2.0, 0.5], -1.0)]
        .map(|(w, bias)| (0..6).map(|at| leaky(w[0] * x[at] + w[1] * x[6 + at] + bias)).collect())
        .to_vec();
    let mean: Vec<f32> = a.iter().map(|channel| channel.iter().sum::<f32>() / 6.0).collect();
    let gates = [mean[0].max(0.0), (0.5 * mean[0] - mean[1]).max(0.0)];
    let d = |channel: usize, row: usize, column: i64| match usize::try_from(column) {
        Ok(column) if column < 3 => a[channel][row * 3 + column] * gates[channel],
        _ => 0.0,
    };
    let mut answer = Vec::new();
    for channel in 0..2 {
        for at in 0..6 {
            let (row, column) = (at / 3, (at % 3) as i64);
            let value = match channel {
                0 => d(0, row, column),
                _ => d(1, row, column - 1) + d(1, row, column + 1),
            };
            answer.push(value.clamp(-1.0, 4.0));
        }
    }
    answer
}

#[test]
fn layers_compute_the_reference() {
    let (text, bin) = model();
    let x = [1.0, 2.0, -1.0, 0.5, 3.0, 0.0, -1.0, 0.5, 1.5, 1.0, 0.25, 0.75];
    let onnx = import(&text, &bin).unwrap();
    assert_eq!(onnx, import(&text, &bin).unwrap(), "the same bytes");
    // The runner expects channels last.
    let pixels: Vec<f32> = (0..12).map(|at| x[at % 2 * 6 + at / 2]).collect();
    run(onnx, &[1, 2, 3, 2], &pixels)[0].assert_near(&[1, 2, 6], &wanted(&x));
}

#[test]
fn unread_tensors_are_outputs_and_selectable() {
    let text = "7767517\n3 4\nInput in 0 1 in 0=4 1=1 2=1\nSplit s 1 2 in a b\nUnaryOp u 1 1 a c 0=7\n";
    run(import(text, &[]).unwrap(), &[1, 1, 4, 1], &[0.0; 4])[1].assert_near(&[1, 1, 1, 4], &[1.0; 4]);
    let options = ImportOptions { outputs: vec!["c".into()], ..ImportOptions::default() };
    let onnx = onnx_from_ncnn(text.as_bytes(), &[], &options).unwrap();
    assert_eq!(run(onnx, &[1, 1, 4, 1], &[0.0; 4]).len(), 1);
    let options = ImportOptions { outputs: vec!["d".into()], ..ImportOptions::default() };
    let error = onnx_from_ncnn(text.as_bytes(), &[], &options).unwrap_err();
    assert!(error.kind() == ErrorKind::NotFound && error.to_string().contains("it has b, c"), "{error}");
}

#[test]
fn errors_name_the_cause() {
    let (text, bin) = model();
    let with = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        import(&text.replacen(from, to, 1), &bin).unwrap_err()
    };
    let cases = [
        ("0=2 1=1 5=1 6=4", "0=2 1=1 5=1 6=5", "5 weights for 2 filters"),
        ("0=2 1=1 5=1 6=4", "0=2 1=1 5=1 6=268435456", "channels"),
        ("0=2 1=1 5=1 6=4", "0=2 1=99999 5=1 6=4", "window"),
        ("0=2 1=1 5=1 6=4", "0=0 1=1 5=1 6=4", "0 filters"),
        ("7=2", "7=0", "groups"),
        ("7=2", "7=3", "groups"),
        ("1 1 in a", "1 1 nowhere a", "no preceding layer produces \"nowhere\""),
        ("1 1 b c", "1 1 b in", "two layers produce \"in\""),
        ("Pooling ", "Polling ", "layer mean (Polling)"),
        ("0=2 2=4 9=1", "0=2 2=6 9=1", "3 columns"),
        ("0=2 2=4 9=1", "0=2 2=4 9=1 8=1", "8 bits"),
        ("1 1 e out 0=-1 1=2", "1 1 e out 0=-5 1=2", "shape"),
        ("1 1 e out 0=-1 1=2", "1 1 e out", "shape"),
        (
            "ConvolutionDepthWise dw 1 1 d e 0=2 1=3",
            "ConvolutionDepthWise dw 1 1 b e 0=2 1=3",
            "needs an image",
        ),
    ];
    for (from, to, part) in cases {
        let error = with(from, to).to_string();
        assert!(error.contains(part), "{to}: {error}");
    }
    assert!(import(&text, &bin[..bin.len() - 1]).unwrap_err().to_string().contains("the weights end"));
    assert!(import(&text, &[&bin[..], &[0; 4]].concat()).unwrap_err().to_string().contains("no layer reads"));
    assert!(onnx_from_ncnn(&[0xff, 0xfe], &bin, &ImportOptions::default()).is_err());
    assert!(import("7767517\n1 1\nInput in 0 1 in\n", &[]).unwrap_err().to_string().contains("no outputs"));
}

#[test]
fn no_damage_panics() {
    let (text, bin) = model();
    for end in 0..text.len() {
        import(&text[..end], &bin).ok();
    }
    for end in (0..bin.len()).step_by(3) {
        import(&text, &bin[..end]).ok();
    }
    for at in 0..text.len() {
        for byte in [b' ', b'-', b'9', b'=', b'\n'] {
            let mut damaged = text.clone().into_bytes();
            damaged[at] = byte;
            onnx_from_ncnn(&damaged, &bin, &ImportOptions::default()).ok();
        }
    }
}
