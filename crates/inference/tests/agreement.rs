//! Both runtimes give the same outputs for every model of the test data, on real pictures.

#![allow(clippy::unwrap_used, clippy::expect_used, clippy::panic)]

mod pictures;

use std::path::{Path, PathBuf};

use opendr_engine::Device;
use opendr_inference::{
    Builtin, ElementType, OnnxRuntime, Runtime, Session, TensorData, TensorInfo, TensorView,
};
use pictures::{Scale, photos, tensor_from_picture, test_data};

/// How the outputs of two runtimes are held against each other.
#[derive(Clone, Copy)]
enum Agreement {
    /// Every float within 1e-4 of the output's largest magnitude.
    Close,
    /// As `Close`; the output with this name within 3e-4.
    CloseBut(&'static str),
    /// As `Close`; the rows of the output with this name were picked by TopK and are matched with each other.
    Ranked { output: &'static str, score: usize },
    /// Labels (the elements of an integer output, or the largest of a row) are the same for 99 %.
    Labels,
}

use Agreement::{Close, CloseBut, Labels, Ranked};

/// Every model of the test data, the values it wants, and how its outputs have to agree.
const MODELS: [(&str, Scale, Agreement); 26] = [
    ("classification/mobilenet_v2_1.0_224_qdq.onnx", Scale::Raw, Labels),
    ("classification/resnet8_cifar10.onnx", Scale::Raw, Close),
    ("classification/vww_person_96.onnx", Scale::Unit, Close),
    ("face_detection/blazeface_short_128.onnx", Scale::Signed, Close),
    ("face_detection/ultraface_rfb_320.onnx", Scale::Signed, Close),
    ("face_detection/yunet_n_320_320.onnx", Scale::Raw, Close),
    ("face_detection/yunet_n_640_640.onnx", Scale::Raw, Close),
    ("face_detection/yunet_n_dynamic.onnx", Scale::Raw, Close),
    ("face_recognition/mobileface_112_256d.onnx", Scale::Raw, Close),
    ("facial_expression/emotion_7cls_gray64.onnx", Scale::Signed, Close),
    ("facial_landmarks/face_mesh_468_192.onnx", Scale::Unit, Close),
    ("facial_landmarks/iris_64.onnx", Scale::Unit, Close),
    ("grasp/grconvnet3_cornell_rgbd_ch16_224.onnx", Scale::Centred, Close),
    ("hand/hand_landmark_lite_224.onnx", Scale::Unit, Close),
    ("hand/palm_detection_lite_192.onnx", Scale::Unit, Close),
    ("instance_segmentation/bodypix_mnv1_050_s16.onnx", Scale::Signed, Close),
    (
        "object_detection_2d/mb3_centernet_coco_512.onnx",
        Scale::Raw,
        Ranked { output: "tower_0/detections", score: 4 },
    ),
    ("object_detection_2d/nanodet_coco_416.onnx", Scale::ImageNet, Close),
    ("person_reid/osnet_x0_25_msmt17.onnx", Scale::ImageNet, Close),
    ("pose/blazepose_landmark_full_256.onnx", Scale::Unit, CloseBut("Identity_2")),
    ("pose/movenet_lightning_192.onnx", Scale::Raw, Close),
    ("pose/movenet_multipose_dyn.onnx", Scale::Raw, Ranked { output: "output_0", score: 55 }),
    ("pose/posenet_mnv1_385.onnx", Scale::Signed, Close),
    ("semantic_segmentation/deeplab_edgetpu_slim_cityscapes_513_qdq.onnx", Scale::Raw, Labels),
    ("semantic_segmentation/deeplabv3_mnv2_pascal_513_qdq.onnx", Scale::Raw, Labels),
    ("speech_commands/kws_dscnn_12.onnx", Scale::Raw, Labels),
];

/// An output, kept.
struct Output {
    info: TensorInfo,
    shape: Vec<usize>,
    values: Vec<f64>,
}

fn run(session: &Session, inputs: &[TensorView<'_>]) -> Vec<Output> {
    let mut kept = Vec::new();
    session
        .run(inputs, |outputs| {
            kept = outputs
                .iter()
                .zip(session.outputs())
                .map(|(output, info)| Output {
                    info: info.clone(),
                    shape: output.shape().to_vec(),
                    values: numbers(output),
                })
                .collect();
            Ok(())
        })
        .unwrap();
    kept
}

fn numbers(tensor: &TensorView<'_>) -> Vec<f64> {
    match tensor.data() {
        TensorData::F32(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::I64(data) => data.iter().map(|&value| value as f64).collect(),
        TensorData::U8(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::I8(data) => data.iter().map(|&value| f64::from(value)).collect(),
        other => panic!("no model of the test data gives {}", other.element_type()),
    }
}

/// The largest difference, as a share of the largest magnitude.
fn difference(a: &[f64], b: &[f64]) -> f64 {
    let largest = a.iter().fold(0.0_f64, |largest, value| largest.max(value.abs()));
    let apart = a.iter().zip(b).fold(0.0_f64, |apart, (a, b)| apart.max((a - b).abs()));
    assert!(apart.is_finite() && largest.is_finite());
    if apart == 0.0 { 0.0 } else { apart / largest }
}

fn print_difference(name: &str, output: &Output, difference: f64) {
    println!("  {name} {}{:?} {difference:.1e}", output.info.name, output.shape);
}

#[test]
fn measure() {
    let Some(root) = test_data() else { return };
    let onnx_runtime =
        OnnxRuntime::find().expect("set ORT_DYLIB_PATH to the library of ONNX Runtime 1.23 or later");
    for (file, scale, _) in MODELS {
        let bytes = std::fs::read(root.join("models").join(file)).unwrap();
        let a = Session::open_with(&*onnx_runtime, &bytes, Device::Cpu).unwrap();
        let b = Session::open_with(&Builtin, &bytes, Device::Cpu).unwrap();
        for picture in photos(&root) {
            let [input] = a.inputs() else { panic!("one input") };
            let tensor = tensor_from_picture(&picture.pixels, input, scale);
            let (a, b) = (run(&a, &[tensor.view()]), run(&b, &[tensor.view()]));
            for (a, b) in a.iter().zip(&b) {
                assert_eq!(a.info.name, b.info.name);
                assert_eq!(a.shape, b.shape);
                print_difference(file, a, difference(&a.values, &b.values));
            }
        }
    }
}
