//! `cargo xtask test`: all checks of CI.

use std::collections::VecDeque;
use std::path::{Path, PathBuf};
use std::process::Command;
use std::sync::{Mutex, PoisonError};

use crate::checks::{Checks, Output};
use crate::inputs::{Tree, of_file};
use crate::shell::{Result, command, output, root, step, target, task};
use crate::suite::Suite;
use crate::surfaces::TEST_LEARNER;
use crate::tools::{self, Python, install_debian};
use crate::{install_c, layers, parity, ros, rust_tests, site, surfaces, wheel, words};

/// Features that need a GPU, and ROS 2 over Zenoh.
const DEVICES: &str = "--features=opendr-training/cuda,opendr-training/wgpu,opendr-ros/zenoh";

/// Number of Python suites that run in parallel: they mostly wait for programs, sockets and clocks.
const LANES: usize = 2;

/// Runs every check, or without `all` those whose inputs have changed since they passed. Fails if a check fails.
pub fn run(all: bool) -> Result<()> {
    let data = test_data();
    let tree = Tree::read(data.as_deref());
    let checks = Checks::begin(all);
    let everything = tree.as_ref().map(|tree| tree.of(|_| true, &[]));
    if checks.is_unchanged("all checks", everything) {
        return checks.finish();
    }
    if data.is_none() {
        println!("skipped: no OPENDR_TEST_DATA (tests with real models and images)");
    }
    if let Err(error) = check_all(&checks, tree.as_ref()) {
        checks.fail("installation of dependencies", &error);
    }
    checks.finish()?;
    checks.keep("all checks", everything)?;
    println!("\nall checks passed");
    Ok(())
}

fn check_all(checks: &Checks, tree: Option<&Tree>) -> Result<()> {
    std::thread::scope(|scope| {
        let environments = scope.spawn(Environments::install);
        check_sources(checks, tree)?;
        let build = &mut cargo(&surfaces::arguments());
        if !checks.run("build", None, Output::Live, None, build)? {
            return Ok(());
        }
        let environments =
            environments.join().map_err(|_| "the installation of the tests' dependencies panicked")??;
        // After the installation, since this task installs an environment too.
        let pages = tree.map(|tree| tree.of(site::is_input, &[]));
        checks.run("site", pages, Output::Live, None, task("site")?.arg("--check"))?;
        let environment = Environment::of(&environments.outside)?;
        let tests = |arguments: &[&str]| {
            let mut cargo = cargo(arguments);
            environment.apply(&mut cargo);
            cargo
        };
        let programs = programs()?;
        let built = ["--workspace", "--lib", "--bins", "--tests", TEST_LEARNER];
        rust_tests::run(checks, tree, programs, &tests, &built)?;
        let sources = tree.map(|tree| tree.of(is_source, &[]));
        let examples = &mut tests(&["test", "--workspace", "--doc", TEST_LEARNER]);
        checks.run("documentation tests", sources, Output::Live, None, examples)?;
        let (suites, of_ros) = suites(&environments, &environment, programs)?;
        run_in_parallel(checks, tree, suites)?;
        // These tests publish at fixed rates: other work in parallel would cause lost messages.
        run_in_parallel(checks, tree, of_ros)
    })
}

