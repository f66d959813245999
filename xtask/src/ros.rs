//! The tests with real ROS peers: ROS 2 Jazzy and Kilted from wheels, Cyclone DDS, Debian's ROS 1.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use crate::shell::{Result, command, step, target};
use crate::suite::Suite;
use crate::tools::{Python, install_debian, requirements};
use crate::{surfaces, wheel};

/// The ROS 2 distributions of the peers: name, environment, requirements.
const DISTRIBUTIONS: [(&str, &str, &str); 2] = [
    ("jazzy", "ros-jazzy-venv", "tests/ros/environment/jazzy.txt"),
    ("kilted", "ros-kilted-venv", "tests/ros/environment/kilted.txt"),
];

/// Installs the dependencies of these tests only, then runs them.
pub fn run_alone() -> Result<()> {
    let environments = Environments::install()?;
    surfaces::build()?;
    let package = target().join("ros-python");
    wheel::package(&package)?;
    for mut suite in environments.suites(&package, |_| (), &[]) {
        step(suite.name, &mut suite.command)?;
    }
    Ok(())
}

/// Runs the tests of the command over Zenoh, with a router and a peer from Python packages. Building Zenoh takes minutes, so
/// they are not part of the test task.
pub fn run_zenoh() -> Result<()> {
    install_debian()?;
    step(
        "build with Zenoh",
        command("cargo").args(["build", "--package", "opendr-cli", "--features=zenoh"]),
    )?;
    step(
        "tests of keys and tokens",
        command("cargo").args(["test", "--package", "opendr-ros", "--features=zenoh", "--lib"]),
    )?;
    let python = Python::install(&requirements("ros-zenoh-venv", &["tests/ros_zenoh/requirements.txt"]))?;
    let mut pytest = command(python.program());
    pytest.args(["-m", "pytest", "-ra", "tests/ros_zenoh"]).env("OPENDR_BIN", target().join("debug/opendr"));
    step("tests over Zenoh", &mut pytest)
}

/// The environments of the peers: interpreters with the packages of each distribution, and our messages built for them.
pub struct Environments {
    tests: Python,
    distributions: Vec<(&'static str, PathBuf)>,
    ros1_messages: PathBuf,
}

impl Environments {
    /// Installs or updates the environments.
    pub fn install() -> Result<Self> {
        install_debian()?;
        let tests = Python::install(&requirements("ros-venv", &["tests/ros/requirements.txt"]))?;
        let mut distributions = Vec::new();
        for (name, environment, file) in DISTRIBUTIONS {
            let python = Python::install(&requirements(environment, &[file]))?.program();
            let mut build = command(&python);
            step(&format!("messages of ROS 2 {name}"), build.arg("tests/ros/environment/build_messages.py"))?;
            distributions.push((name, python));
        }
        let ros1_messages = target().join("ros1-messages");
        let mut generate = command("/usr/bin/python3");
        generate.arg("tests/ros/environment/generate_ros1.py").arg(&ros1_messages);
        step("messages of ROS 1", &mut generate)?;
        Ok(Self { tests, distributions, ros1_messages })
    }

    /// Returns the suites; `package` is a folder with the Python package, `inputs` the hashes of the programs that they start.
    pub fn suites(&self, package: &Path, environment: impl Fn(&mut Command), inputs: &[u64]) -> [Suite; 2] {
        let mut peers = isolated(&self.tests.program());
        peers.args(["-m", "pytest", "-ra", "tests/ros"]);
        for (name, python) in &self.distributions {
            peers.env(format!("OPENDR_ROS_{}", name.to_uppercase()), python);
        }
        peers.env("OPENDR_ROS1_MESSAGES", &self.ros1_messages).env("OPENDR_PYTHON_PACKAGE", package);
        environment(&mut peers);
        let mut ros1 = command(self.tests.program());
        ros1.args(["-m", "pytest", "-ra", "tests/ros1"]);
        environment(&mut ros1);
        let suite = |name, folders, command| Suite { name, folders, command, inputs: inputs.to_vec() };
        [
            suite("tests with real ROS peers", &["tests/ros"], peers),
            suite("tests of the ROS 1 client", &["tests/ros1"], ros1),
        ]
    }
}

/// Returns a command that runs a program in a network namespace with only loopback and multicast, so that peers discover only
/// each other; in this machine's network where namespaces are not permitted.
fn isolated(program: &Path) -> Command {
    for new in ["-n", "-rn"] {
        let try_out = Command::new("unshare").args([new, "true"]).stderr(Stdio::null()).status();
        if try_out.is_ok_and(|status| status.success()) {
            let mut isolated = command("unshare");
            isolated.args([new, "--", "sh", "-c", LOOPBACK, "sh"]).arg(program);
            return isolated;
        }
    }
    println!("network namespaces are not permitted: the ROS peers use this machine's network");
    command(program)
}

const LOOPBACK: &str = r#"ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec "$@""#;
