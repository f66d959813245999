//! `cargo xtask test`: everything that CI checks.

use std::path::{Path, PathBuf};
use std::process::Command;

use crate::shell::{Result, begun, check, command, is_installed, root, step, target};
use crate::tools::{Python, install_debian};
use crate::{install_c, parity, python_package, ros, surfaces};

/// Runs every check; the first that fails ends it.
pub fn run() -> Result<()> {
    install_debian()?;
    let outside = Python::install("test-venv", "tests/python/requirements.txt")?;
    let environment = Environment { library: outside.onnxruntime()?, data: test_data(), cache: cache()? };
    if environment.data.is_none() {
        println!("skipped: no OPENDR_TEST_DATA (tests with real models and pictures)");
    }
    let cargo = |arguments: &[&str]| {
        let mut cargo = command("cargo");
        cargo.args(arguments);
        environment.apply(&mut cargo);
        cargo
    };
    check("format", &mut cargo(&["fmt", "--all", "--check"]))?;
    // With the features that no other check builds: what needs a GPU, and ROS 2 over Zenoh. Burn's CUDA compiler comes through
    // a build script that downloads LLVM, except where only documentation is built; a check needs no more than that.
    let features = format!("{TEST_LEARNER},opendr-training/cuda,opendr-training/wgpu,opendr-ros/zenoh");
    check(
        "lints",
        cargo(&["clippy", "--workspace", "--all-targets", &features, "--", "--deny", "warnings"])
            .env("DOCS_RS", "1"),
    )?;
    check("without training", &mut cargo(&["check", "--package", "opendr-cli"]))?;
    check(
        "free-threaded Python",
        cargo(&["check", "--package", "opendr-python", "--no-default-features"])
            .env("PYO3_CONFIG_FILE", root().join("bindings/python/free_threaded.txt"))
            .env("PYO3_BUILD_EXTENSION_MODULE", "1"),
    )?;
    if is_installed("cargo-nextest") {
        check("tests", &mut cargo(&["nextest", "run", "--workspace", "--no-fail-fast", TEST_LEARNER]))?;
    } else {
        check("tests", &mut cargo(&["test", "--workspace", "--lib", "--bins", "--tests", TEST_LEARNER]))?;
    }
    check("documentation tests", &mut cargo(&["test", "--workspace", "--doc", TEST_LEARNER]))?;
    check(
        "documentation",
        cargo(&["doc", "--workspace", "--no-deps"]).env("RUSTDOCFLAGS", "--deny warnings"),
    )?;
    step("release build", &mut cargo(&["build", "--release", TRAINING]))?;
    surfaces::build()?;
    let examples = target().join("debug/examples");
    check(
        "tests from outside",
        pytest(&outside, "tests/python", &environment).env("OPENDR_EXAMPLES", &examples),
    )?;
    references(&environment)?;
    ros::run(|pytest| environment.apply(pytest))?;
    let python = Python::install("python-venv", "bindings/python/tests/requirements.txt")?;
    let wheel = python.install_wheel()?;
    check(
        "tests of the Python package",
        pytest(&python, "bindings/python/tests", &environment).env("OPENDR_WHEEL", wheel),
    )?;
    let prefix = c_library(&outside, &environment)?;
    parity::run(&python, &prefix, |pytest| environment.apply(pytest))?;
    begun()?;
    println!("\nall checks passed");
    Ok(())
}

/// Metrics, data sets, logs of trainings and exported networks beside the tools that papers cite and people use.
fn references(environment: &Environment) -> Result<()> {
    let tests = ["tests/metrics", "tests/datasets", "tests/training", "tests/simulation", "tests/bags"];
    let requirements = tests.map(|tests| format!("{tests}/requirements.txt"));
    let alone = Some("tests/metrics/requirements_without_dependencies.txt");
    let python = Python::install_all("reference-venv", &requirements.each_ref().map(String::as_str), alone)?;
    let examples = target().join("debug/examples");
    let [of_libraries @ .., of_recordings] = tests;
    let mut pytest = command(python.program());
    pytest.args(["-m", "pytest", "-ra"]).args(of_libraries);
    pytest
        .env("OPENDR_METRICS_COMPUTE", examples.join("compute"))
        .env("OPENDR_METRICS_COCO_FILES", examples.join("coco_files"))
        .env("OPENDR_DATASETS_DATA", examples.join("data"))
        .env("OPENDR_MFCC", examples.join("mfcc"))
        .env("OPENDR_PERCEPTION_FOLLOW", examples.join("follow"))
        .env("OPENDR_SIMULATION_SERVE", examples.join("serve_environments"))
        .env("OPENDR_RUNLOG_LOG", examples.join("log"))
        .env("OPENDR_OPTIMIZE_SHRINK", examples.join("shrink"))
        .env("OPENDR_TRAINING_EXPORT_ALL", examples.join("export_all"))
        .env("OPENDR_TRAINING_OWN_MODULE", examples.join("own_module"));
    environment.apply(&mut pytest);
    check("tests beside the reference tools", &mut pytest)?;
    // They import from their own conftest, of which a run has one by that name.
    let mut pytest = command(python.program());
    pytest.args(["-m", "pytest", "-ra", of_recordings]);
    pytest
        .env("OPENDR_BIN", target().join("debug/opendr"))
        .env("OPENDR_BAG_DUMP", examples.join("bag_dump"))
        .env("OPENDR_BAG_COPY", examples.join("bag_copy"));
    environment.apply(&mut pytest);
    check("tests of recordings beside their tools", &mut pytest)
}

