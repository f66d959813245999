//! Agreement of both runtimes on every model of the test data, with real images.

use std::path::{Path, PathBuf};

use crate::pictures::{Scale, read, tensor_from_picture};
use crate::test_data::test_data;
use opendr_engine::Device;
use opendr_inference::{Builtin, ElementType, OnnxRuntime, Session, TensorData, TensorInfo, TensorView};

/// Maximum difference between two runtimes, as a share of an output's largest magnitude.
const TOLERANCE: f64 = 1e-4;

/// Criterion for the agreement of outputs.
#[derive(Clone, Copy)]
enum Agreement {
    /// Every float within [`TOLERANCE`].
    Close,
    /// As `Close`, except for a mask of logits up to 1,900 from an ill-conditioned graph, for which ONNX Runtime with
    /// graph optimisations on and off differs by 1.1e-3 on these images: within 3e-4 where the output `presence` is
    /// positive, within 2e-3 elsewhere.
    Mask { mask: &'static str, presence: &'static str },
    /// As `Close`; the rows of one output were selected by TopK on their column `score` and are matched with each
    /// other.
    Ranked { output: &'static str, score: usize },
    /// Labels (the elements of an integer output, or the argmax of a row) agree for 99 % on these images.
    ///
    /// In fifty quantised layers, a rounding tie in the first one, one value in a million, makes a third of the
    /// values of the last one differ. Where a segmentation network recognises nothing, its labels depend on that:
    /// ONNX Runtime with graph optimisations on and off then differs from itself as much as from the built-in runtime
    /// (Cityscapes on a cup of coffee: 12 % of the labels). The limit of 99 % holds for images of the training
    /// domain.
    Labels(&'static [&'static str]),
    /// As `Labels`, for 98 %: a network for which ONNX Runtime with graph optimisations on and off gives different
    /// labels to 0.7 % on the images with the least difference (to 1.8 % of [`PHOTOS`], to 3.4 % of the cat).
    RoundedLabels(&'static [&'static str]),
}

use Agreement::{Close, Labels, Mask, Ranked, RoundedLabels};

const PHOTOS: [&str; 8] = [
    "data/photos/astronaut.png",
    "data/photos/bus.jpg",
    "data/photos/chelsea.png",
    "data/photos/coffee.png",
    "data/photos/motorcycle_left.png",
    "data/photos/motorcycle_right.png",
    "data/photos/t1.jpg",
    "data/photos/zidane.jpg",
];

const STREET: [&str; 1] = ["models/semantic_segmentation/sample/cityscapes_segmentation.bmp"];

const PERSONS: [&str; 1] = ["data/photos/zidane.jpg"];

/// A bird, persons, a bus, a cat, motorcycles.
const PASCAL: [&str; 8] = [
    "models/semantic_segmentation/sample/bird_segmentation.bmp",
    "data/photos/astronaut.png",
    "data/photos/bus.jpg",
    "data/photos/chelsea.png",
    "data/photos/motorcycle_left.png",
    "data/photos/motorcycle_right.png",
    "data/photos/t1.jpg",
    "data/photos/zidane.jpg",
];

/// Every model of the test data, its input scale, and the criterion for its outputs.
const MODELS: [(&str, Scale, Agreement); 34] = [
    ("classification/mobilenet_v2_1.0_224_qdq.onnx", Scale::Raw, Labels(&PHOTOS)),
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
    ("found/FastestDet.onnx", Scale::Unit, Close),
    ("found/ch_ppocr_mobile_v2.0_cls_infer.onnx", Scale::Signed, Close),
    ("found/deeplabv3_mnv2_ade20k_uint8.onnx", Scale::Raw, RoundedLabels(&PERSONS)),
    ("found/en_PP-OCRv3_det_infer.onnx", Scale::ImageNet, Close),
    ("found/en_number_mobile_v2.0_rec_infer.onnx", Scale::Signed, Close),
    ("found/person-reidentification-retail-0288.onnx", Scale::Raw, Close),
    ("found/road_segmentation_adas_0001.onnx", Scale::Raw, Close),
    ("found/yolox_nano.onnx", Scale::Raw, Close),
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
    (
        "pose/blazepose_landmark_full_256.onnx",
        Scale::Unit,
        Mask { mask: "Identity_2", presence: "Identity_1" },
    ),
    ("pose/movenet_lightning_192.onnx", Scale::Raw, Close),
    ("pose/movenet_multipose_dyn.onnx", Scale::Raw, Ranked { output: "output_0", score: 55 }),
    ("pose/posenet_mnv1_385.onnx", Scale::Signed, Close),
    ("semantic_segmentation/deeplab_edgetpu_slim_cityscapes_513_qdq.onnx", Scale::Raw, Labels(&STREET)),
    ("semantic_segmentation/deeplabv3_mnv2_pascal_513_qdq.onnx", Scale::Raw, Labels(&PASCAL)),
    ("speech_commands/kws_dscnn_12.onnx", Scale::Raw, Labels(&PHOTOS)),
];