/// Checks the format, the terms, the layers, the lints of every combination of features that no test builds, and the documentation. The
/// lints and the documentation use the same features of the dependencies, so that nothing is checked twice: devices and Zenoh are on,
/// and the whole workspace is selected.
fn check_sources(checks: &Checks, tree: Option<&Tree>) -> Result<()> {
    let sources = tree.map(|tree| tree.of(is_source, &[]));
    let live = |name, command: &mut Command| checks.run(name, sources, Output::Live, None, command);
    let of_files = |name, is_input: fn(&str) -> bool| {
        let inputs = tree.map(|tree| tree.of(|file| is_input(file) || file.starts_with("xtask/"), &[]));
        checks.run(name, inputs, Output::Live, None, &mut task(name)?)
    };
    live("format", &mut cargo(&["fmt", "--all", "--check"]))?;
    of_files("words", words::is_input)?;
    of_files("layers", layers::is_input)?;
    live("lints", &mut clippy(&["--all-targets", TEST_LEARNER]))?;
    live(
        "documentation",
        linted(cargo(&["doc", "--workspace", "--no-deps", TEST_LEARNER, DEVICES]))
            .env("RUSTDOCFLAGS", "--deny warnings"),
    )?;
    // The C library enables training and is therefore excluded.
    let free_threaded = |features: &str| {
        let mut clippy = clippy(&["--exclude=opendr-c", "--no-default-features", features]);
        clippy.env("PYO3_CONFIG_FILE", root().join("bindings/python/free_threaded.txt"));
        clippy.env("PYO3_BUILD_EXTENSION_MODULE", "1");
        clippy
    };
    live(
        "lints without training, for free-threaded Python",
        &mut free_threaded("--features=opendr-python/perception,opendr-python/ros"),
    )?;
    live(
        "lints of a single family, for free-threaded Python",
        &mut free_threaded("--features=opendr-python/detection,opendr-python/training"),
    )?;
    Ok(())
}

/// Returns the command of Clippy for the workspace with these arguments and [`DEVICES`].
fn clippy(arguments: &[&str]) -> Command {
    let mut clippy = cargo(&["clippy", "--workspace", DEVICES]);
    clippy.args(arguments).args(["--", "--deny", "warnings"]);
    downloads_nothing(clippy)
}

/// Makes cargo reuse crates of the workspace checked by `cargo clippy -- --deny warnings`, instead of checking them again.
fn linted(mut cargo: Command) -> Command {
    if let Ok(sysroot) = output(command("rustc").args(["--print", "sysroot"])) {
        cargo.env("RUSTC_WORKSPACE_WRAPPER", Path::new(sysroot.trim()).join("bin/clippy-driver"));
        cargo.env("CLIPPY_ARGS", "--deny__CLIPPY_HACKERY__warnings__CLIPPY_HACKERY__");
    }
    downloads_nothing(cargo)
}

/// Disables downloads: the build script of Burn's CUDA compiler downloads LLVM unless only documentation is built, which suffices for
/// checks.
fn downloads_nothing(mut cargo: Command) -> Command {
    cargo.env("DOCS_RS", "1");
    cargo
}

/// Returns the suites of Python and of ROS.
fn suites(
    environments: &Environments,
    environment: &Environment,
    programs: u64,
) -> Result<(Vec<Suite>, Vec<Suite>)> {
    let wheel = wheel::build(&environments.package, wheel::For::Tests)?;
    environments.package.install_wheel(&wheel)?;
    let models = wheel::build_models(&environments.package)?;
    let prefix = target().join("c");
    install_c::install_for_tests(&prefix)?;
    let package = target().join("python-package");
    wheel::unpack(&environments.package, &wheel, &package)?;
    let module = of_file(&package.join("opendr/_opendr.abi3.so"))?;
    let pytest = |python: &Python, folders: &[&str]| {
        let mut pytest = command(python.program());
        pytest.args(["-m", "pytest", "-ra"]).args(folders);
        environment.apply(&mut pytest);
        pytest
    };
    let suite = |name, python: &Python, folders: &'static [&'static str], inputs: &[u64]| Suite {
        name,
        folders,
        command: pytest(python, folders),
        inputs: inputs.to_vec(),
    };
    let mut of_package = suite(
        "tests of the Python package",
        &environments.package,
        &["bindings/python/tests"],
        &[programs, module],
    );
    of_package.command.env("OPENDR_WHEEL", &wheel).env("OPENDR_MODELS_WHEEL", &models);
    let mut of_c = suite("tests of C programs", &environments.outside, &["tests/c"], &[programs]);
    of_c.command.env("OPENDR_C_PREFIX", &prefix);
    let mut parity =
        suite("parity of all surfaces", &environments.package, &["tests/parity"], &[programs, module]);
    parity::prepare(&mut parity.command, &prefix)?;
    // The longest first, so that neither lane ends long before the other.
    let suites = vec![
        of_package,
        of_c,
        suite(
            "tests of the command",
            &environments.outside,
            &["tests/python", "tests/packages"],
            &[programs],
        ),
        parity,
        suite(
            "tests against reference tools",
            &environments.references,
            &["tests/metrics", "tests/datasets", "tests/training", "tests/simulation", "tests/text"],
            &[programs],
        ),
        suite(
            "tests of recordings with reference tools",
            &environments.references,
            &["tests/bags"],
            &[programs],
        ),
    ];
    let of_ros = environments.ros.suites(&package, |command| environment.apply(command), &[programs, module]);
    Ok((suites, of_ros.into()))
}

