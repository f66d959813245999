//! Real models and data for the tests of learners, from `OPENDR_TEST_DATA`.

use std::path::PathBuf;

use opendr_engine::model::{Manifest, ModelWriter};

/// Returns a path in the folder of test data; without one, prints a message and returns `None`.
pub fn test_data(path: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("OPENDR_TEST_DATA").map(PathBuf::from);
    if folder.is_none() {
        println!("skipped: no OPENDR_TEST_DATA");
    }
    Some(folder?.join(path))
}

/// Returns a container of `learner` with the model at `path` of the test models, and one class per line of `classes`.
pub fn container(learner: &str, path: &str, classes: &str) -> Option<PathBuf> {
    let model = std::fs::read(test_data("models")?.join(path)).unwrap();
    Some(container_of(learner, &model, classes))
}

/// Returns a container of `learner` with `model`, and one class per line of `classes`.
pub fn container_of(learner: &str, model: &[u8], classes: &str) -> PathBuf {
    let test = std::thread::current().name().unwrap_or_default().replace("::", "-");
    let folder = std::env::temp_dir().join(format!("opendr-{test}-{learner}-{}", std::process::id()));
    std::fs::remove_dir_all(&folder).ok();
    let mut manifest = Manifest::new(learner, "");
    manifest.classes = classes.lines().collect();
    let mut writer = ModelWriter::new(&folder, manifest).unwrap();
    writer.add("model.onnx", model).unwrap();
    writer.finish().unwrap();
    folder
}
