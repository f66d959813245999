//! Installation of the tests' dependencies: Debian packages and Python environments.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

use crate::shell::{Result, command, is_installed, root, step, target};

/// Debian packages by the program or folder that they provide.
const DEBIAN: [(&str, &str); 23] = [
    ("advzip", "advancecomp"),
    ("ffmpeg", "ffmpeg"),
    ("g++", "g++"),
    ("pkg-config", "pkg-config"),
    ("cmake", "cmake"),
    ("chromium", "chromium"),
    ("chromedriver", "chromium-driver"),
    ("valgrind", "valgrind"),
    ("/usr/share/datasets/fashion-mnist", "dataset-fashion-mnist"),
    ("ip", "iproute2"),
    ("roscore", "ros-core"),
    ("rosbag", "python3-rosbag"),
    ("/usr/lib/python3/dist-packages/rospy", "python3-rospy"),
    ("/usr/lib/python3/dist-packages/sensor_msgs", "python3-sensor-msgs"),
    ("/usr/lib/python3/dist-packages/std_srvs", "python3-std-srvs"),
    ("/usr/lib/python3/dist-packages/tf2_msgs", "python3-tf2-msgs"),
    ("/usr/lib/python3/dist-packages/visualization_msgs", "python3-visualization-msgs"),
    ("/usr/lib/python3/dist-packages/diagnostic_msgs", "python3-diagnostic-msgs"),
    ("/usr/lib/python3/dist-packages/nav_msgs", "python3-nav-msgs"),
    ("/usr/lib/python3/dist-packages/geometry_msgs", "python3-geometry-msgs"),
    ("/usr/share/std_msgs/msg", "ros-std-msgs"),
    ("/usr/share/geometry_msgs/msg", "ros-geometry-msgs"),
    ("/usr/share/sensor_msgs/msg", "ros-sensor-msgs"),
];

/// A Python environment with the packages of requirements files.
pub struct Python {
    folder: PathBuf,
}

/// Packages to install: requirements with their dependencies, and packages without dependencies.
pub struct Requirements<'a> {
    /// Name of the environment, a folder in the build folder.
    pub name: &'a str,
    /// Files of requirements.
    pub files: &'a [&'a str],
    /// A file of packages to install without their dependencies.
    pub alone: Option<&'a str>,
}

/// Returns requirements without packages of the second kind.
pub const fn requirements<'a>(name: &'a str, files: &'a [&'a str]) -> Requirements<'a> {
    Requirements { name, files, alone: None }
}

/// Requirements of the tests of the command.
pub const OUTSIDE: Requirements = requirements("test-venv", &["tests/python/requirements.txt"]);

/// Reference tools, against which metrics, data sets, logs, networks and recordings are tested.
pub const REFERENCES: Requirements = Requirements {
    name: "reference-venv",
    files: &[
        "tests/metrics/requirements.txt",
        "tests/datasets/requirements.txt",
        "tests/training/requirements.txt",
        "tests/simulation/requirements.txt",
        "tests/bags/requirements.txt",
        "tests/text/requirements.txt",
    ],
    alone: Some("tests/metrics/requirements_without_dependencies.txt"),
};

/// Requirements of the tests of the Python package; the package itself is installed as a wheel.
pub const PACKAGE: Requirements = requirements("python-venv", &["bindings/python/tests/requirements.txt"]);

