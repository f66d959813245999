//! `cargo xtask ship`: the wheels for users, and the tests of their size, import time and completeness.

use crate::shell::{Result, command, step};
use crate::test::Environment;
use crate::tools::{self, Python, install_debian};
use crate::wheel;

/// Builds the wheels in the profile `dist` and tests them in environments of their own.
pub fn run() -> Result<()> {
    install_debian()?;
    let python = Python::install(&tools::PACKAGE)?;
    let wheel = wheel::build(&python, wheel::For::Users)?;
    let models = wheel::build_models(&python)?;
    for wheel in [&wheel, &models] {
        let size = std::fs::metadata(wheel).map_err(|error| format!("{}: {error}", wheel.display()))?.len();
        println!("{}: {:.2} MB", wheel.display(), size as f64 / 1e6);
    }
    python.install_wheel(&wheel)?;
    let mut pytest = command(python.program());
    pytest.args(["-m", "pytest", "-ra", "bindings/python/tests/test_install.py"]);
    Environment::of(&Python::install(&tools::OUTSIDE)?)?.apply(&mut pytest);
    step(
        "tests of the shipped wheel",
        pytest.env("OPENDR_WHEEL", &wheel).env("OPENDR_MODELS_WHEEL", &models).env("OPENDR_SHIPPED", "1"),
    )
}
