//! `eval` of a depth estimator of unknown scale on a data set of depth maps.

use std::fs;
use std::path::{Path, PathBuf};

use opendr::data::{Image, Layout, PixelFormat};
use opendr::dataset::{DatasetRef, ExternalDataset};
use opendr::evaluation::{EvalOptions, Outcome};
use opendr::learner::{AnyLearner, Ports};
use opendr::params::{ParamMap, ParamValue};
use opendr::target::HeatmapValues;
use opendr::{Device, Result, Silent, Value};

fn fixture() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../perception/depth/tests/imported/dpt.zip")
}

/// Writes two images, and depths whose inverse is 0.004 times the prediction of the learner plus 0.2; a row has no depth.
fn folder(learner: &mut dyn AnyLearner) -> PathBuf {
    let root = std::env::temp_dir().join(format!("opendr-depth-eval-{}", std::process::id()));
    fs::remove_dir_all(&root).ok();
    for name in ["images", "depth"] {
        fs::create_dir_all(root.join(name)).unwrap();
    }
    for (number, [width, height]) in [[64, 48], [40, 40]].into_iter().enumerate() {
        let level = |at: usize| ((at * 7 + at / 64 * 13 + number * 50) % 256) as u8;
        let image = Image::from_rgb8((0..width * height * 3).map(level).collect(), width, height).unwrap();
        let outputs = learner.infer(&Ports::one(&image)).unwrap();
        let Some(Value::Heatmap(map)) = outputs.get("heatmap") else { panic!("{outputs:?}") };
        let HeatmapValues::Scores(found) = map.values() else { panic!("labels") };
        let millimetres = |found: &f32| (1000.0 / (0.004 * found.max(0.0) + 0.2)).round() as u16;
        let mut depth: Vec<u16> = found.iter().map(millimetres).collect();
        depth[..width].fill(0);
        let depth = Image::new(depth, width, height, PixelFormat::Grey, Layout::Hwc).unwrap();
        opendr::vision::save(&image, root.join(format!("images/{number}.png"))).unwrap();
        opendr::vision::save_depth(&depth, root.join(format!("depth/{number}.png"))).unwrap();
    }
    root
}

fn evaluate(
    learner: &mut Box<dyn AnyLearner>,
    root: &Path,
    params: &[(&str, ParamValue)],
) -> Result<Outcome> {
    let entry = opendr::registry().find("depth_estimator").unwrap();
    let external = ExternalDataset::new(root, "auto");
    let metric_params = params.iter().map(|(name, value)| ((*name).to_owned(), value.clone())).collect();
    let options = EvalOptions { metric_params, ..EvalOptions::default() };
    options.run(learner, entry, DatasetRef::External(&external), &Silent)
}

#[test]
fn relative_predictions_are_aligned_unless_the_user_says_otherwise() {
    let entry = opendr::registry().find("depth_estimator").unwrap();
    let mut learner = entry.make(&ParamMap::new(), Device::Cpu).unwrap();
    learner.load(&fixture()).unwrap();
    let root = folder(learner.as_mut());
    let outcome = evaluate(&mut learner, &root, &[("max_depth", 10.0.into())]).unwrap();
    assert_eq!((outcome.metric.as_str(), outcome.counted), ("depth", 2));
    assert_eq!(outcome.metric_params["alignment"], "inverse_scale_shift".into());
    let scalars = &outcome.report.statistics.scalars;
    println!("{scalars:?}");
    // Depths are rounded to millimetres, and interpolated ones below 0 were raised to it.
    assert!(scalars["abs_rel"] < 0.01 && scalars["delta1"] > 0.999, "{scalars:?}");
    let error = evaluate(&mut learner, &root, &[]).err().unwrap().to_string();
    assert!(error.contains("needs max_depth"), "{error}");
    let metres = [("max_depth", 10.0.into()), ("alignment", "none".into())];
    let outcome = evaluate(&mut learner, &root, &metres).unwrap();
    assert!(outcome.report.statistics.scalars["abs_rel"] > 0.5);
    fs::remove_dir_all(&root).ok();
}
