//! Detectors that other packages exported, beside the packages' own post-processing.
//!
//! `tests/extended/exported_network_fixtures.py` writes the fixtures: small networks with random weights.

#![allow(clippy::unwrap_used, clippy::panic)]

use std::path::{Path, PathBuf};

use opendr_detection::object_detection_2d::{
    ImportedDetector, ImportedDetectorParams, OutputLayout, Yolox, YoloxParams,
};
use opendr_engine::data::{Image, PixelFormat};
use opendr_engine::learner::Handle;
use opendr_engine::target::{BoundingBox, Name, Rle, Segmentation};
use opendr_engine::{Device, ErrorKind};
use opendr_perception_testing::fixture_image::fixture_image;
use opendr_perception_testing::learner_checks::check_trained_learner;
use opendr_perception_testing::test_models::{container, test_data};

/// Largest difference of an edge in pixels, or of a score.
const TOLERANCE: f32 = 1e-3;

fn fixture(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/imported").join(name)
}

fn row(found: &BoundingBox) -> [f32; 6] {
    let [left, top, right, bottom] = found.corners();
    let Name::Index(class) = found.name else { panic!("{found:?}") };
    [left, top, right, bottom, found.confidence, class as f32]
}

fn json(name: &str) -> serde_json::Value {
    serde_json::from_slice(&std::fs::read(fixture(&format!("{name}.json"))).unwrap()).unwrap()
}

fn number(value: &serde_json::Value) -> f32 {
    value.as_f64().unwrap() as f32
}

/// Compares the detections of a fixture with those of its package.
fn compare(name: &str, layout: OutputLayout, classes: &[&str]) {
    let expected = json(name);
    let params = ImportedDetectorParams {
        threshold: number(&expected["threshold"]),
        iou_threshold: number(&expected["iou_threshold"]),
        ..ImportedDetectorParams::default()
    };
    let mut detector = Handle::<ImportedDetector>::new(params, Device::Cpu).unwrap();
    detector.load(fixture(&format!("{name}.zip"))).unwrap();
    assert_eq!(detector.params().layout, layout, "{name}");
    assert_eq!(detector.classes().iter().collect::<Vec<_>>(), classes, "{name}");
    let [width, height] = [0, 1].map(|side| expected["image"][side].as_u64().unwrap() as usize);
    let found = detector.infer(&fixture_image(width, height)).unwrap().boxes;
    assert_same(name, &found, &expected["detections"]);
    if let Some(polygons) = expected["polygons"].as_array() {
        return assert_polygons(name, &found, &expected["detections"], polygons);
    }
    let Some(masks) = expected["masks"].as_array() else {
        assert!(found.iter().all(|found| found.segment.is_none()), "{name}");
        return;
    };
    let rows: Vec<[f32; 6]> = expected["detections"].as_array().unwrap().iter().map(row_of).collect();
    let (mut pixels, mut differ) = (0, 0);
    for found in &found {
        let Some(Segmentation::Rle(mask)) = found.segment.as_ref().map(|segment| &segment.segmentation)
        else {
            panic!("{name}: {found:?} has no mask")
        };
        let at = rows.iter().position(|wanted| is_close(&row(found), wanted)).unwrap();
        let counts = masks[at].as_array().unwrap().iter().map(|count| count.as_u64().unwrap() as u32);
        let wanted = Rle::new(height as u32, width as u32, counts.collect()).unwrap();
        let pairs = mask.mask().unwrap().into_iter().zip(wanted.mask().unwrap());
        differ += pairs.filter(|(found, wanted)| found != wanted).count();
        pixels += wanted.area();
    }
    // Logits within rounding of zero.
    assert!(pixels > 100 && differ as f64 <= 1e-3 * pixels as f64, "{name}: {differ} of {pixels} pixels");
}

/// Compares the corners of rotated boxes, in any order that goes round.
fn assert_polygons(
    name: &str,
    found: &[BoundingBox],
    rows: &serde_json::Value,
    polygons: &[serde_json::Value],
) {
    let rows: Vec<[f32; 6]> = rows.as_array().unwrap().iter().map(row_of).collect();
    for found in found {
        let Some(Segmentation::Polygons(of_box)) =
            found.segment.as_ref().map(|segment| &segment.segmentation)
        else {
            panic!("{name}: {found:?} has no polygon")
        };
        let at = rows.iter().position(|wanted| is_close(&row(found), wanted)).unwrap();
        let wanted: Vec<f32> = polygons[at].as_array().unwrap().iter().map(number).collect();
        let corners = of_box[0].as_chunks::<2>().0;
        assert_eq!(corners.len(), 4, "{name}");
        for corner in wanted.as_chunks::<2>().0 {
            let is_same = |own: &[f32; 2]| own.iter().zip(corner).all(|(a, b)| (a - b).abs() <= 1e-2);
            assert!(corners.iter().any(is_same), "{name}: {corner:?} is not one of {corners:?}");
        }
    }
}