/// One output for one image.
struct Output {
    shape: Vec<usize>,
    values: Vec<f64>,
}

/// One output of both runtimes for all images.
struct Compared {
    info: TensorInfo,
    pairs: Vec<(Output, Output)>,
}

impl Compared {
    /// Returns the largest magnitude over all images; in a single image a probability can be small everywhere, below
    /// the precision of a float.
    fn magnitude(&self) -> f64 {
        self.pairs
            .iter()
            .flat_map(|(a, _)| &a.values)
            .fold(0.0_f64, |largest, value| largest.max(value.abs()))
    }

    /// Returns the largest difference in one image, as a share of the largest magnitude.
    fn difference(&self, picture: usize) -> f64 {
        let (a, b) = &self.pairs[picture];
        let apart = a.values.iter().zip(&b.values).map(|(a, b)| (a - b).abs()).fold(0.0_f64, nan_max);
        apart / self.magnitude().max(f64::MIN_POSITIVE)
    }

    /// Returns `difference` with matched rows, each column relative to its own magnitude.
    fn ranked_difference(&self, picture: usize, score: usize) -> f64 {
        let (a, b) = &self.pairs[picture];
        let columns = *a.shape.last().unwrap();
        let mut magnitudes = vec![f64::MIN_POSITIVE; columns];
        for row in self.pairs.iter().flat_map(|(a, _)| a.values.chunks(columns)) {
            magnitudes
                .iter_mut()
                .zip(row)
                .for_each(|(magnitude, value)| *magnitude = magnitude.max(value.abs()));
        }
        let scaled = |output: &Output| -> Vec<Vec<f64>> {
            let rows = output.values.chunks(columns);
            rows.map(|row| row.iter().zip(&magnitudes).map(|(value, magnitude)| value / magnitude).collect())
                .collect()
        };
        matched_difference(&scaled(a), &scaled(b), score)
    }

    /// Returns the share of labels that differ over all images.
    fn label_difference(&self) -> f64 {
        let labels = |output: &Output| -> Vec<usize> {
            match self.info.element_type {
                ElementType::I32 | ElementType::I64 => {
                    output.values.iter().map(|&label| label as usize).collect()
                }
                _ => output.values.chunks(*output.shape.last().unwrap()).map(position_of_largest).collect(),
            }
        };
        let (a, b): (Vec<_>, Vec<_>) = self.pairs.iter().map(|(a, b)| (labels(a), labels(b))).unzip();
        let (a, b) = (a.concat(), b.concat());
        a.iter().zip(&b).filter(|(a, b)| a != b).count() as f64 / a.len() as f64
    }
}

fn nan_max(a: f64, b: f64) -> f64 {
    if b.is_nan() { f64::INFINITY } else { a.max(b) }
}

fn position_of_largest(row: &[f64]) -> usize {
    (0..row.len()).max_by(|&a, &b| row[a].total_cmp(&row[b]).then(b.cmp(&a))).unwrap()
}

/// Matches each row of `a` with the nearest unmatched row of `b`. A row with the lowest score may be missing: TopK
/// may select another one of equal score.
fn matched_difference(a: &[Vec<f64>], b: &[Vec<f64>], score: usize) -> f64 {
    let cut = a.iter().map(|row| row[score]).fold(f64::INFINITY, f64::min);
    let mut left: Vec<_> = b.iter().collect();
    let mut largest = 0.0_f64;
    for row in a {
        let apart = |other: &[f64]| row.iter().zip(other).map(|(a, b)| (a - b).abs()).fold(0.0_f64, nan_max);
        let nearest = (0..left.len()).min_by(|&i, &j| apart(left[i]).total_cmp(&apart(left[j]))).unwrap();
        let difference = apart(left.swap_remove(nearest));
        if difference <= TOLERANCE || row[score] > cut + TOLERANCE {
            largest = largest.max(difference);
        }
    }
    largest
}

