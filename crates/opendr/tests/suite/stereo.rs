//! Stereo matching on a pair with measured ground-truth disparities.

use std::fs::File;
use std::io::Read as _;
use std::path::Path;

use opendr::Value;
use opendr::datasets::array_from_npy;
use opendr::learner::{AnyLearner, Ports};
use opendr::metrics::DisparityErrors;
use opendr::params::{ParamMap, ParamValue};
use opendr::target::HeatmapValues;
use opendr::{Device, vision};

use crate::models::Models;

fn learner(models: &Models, params: &[(&str, ParamValue)]) -> Box<dyn AnyLearner> {
    let params: ParamMap = params.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    let mut learner =
        opendr::registry().find("semi_global_matching").unwrap().make(&params, Device::Cpu).unwrap();
    learner.load(&models.get("semi_global_matching").unwrap()).unwrap();
    learner
}

fn motorcycle(models: &Models, side: &str) -> opendr::data::Image {
    vision::open(models.data(&format!("photos/motorcycle_{side}.png"))).unwrap()
}

fn ground_truth(path: &Path) -> Vec<f32> {
    let mut archive = zip::ZipArchive::new(File::open(path).unwrap()).unwrap();
    let mut bytes = Vec::new();
    archive.by_index(0).unwrap().read_to_end(&mut bytes).unwrap();
    let (shape, numbers) = array_from_npy(&bytes).unwrap();
    assert_eq!(shape, [500, 741]);
    numbers.into_iter().map(|number| number as f32).collect()
}

fn disparities(models: &Models, params: &[(&str, ParamValue)]) -> Vec<f32> {
    let [left, right] = ["left", "right"].map(|side| motorcycle(models, side));
    let ports = Ports::default().with("left", &left).with("right", &right);
    let answer = learner(models, params).infer(&ports).unwrap();
    let Some(Value::Heatmap(map)) = answer.get("disparity") else { panic!("{answer:?}") };
    assert_eq!(map.shape(), [500, 741]);
    let HeatmapValues::Scores(found) = map.values() else { panic!("no disparities") };
    found.to_vec()
}

/// Shares of pixels whose disparity is further off than 2: of all with a ground truth, of those that are known, of all where holes are
/// filled.
fn bad_pixels(models: &Models, params: &[(&str, ParamValue)]) -> [f64; 3] {
    let ground_truth = ground_truth(&models.data("photos/motorcycle_disp.npz"));
    let share = |errors: &DisparityErrors| errors.bad[1] as f64 / errors.pixels as f64;
    let found = disparities(models, params);
    // What is not known has disparity 0, and so is bad.
    let errors = DisparityErrors::of(&ground_truth, &found).unwrap();
    let known: Vec<f32> = ground_truth
        .iter()
        .zip(&found)
        .map(|(ground_truth, found)| if *found > 0.0 { *ground_truth } else { 0.0 })
        .collect();
    let of_known = DisparityErrors::of(&known, &found).unwrap();
    let filled = disparities(models, &[params, &[("fill", true.into())]].concat());
    let filled = DisparityErrors::of(&ground_truth, &filled).unwrap();
    let bad = [share(&errors), share(&of_known), share(&filled)];
    println!("bad 2.0 {bad:.4?}, known {:.4}", of_known.pixels as f64 / errors.pixels as f64);
    bad
}

#[test]
fn the_motorcycle_stands_where_it_stands() {
    let Some(models) = Models::find() else { return };
    let [bad, of_known, filled] = bad_pixels(&models, &[]);
    assert!(bad <= 0.16 && of_known <= 0.05 && filled <= 0.08);
    let [bad, of_known, filled] = bad_pixels(&models, &[("shrink", 4.into())]);
    assert!(bad <= 0.30 && of_known <= 0.15 && filled <= 0.20);
}

#[test]
fn the_motorcycle_is_in_the_way() {
    let Some(models) = Models::find() else { return };
    // Height and pitch are those of the plane through the floor's true places.
    let calibration: [(&str, ParamValue); 5] = [
        ("focal_length", 994.978.into()),
        ("baseline", 0.193_001.into()),
        ("disparity_offset", 31.086.into()),
        ("camera_height", 1.047.into()),
        ("camera_pitch", 14.35.into()),
    ];
    let mut learner = learner(&models, &calibration);
    let [left, right] = ["left", "right"].map(|side| motorcycle(&models, side));
    let answer = learner.infer(&Ports::default().with("left", &left).with("right", &right)).unwrap();
    let Some(Value::BoundingBox3DList(obstacles)) = answer.get("obstacles") else { panic!("{answer:?}") };
    let nearest = obstacles.boxes.first().unwrap();
    assert!((2.0..3.0).contains(&nearest.location[2]), "{nearest:?}");
}

#[test]
fn a_pair_is_of_one_size() {
    let Some(models) = Models::find() else { return };
    let left = motorcycle(&models, "left");
    let right = vision::resize(&left, 740, 500).unwrap();
    let ports = Ports::default().with("left", &left).with("right", &right);
    let error = learner(&models, &[]).infer(&ports).unwrap_err();
    assert!(error.to_string().contains("741x500"), "{error}");
    let error = learner(&models, &[]).infer(&Ports::one(&left)).unwrap_err();
    assert!(error.to_string().contains("right"), "{error}");
}