/// What needs PyTorch, with an interpreter that has it and `tests/extended/requirements.txt`: the normal run does
/// without, since torch's wheel brings gigabytes.
pub fn run_extended() -> Result<()> {
    let python = std::env::var_os("OPENDR_TORCH_PYTHON").ok_or(
        "OPENDR_TORCH_PYTHON is not set; name an interpreter with torch and tests/extended/requirements.txt",
    )?;
    let folder = target().join("extended");
    python_package::build(&folder)?;
    let mut pytest = command(python);
    pytest.args(["-m", "pytest", "-ra", "tests/extended"]).env("PYTHONPATH", folder);
    step("tests with PyTorch", &mut pytest)
}

/// The learner that every surface is tested with is in every build for tests.
pub const TEST_LEARNER: &str = "--features=opendr/test-learner";

/// The command with everything in it; without, it is built in half the time.
const TRAINING: &str = "--features=training";

/// The tests of the C library alone.
pub fn run_c() -> Result<()> {
    install_debian()?;
    let outside = Python::install("test-venv", "tests/python/requirements.txt")?;
    let environment = Environment { library: outside.onnxruntime()?, data: test_data(), cache: cache()? };
    step("release build", command("cargo").args(["build", "--release", TRAINING]))?;
    let mut cargo = command("cargo");
    cargo.args(["test", "--package", "opendr-c", TEST_LEARNER, "--tests"]);
    environment.apply(&mut cargo);
    step("tests of the C library", &mut cargo)?;
    c_library(&outside, &environment).map(drop)
}

/// Installs the C library under the build folder and tests programs against it; where it is.
fn c_library(outside: &Python, environment: &Environment) -> Result<PathBuf> {
    let prefix = target().join("c");
    install_c::run_for_tests(&prefix)?;
    check("tests of C programs", pytest(outside, "tests/c", environment).env("OPENDR_C_PREFIX", &prefix))?;
    Ok(prefix)
}

fn pytest(python: &Python, tests: &str, environment: &Environment) -> Command {
    let mut pytest = command(python.program());
    pytest.args(["-m", "pytest", "-ra", tests]).env("OPENDR_BIN", target().join("release/opendr"));
    environment.apply(&mut pytest);
    pytest
}

struct Environment {
    library: PathBuf,
    data: Option<PathBuf>,
    cache: PathBuf,
}

impl Environment {
    fn apply(&self, command: &mut Command) {
        command.env("ORT_DYLIB_PATH", &self.library).env("OPENDR_TEST_CACHE", &self.cache);
        if let Some(data) = &self.data {
            command.env("OPENDR_TEST_DATA", data);
        }
    }
}

/// `OPENDR_TEST_DATA`, or `../shared` beside the repository.
fn test_data() -> Option<PathBuf> {
    let named = std::env::var_os("OPENDR_TEST_DATA").map(PathBuf::from);
    let data = named.or_else(|| root().parent().map(|folder| folder.join("shared")))?;
    data.join("models").is_dir().then_some(data)
}

/// Where packages that tests download stay from run to run.
fn cache() -> Result<PathBuf> {
    let cache =
        std::env::var_os("OPENDR_TEST_CACHE").map_or_else(|| target().join("test-cache"), PathBuf::from);
    std::fs::create_dir_all(&cache).map_err(|error| format!("{}: {error}", cache.display()))?;
    Ok(Path::new(&cache).to_owned())
}