fn run(session: &Session, inputs: &[TensorView<'_>]) -> Vec<Output> {
    let mut kept = Vec::new();
    session
        .run(inputs, |outputs| {
            kept.extend(
                outputs
                    .iter()
                    .map(|output| Output { shape: output.shape().to_vec(), values: numbers(output) }),
            );
            Ok(())
        })
        .unwrap();
    kept
}

fn numbers(tensor: &TensorView<'_>) -> Vec<f64> {
    match tensor.data() {
        TensorData::F32(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::I32(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::I64(data) => data.iter().map(|&value| value as f64).collect(),
        TensorData::U8(data) => data.iter().map(|&value| f64::from(value)).collect(),
        TensorData::I8(data) => data.iter().map(|&value| f64::from(value)).collect(),
        other => panic!("no model of the test data gives {}", other.element_type()),
    }
}

/// Runs a model on all images with both runtimes.
fn compare(
    onnx_runtime: &OnnxRuntime,
    model: &[u8],
    scale: Scale,
    pictures: &[image::RgbImage],
) -> Vec<Compared> {
    let ours = Session::open_with(&Builtin, model, Device::Cpu).unwrap();
    let theirs = Session::open_with(onnx_runtime, model, Device::Cpu).unwrap();
    let names = |infos: &[TensorInfo]| -> Vec<_> {
        infos.iter().map(|info| (info.name.clone(), info.element_type)).collect()
    };
    assert_eq!(ours.inputs(), theirs.inputs());
    assert_eq!(names(ours.outputs()), names(theirs.outputs()));
    let mut compared: Vec<_> =
        theirs.outputs().iter().map(|info| Compared { info: info.clone(), pairs: Vec::new() }).collect();
    for picture in pictures {
        let input = tensor_from_picture(picture, &ours.inputs()[0], scale);
        let (a, b) = (run(&theirs, &[input.view()]), run(&ours, &[input.view()]));
        for ((compared, a), b) in compared.iter_mut().zip(a).zip(b) {
            assert_eq!(a.shape, b.shape, "{}", compared.info);
            compared.pairs.push((a, b));
        }
    }
    compared
}

/// Returns one line per excessive difference; every figure is printed.
fn disagreements(file: &str, agreement: Agreement, outputs: &[Compared]) -> Vec<String> {
    let mut lines = Vec::new();
    let mut judge = |output: &Compared, difference: f64, tolerance: f64| {
        let line = format!("{file} {}: {difference:.1e} of {tolerance:.0e}", output.info.name);
        println!("{line}");
        if difference > tolerance {
            lines.push(line);
        }
    };
    for output in outputs {
        let pictures = 0..output.pairs.len();
        let name = output.info.name.as_str();
        match agreement {
            Labels(_) => judge(output, output.label_difference(), 0.01),
            RoundedLabels(_) => judge(output, output.label_difference(), 0.02),
            Ranked { output: ranked, score } if ranked == name => {
                judge(
                    output,
                    pictures.map(|i| output.ranked_difference(i, score)).fold(0.0, nan_max),
                    TOLERANCE,
                );
            }
            Mask { mask, presence } if mask == name => {
                let presence = outputs.iter().find(|output| output.info.name == presence).unwrap();
                for picture in pictures {
                    let present = presence.pairs[picture].0.values[0] > 0.5;
                    judge(output, output.difference(picture), if present { 3e-4 } else { 2e-3 });
                }
            }
            Close | Ranked { .. } | Mask { .. } => {
                judge(output, pictures.map(|i| output.difference(i)).fold(0.0, nan_max), TOLERANCE);
            }
        }
    }
    lines
}

/// The ONNX files below `folder`, relative to it.
fn models_in(folder: &Path) -> Vec<String> {
    let subfolders =
        std::fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).filter(|path| path.is_dir());
    let files =
        subfolders.flat_map(|path| std::fs::read_dir(path).unwrap()).map(|entry| entry.unwrap().path());
    let mut models: Vec<_> = files
        .filter(|path: &PathBuf| path.extension().is_some_and(|extension| extension == "onnx"))
        .map(|path| path.strip_prefix(folder).unwrap().to_str().unwrap().replace('\\', "/"))
        .collect();
    models.sort();
    models
}

#[test]
fn both_runtimes_agree_on_every_model() {
    let Some(root) = test_data() else { return };
    let onnx_runtime =
        OnnxRuntime::find().expect("set ORT_DYLIB_PATH to the library of ONNX Runtime 1.23 or later");
    assert_eq!(models_in(&root.join("models")), MODELS.map(|(file, ..)| file), "one row for each model");
    let mut wrong = Vec::new();
    for (file, scale, agreement) in MODELS {
        let pictures: &[&str] = match agreement {
            Labels(pictures) | RoundedLabels(pictures) => pictures,
            _ => &PHOTOS,
        };
        let pictures: Vec<_> = pictures.iter().map(|picture| read(&root.join(picture))).collect();
        let model = std::fs::read(root.join("models").join(file)).unwrap();
        let outputs = compare(&onnx_runtime, &model, scale, &pictures);
        wrong.extend(disagreements(file, agreement, &outputs));
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn matching_takes_another_order_and_another_last_row_but_no_other_row() {
    let rows = |scores: [f64; 4]| scores.map(|score| vec![score, 10.0 * score]).to_vec();
    let a = rows([0.9, 0.5, 0.50001, 0.3]);
    assert!(matched_difference(&a, &rows([0.9, 0.50001, 0.5, 0.3]), 0) <= TOLERANCE);
    assert!(matched_difference(&a, &rows([0.9, 0.5, 0.50001, 0.31]), 0) <= TOLERANCE);
    assert!(matched_difference(&a, &rows([0.9, 0.51, 0.50001, 0.3]), 0) > TOLERANCE);
    assert!(matched_difference(&a, &rows([0.9, f64::NAN, 0.50001, 0.3]), 0) > TOLERANCE);
}