/// Runs suites in [`LANES`] parallel lanes; a free lane takes the next suite.
fn run_in_parallel(checks: &Checks, tree: Option<&Tree>, suites: Vec<Suite>) -> Result<()> {
    let waiting = Mutex::new(VecDeque::from(suites));
    let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
    std::thread::scope(|scope| {
        for _ in 0..LANES {
            scope.spawn(|| {
                while let Some(mut suite) = next() {
                    let inputs = tree.map(|tree| tree.of(|file| concerns(&suite, file), &suite.inputs));
                    let report =
                        target().join(format!("xtask/reports/{}.xml", suite.folders[0].replace('/', "-")));
                    suite.command.arg("--junitxml").arg(&report);
                    let done = checks.run(suite.name, inputs, Output::Kept, Some(report), &mut suite.command);
                    if let Err(error) = done {
                        checks.fail(suite.name, &error);
                    }
                }
            });
        }
    });
    Ok(())
}

/// Returns whether a suite may read a file: its own files, shared ones, pages and tables; not Rust sources, since it starts programs.
fn concerns(suite: &Suite, file: &str) -> bool {
    let own = suite.folders.iter().any(|folder| file.starts_with(folder));
    let others = file.starts_with("tests/")
        && !file.starts_with("tests/support/")
        && !file.starts_with("tests/cases/")
        || file.starts_with("bindings/python/tests/");
    own || !others && !file.ends_with(".rs")
}

/// Returns whether a file affects cargo's builds or tests: all but the tests in Python, the Python files of the package, and the pages
/// without documentation tests.
fn is_source(file: &str) -> bool {
    !(file.ends_with(".py")
        || file.ends_with(".pyi")
        || file.starts_with("tests/")
        || file.starts_with("docs/") && file != "docs/tutorials/rust.md")
}

/// Returns the hash of all programs that the tests start.
fn programs() -> Result<u64> {
    let numbers = surfaces::programs().map(|path| of_file(&path)).collect::<Result<Vec<_>>>()?;
    Ok(numbers.iter().fold(0, |all: u64, number| all.rotate_left(7) ^ number))
}

fn cargo(arguments: &[&str]) -> Command {
    let mut cargo = command("cargo");
    cargo.args(arguments);
    cargo
}

/// Runs the tests that need PyTorch, with an interpreter that has it and `tests/extended/requirements.txt`. They are not part of the
/// test task, since torch's wheel has gigabytes.
pub fn run_extended() -> Result<()> {
    let python = std::env::var_os("OPENDR_TORCH_PYTHON").ok_or(
        "OPENDR_TORCH_PYTHON is not set; set it to an interpreter with torch and tests/extended/requirements.txt",
    )?;
    let folder = target().join("extended");
    wheel::package(&folder)?;
    let mut pytest = command(python);
    pytest.args(["-m", "pytest", "-ra", "tests/extended"]).env("PYTHONPATH", folder);
    step("tests with PyTorch", &mut pytest)
}