impl Python {
    /// Creates the environment, again if the requirements have changed.
    pub fn install(requirements: &Requirements) -> Result<Self> {
        let python = Self { folder: target().join(requirements.name) };
        let paths = |files: &[&str]| files.iter().map(|file| root().join(file)).collect::<Vec<_>>();
        let with = paths(requirements.files);
        let without = paths(requirements.alone.as_slice());
        let wanted = with.iter().chain(&without).map(fs::read_to_string).collect::<std::io::Result<String>>();
        let wanted = wanted.map_err(|error| error.to_string())?;
        let stamp = python.folder.join("requirements.installed");
        if fs::read_to_string(&stamp).ok().as_deref() == Some(wanted.as_str()) {
            return Ok(python);
        }
        let uv = uv()?;
        step(
            "python environment",
            command(&uv)
                .args([
                    "venv",
                    "--quiet",
                    "--seed",
                    "--clear",
                    "--no-python-downloads",
                    "--python",
                    "python3",
                ])
                .arg(&python.folder),
        )?;
        for (files, options) in [(with, &[][..]), (without, &["--no-deps"][..])] {
            if files.is_empty() {
                continue;
            }
            let mut install = command(&uv);
            install.args(["pip", "install", "--quiet", "--python"]).arg(python.program()).args(options);
            install.args(files.iter().flat_map(|file| [Path::new("-r"), file.as_path()]));
            step(&format!("python packages of {}", requirements.name), &mut install)?;
        }
        fs::write(&stamp, wanted).map_err(|error| error.to_string())?;
        Ok(python)
    }

    /// Installs a wheel without its dependencies.
    pub fn install_wheel(&self, wheel: &Path) -> Result<()> {
        let mut install = command(uv()?);
        install
            .args(["pip", "install", "--quiet", "--reinstall", "--no-deps", "--python"])
            .arg(self.program())
            .arg(wheel);
        step("wheel's installation", &mut install)
    }

    /// Returns its folder, which is removed when its requirements change.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// Returns the path of its interpreter.
    pub fn program(&self) -> PathBuf {
        self.folder.join("bin/python")
    }

    /// Returns the path of ONNX Runtime's library in its wheel.
    pub fn onnxruntime(&self) -> Result<PathBuf> {
        let lib = self.folder.join("lib");
        let pythons = fs::read_dir(&lib).map_err(|error| format!("{}: {error}", lib.display()))?.flatten();
        let folders = pythons.map(|python| python.path().join("site-packages/onnxruntime/capi"));
        let files = folders.flat_map(fs::read_dir).flatten().flatten().map(|entry| entry.path());
        let mut libraries = files.filter(|path| {
            path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("libonnxruntime.so"))
        });
        libraries.next().ok_or_else(|| format!("no libonnxruntime.so under {}", lib.display()))
    }
}

/// Returns the path of uv: that of this machine, or one installed in the build folder.
fn uv() -> Result<PathBuf> {
    static INSTALLED: Mutex<()> = Mutex::new(());
    if is_installed("uv") {
        return Ok(PathBuf::from("uv"));
    }
    let _one_at_a_time = INSTALLED.lock().unwrap_or_else(PoisonError::into_inner);
    let folder = target().join("uv");
    let uv = folder.join("bin/uv");
    if !uv.is_file() {
        step("python environment of uv", command("python3").args(["-m", "venv", "--clear"]).arg(&folder))?;
        let mut pip = command(folder.join("bin/python"));
        step("uv", pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check", "uv"]))?;
    }
    Ok(uv)
}

/// Installs the Debian packages that are missing.
pub fn install_debian() -> Result<()> {
    let missing: Vec<_> =
        DEBIAN.iter().filter(|(what, _)| !is_installed(what) && !Path::new(what).is_dir()).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let packages: Vec<_> = missing.iter().map(|(_, package)| *package).collect();
    if !is_installed("apt-get") {
        return Err(format!("apt-get is not available; install {} and run again", packages.join(", ")));
    }
    let apt = || {
        let mut apt = if is_installed("sudo") { command("sudo") } else { command("apt-get") };
        if is_installed("sudo") {
            apt.arg("apt-get");
        }
        apt.env("DEBIAN_FRONTEND", "noninteractive");
        apt
    };
    step("debian lists", apt().args(["update", "--quiet"]))?;
    step(
        "debian packages",
        apt().args(["install", "--yes", "--quiet", "--no-install-recommends"]).args(packages),
    )
}
