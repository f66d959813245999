//! Persons of 40 pixels in a 4K image, with the bundled weights.

use std::env;
use std::path::{Path, PathBuf};

use opendr_engine::data::{Layout, PixelFormat};
use opendr_engine::learner::{Handle, Learner};
use opendr_engine::model::{Manifest, ModelWriter};
use opendr_vision::resize;

use super::*;

fn handle<L: Learner>(name: &str, params: L::Params) -> Handle<L> {
    let weights = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../../models/weights/lightweight_open_pose");
    let folder = env::temp_dir().join(format!(
        "opendr-{name}-{}-{:?}",
        std::process::id(),
        std::thread::current().id()
    ));
    let mut writer = ModelWriter::new(&folder, Manifest::new(name, "openpose_default")).unwrap();
    writer.add("model.onnx", &std::fs::read(weights.join("openpose_default.onnx")).unwrap()).unwrap();
    let mut handle = Handle::new(params, Device::Cpu).unwrap();
    handle.load_model(writer.finish().unwrap()).unwrap();
    std::fs::remove_dir_all(folder).unwrap();
    handle
}

/// Returns a person of 40 pixels, cropped from an image at `[left, top, width, height]`.
fn small_person(path: &Path, [left, top, width, height]: [f32; 4]) -> Image {
    let image = opendr_vision::open(path).unwrap();
    let region =
        Region::from_corners([left, top, left + width, top + height], [image.width(), image.height()]);
    let region = region.grown(0.05, [image.width(), image.height()]);
    let part = image.view().crop(region.x, region.y, region.width, region.height).unwrap();
    let pixels = part.hwc_u8(PixelFormat::Rgb);
    let mut image = Image::from_rgb8(pixels, region.width, region.height).unwrap();
    let scale = 40.0 / height;
    let size = [region.width, region.height].map(|side| (side as f32 * scale).round() as usize);
    // Halving averages four pixels; a larger factor would skip pixels.
    while image.height() > 2 * size[1] {
        image = resize(&image, image.width() / 2, image.height() / 2).unwrap();
    }
    resize(&image, size[0], size[1]).unwrap()
}

/// Returns persons of 40 pixels on a grey 4K canvas, and their regions.
fn canvas(data: &Path) -> (Image, Vec<Region>) {
    let persons = [
        ("000000000785.jpg", [280.79, 44.73, 218.7, 346.68], [2500, 1300]),
        ("000000196141.jpg", [247.76, 74.23, 169.67, 300.78], [333, 411]),
        ("000000197388.jpg", [540.04, 48.81, 99.96, 223.36], [3500, 203]),
    ];
    let [width, height] = [3840, 2160];
    let mut pixels = vec![128; width * height * 3];
    let paste = |(name, place, [x, y]): (&str, [f32; 4], [usize; 2])| {
        let person = small_person(&data.join("mmpose_samples/coco").join(name), place);
        for (row, line) in person.view().hwc_u8(PixelFormat::Rgb).chunks_exact(3 * person.width()).enumerate()
        {
            let start = ((y + row) * width + x) * 3;
            pixels[start..start + line.len()].copy_from_slice(line);
        }
        Region { x, y, width: person.width(), height: person.height() }
    };
    let places = persons.map(paste).to_vec();
    (Image::new(pixels, width, height, PixelFormat::Rgb, Layout::Hwc).unwrap(), places)
}

fn data() -> Option<PathBuf> {
    let shared = env::var_os("OPENDR_TEST_DATA").map(PathBuf::from);
    if shared.is_none() {
        println!("skipped: no OPENDR_TEST_DATA");
    }
    Some(shared?.join("data"))
}

/// Returns how many of `places` contain a person.
fn found(poses: &PoseList, places: &[Region]) -> usize {
    let is_there = |place: &&Region| {
        poses.poses.iter().filter_map(Pose::bounding_box).any(|[left, top, width, height]| {
            let (x, y) = (left + width / 2.0, top + height / 2.0);
            let [x0, y0, x1, y1] = place.corners();
            x > x0 && x < x1 && y > y0 && y < y1 && height > 15.0 && height < 60.0
        })
    };
    places.iter().filter(is_there).count()
}

#[test]
fn detects_small_persons_that_one_pass_misses() {
    let Some(data) = data() else { return };
    let (image, places) = canvas(&data);
    let mut plain = handle::<LightweightOpenPose>("lightweight_open_pose", Default::default());
    let missed = plain.infer(&image).unwrap();
    assert_eq!(found(&missed, &places), 0, "{missed:#}");
    let params = HighResolutionPoseEstimationParams::default();
    let mut twice = handle::<HighResolutionPoseEstimation>("high_resolution_pose_estimation", params);
    let poses = twice.infer(&image).unwrap();
    println!("{poses:#}");
    assert_eq!(found(&poses, &places), 3, "{poses:#}");
    // One region per frame: the persons appear one after the other, and a reset stream restarts.
    twice.set("max_regions", 1.into()).unwrap();
    twice.reset();
    let first = twice.infer(&image).unwrap();
    assert_eq!(found(&first, &places), 1, "{first:#}");
    let others: Vec<_> = (0..3).map(|_| found(&twice.infer(&image).unwrap(), &places)).collect();
    assert_eq!(others, [2, 3, 3]);
    let nobody = Image::from_rgb8(vec![128; 3840 * 2160 * 3], 3840, 2160).unwrap();
    assert_eq!(twice.infer(&nobody).unwrap().poses, []);
    twice.reset();
    assert_eq!(twice.infer(&image).unwrap(), first);
}

#[test]
fn empty_images_have_no_persons() {
    let params = HighResolutionPoseEstimationParams::default();
    let mut twice = handle::<HighResolutionPoseEstimation>("high_resolution_pose_estimation", params);
    for (width, height) in [(1, 1), (300, 2), (640, 480)] {
        let image = Image::from_rgb8(vec![0; width * height * 3], width, height).unwrap();
        assert_eq!(twice.infer(&image).unwrap().poses, []);
    }
}

#[test]
fn parts_of_one_person_are_one() {
    let joint = |x: f32, y: f32| opendr_engine::target::Keypoint { x, y, confidence: 0.5 };
    let pose = |left: f32, confidence: f32| Pose {
        keypoints: (0..18).map(|at| joint(left + (at % 3) as f32 * 10.0, 10.0 * at as f32)).collect(),
        confidence,
        ..Pose::default()
    };
    let mut poses = vec![pose(0.0, 0.4)];
    add_person(&mut poses, pose(3.0, 0.6));
    add_person(&mut poses, pose(100.0, 0.3));
    add_person(&mut poses, pose(1.0, 0.2));
    let scores: Vec<_> = poses.iter().map(|pose| pose.confidence).collect();
    assert_eq!(scores, [0.6, 0.3]);
}