/// Runs only the tests of the C library.
pub fn run_c() -> Result<()> {
    install_debian()?;
    let outside = Python::install(&tools::OUTSIDE)?;
    let environment = Environment::of(&outside)?;
    surfaces::build()?;
    let mut cargo = command("cargo");
    cargo.args(["test", "--package", "opendr-c", TEST_LEARNER, "--tests"]);
    environment.apply(&mut cargo);
    step("tests of the C library", &mut cargo)?;
    let prefix = target().join("c");
    install_c::install_for_tests(&prefix)?;
    let mut pytest = command(outside.program());
    pytest.args(["-m", "pytest", "-ra", "tests/c"]).env("OPENDR_C_PREFIX", &prefix);
    environment.apply(&mut pytest);
    step("tests of C programs", &mut pytest)
}

/// The Python environments of the tests.
struct Environments {
    outside: Python,
    references: Python,
    package: Python,
    ros: ros::Environments,
}

impl Environments {
    fn install() -> Result<Self> {
        install_debian()?;
        Ok(Self {
            outside: Python::install(&tools::OUTSIDE)?,
            references: Python::install(&tools::REFERENCES)?,
            package: Python::install(&tools::PACKAGE)?,
            ros: ros::Environments::install()?,
        })
    }
}

/// The environment variables of every test.
pub struct Environment {
    library: PathBuf,
    data: Option<PathBuf>,
    cache: PathBuf,
    node_tests: PathBuf,
}

impl Environment {
    /// Returns the environment with ONNX Runtime's library and ONNX's node tests of `python`.
    pub fn of(python: &Python) -> Result<Self> {
        let node_tests = node_tests(python)?;
        Ok(Self { library: python.onnxruntime()?, data: test_data(), cache: cache()?, node_tests })
    }

    /// Sets the variables of a command.
    pub fn apply(&self, command: &mut Command) {
        command.env("ORT_DYLIB_PATH", &self.library).env("OPENDR_TEST_CACHE", &self.cache);
        command.env("OPENDR_BIN", surfaces::opendr()).env("OPENDR_EXAMPLES", target().join("debug/examples"));
        command.env("OPENDR_MODELS", root().join("models/weights"));
        command.env("OPENDR_ONNX_NODE_TESTS", &self.node_tests);
        if let Some(data) = &self.data {
            command.env("OPENDR_TEST_DATA", data);
        }
    }
}

/// Returns `OPENDR_TEST_DATA`, or `../shared` relative to the repository.
fn test_data() -> Option<PathBuf> {
    let named = std::env::var_os("OPENDR_TEST_DATA").map(PathBuf::from);
    let data = named.or_else(|| root().parent().map(|folder| folder.join("shared")))?;
    data.join("models").is_dir().then_some(data)
}

/// Returns the folder of packages that tests download, which is kept between runs.
fn cache() -> Result<PathBuf> {
    let cache =
        std::env::var_os("OPENDR_TEST_CACHE").map_or_else(|| target().join("test-cache"), PathBuf::from);
    std::fs::create_dir_all(&cache).map_err(|error| format!("{}: {error}", cache.display()))?;
    Ok(Path::new(&cache).to_owned())
}

/// Returns the folder of the node tests of the package `onnx`, which are written again after the environment has changed.
fn node_tests(python: &Python) -> Result<PathBuf> {
    let folder = python.folder().join("onnx-node-tests");
    let stamp = folder.join("complete");
    if !stamp.is_file() {
        let mut write = command(python.program());
        step(
            "node tests of ONNX",
            write.arg(root().join("crates/executor/tests/node_tests.py")).arg(&folder),
        )?;
        std::fs::write(&stamp, "").map_err(|error| format!("{}: {error}", stamp.display()))?;
    }
    Ok(folder)
}
