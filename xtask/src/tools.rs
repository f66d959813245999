//! What the tests need beyond Rust, Python and npm.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{Result, command, is_installed, root, step, target};

/// Debian packages by the program that they bring.
const DEBIAN: [(&str, &str); 20] = [
    ("ffmpeg", "ffmpeg"),
    ("g++", "g++"),
    ("pkg-config", "pkg-config"),
    ("cmake", "cmake"),
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

/// A Python environment with the packages of a file of requirements.
pub struct Python {
    folder: PathBuf,
}

impl Python {
    /// Makes the environment `name` under the build folder, or brings it up to date when the requirements have
    /// changed.
    pub fn install(name: &str, requirements: &str) -> Result<Self> {
        Self::install_all(name, &[requirements], None)
    }

    /// As [`Python::install`] of several files; of the packages of `alone`, what they depend on is left out.
    pub fn install_all(name: &str, requirements: &[&str], alone: Option<&str>) -> Result<Self> {
        let python = Self { folder: target().join(name) };
        let files: Vec<_> = requirements.iter().chain(&alone).map(|file| root().join(file)).collect();
        let wanted = files.iter().map(fs::read_to_string).collect::<std::io::Result<String>>();
        let wanted = wanted.map_err(|error| error.to_string())?;
        let stamp = python.folder.join("requirements.installed");
        if fs::read_to_string(&stamp).ok().as_deref() == Some(wanted.as_str()) {
            return Ok(python);
        }
        step("python environment", command("python3").args(["-m", "venv", "--clear"]).arg(&python.folder))?;
        let pip = || {
            let mut pip = command(python.program());
            pip.args(["-m", "pip", "install", "--quiet", "--disable-pip-version-check"]);
            pip
        };
        let (with, without) = files.split_at(requirements.len());
        step("python packages", pip().args(with.iter().flat_map(|file| [Path::new("-r"), file.as_path()])))?;
        for file in without {
            step("python packages, alone", pip().arg("--no-deps").arg("-r").arg(file))?;
        }
        fs::write(&stamp, wanted).map_err(|error| error.to_string())?;
        Ok(python)
    }

    /// Builds the wheel of `bindings/python` and installs it, without what it depends on; the wheel.
    pub fn install_wheel(&self) -> Result<PathBuf> {
        let folder = target().join("wheels");
        // Nothing there is what is wanted.
        fs::remove_dir_all(&folder).ok();
        let pip = |words: &[&str]| {
            let mut pip = command(self.program());
            pip.args(["-m", "pip", "--quiet", "--disable-pip-version-check"]).args(words);
            pip
        };
        let mut wheel = pip(&["wheel", "--no-deps", "--wheel-dir"]);
        // Slower to make and smaller to get.
        wheel.env("MATURIN_PEP517_ARGS", "--compression-level 9");
        step("wheel", wheel.arg(&folder).arg("./bindings/python"))?;
        let wheels = fs::read_dir(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        let wheels: Vec<_> = wheels.flatten().map(|entry| entry.path()).collect();
        let [wheel] = &wheels[..] else { return Err(format!("one wheel is wanted, not {wheels:?}")) };
        step("wheel's installation", pip(&["install", "--force-reinstall", "--no-deps"]).arg(wheel))?;
        Ok(wheel.clone())
    }

    /// Its interpreter.
    pub fn program(&self) -> PathBuf {
        self.folder.join("bin/python")
    }

    /// ONNX Runtime's library out of its wheel.
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

/// Installs the Debian packages that are missing.
pub fn install_debian() -> Result<()> {
    let missing: Vec<_> =
        DEBIAN.iter().filter(|(what, _)| !is_installed(what) && !Path::new(what).is_dir()).collect();
    if missing.is_empty() {
        return Ok(());
    }
    let packages: Vec<_> = missing.iter().map(|(_, package)| *package).collect();
    if !is_installed("apt-get") {
        return Err(format!("install {} and run again: there is no apt-get here", packages.join(", ")));
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