fn row_of(row: &serde_json::Value) -> [f32; 6] {
    std::array::from_fn(|index| number(&row[index]))
}

fn is_close(found: &[f32; 6], wanted: &[f32; 6]) -> bool {
    found.iter().zip(wanted).all(|(a, b)| (a - b).abs() <= TOLERANCE)
}

/// Compares boxes with rows of `x0, y0, x1, y1, score, class` in any order.
fn assert_same(name: &str, found: &[BoundingBox], rows: &serde_json::Value) {
    let rows = rows.as_array().unwrap();
    let mut wanted: Vec<[f32; 6]> = rows.iter().map(row_of).collect();
    // Boxes that a package clips to nothing are none.
    wanted.retain(|row| row[2] > row[0] && row[3] > row[1]);
    assert_eq!(found.len(), wanted.len(), "{name}: {found:?} instead of {wanted:?}");
    assert!(!wanted.is_empty(), "{name}");
    for found in found.iter().map(row) {
        // Detections of equal scores have no order.
        let at = wanted.iter().position(|wanted| is_close(&found, wanted));
        wanted.remove(at.unwrap_or_else(|| panic!("{name}: {found:?} is not one of {wanted:?}")));
    }
}

const NAMES: &[&str] = &["ball", "cone", "door"];

#[test]
fn yolo_candidates() {
    for name in ["yolo", "yolo_segment", "yolo_pose"] {
        compare(name, OutputLayout::Candidates, NAMES);
    }
}

#[test]
fn yolo_with_rotated_boxes() {
    compare("yolo_obb", OutputLayout::Candidates, NAMES);
    compare("yolo_obb_end_to_end", OutputLayout::Detections, NAMES);
}

#[test]
fn yolo_end_to_end() {
    compare("yolo_end_to_end", OutputLayout::Detections, NAMES);
}

#[test]
fn yolo_with_suppression() {
    compare("yolo_nms", OutputLayout::Detections, NAMES);
}

#[test]
fn rt_detr_of_ultralytics() {
    compare("rtdetr_ultralytics", OutputLayout::Detections, NAMES);
}

#[test]
fn torchvision() {
    compare("torchvision_retinanet", OutputLayout::Detections, &[]);
}

#[test]
fn detr_of_transformers() {
    compare("detr", OutputLayout::Queries, &[]);
    compare("rt_detr", OutputLayout::Queries, &[]);
}

#[test]
fn yolox_nano() {
    let classes: String = (0..80).map(|class| format!("{class}\n")).collect();
    let Some(model) = container("yolox", "found/yolox_nano.onnx", &classes) else { return };
    let expected = json("yolox_nano");
    let (threshold, iou_threshold) = (number(&expected["threshold"]), number(&expected["iou_threshold"]));
    let params = YoloxParams { threshold, iou_threshold, multi_label: false, ..YoloxParams::default() };
    let mut detector = Handle::<Yolox>::new(params, Device::Cpu).unwrap();
    detector.load(&model).unwrap();
    for (photo, rows) in expected["photos"].as_object().unwrap() {
        let whole = opendr_vision::open(test_data("data/photos").unwrap().join(photo)).unwrap();
        let part = whole.view().crop(0, 0, 416, 416).unwrap();
        let pixels = part.hwc_u8(PixelFormat::Rgb);
        let part = Image::from_rgb8(pixels, part.width(), part.height()).unwrap();
        let found = detector.infer(&part).unwrap().boxes;
        assert_same(photo, &found, rows);
    }
    std::fs::remove_dir_all(model).ok();
}

#[test]
fn it_is_a_learner() {
    let scratch = std::env::temp_dir().join(format!("opendr-imported-{}", std::process::id()));
    let calls =
        [[64, 48], [80, 80], [31, 90]].map(|[width, height]| vec![fixture_image(width, height).into()]);
    check_trained_learner::<ImportedDetector>(&fixture("yolo.zip"), &scratch, calls.into());
    std::fs::remove_dir_all(&scratch).ok();
}

#[test]
fn what_is_not_recognised_names_its_parameter() {
    // Six values without metadata, and fewer rows than the input has cells: queries of two classes, or detections.
    let params =
        ImportedDetectorParams { layout: OutputLayout::Queries, ..ImportedDetectorParams::default() };
    let mut detector = Handle::<ImportedDetector>::new(params, Device::Cpu).unwrap();
    let error = detector.load(fixture("yolo.zip")).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Unsupported);
    let text = format!("{error:#}");
    for word in ["set ", "boxes", "unit", "scores", "resize", "levels", "output0: f32[1, 7, 84]"] {
        assert!(text.contains(word), "{word}: {text}");
    }
}
