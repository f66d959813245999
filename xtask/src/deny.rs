//! `cargo xtask deny`: licences, sources, versions and known vulnerabilities of the dependencies, by cargo-deny and `deny.toml`.

use std::path::PathBuf;

use crate::shell::{Result, command, is_installed, step, target};

/// Version of cargo-deny that is installed where the machine has none.
const VERSION: &str = "0.20.2";

/// Checks all but what the database of advisories lists; then that, which needs its server.
pub fn run() -> Result<()> {
    let cargo_deny = cargo_deny()?;
    step(
        "licences, sources and versions of the dependencies",
        command(&cargo_deny).args([
            "--locked",
            "check",
            "--hide-inclusion-graph",
            "licenses",
            "sources",
            "bans",
        ]),
    )?;
    step("known vulnerabilities", command(&cargo_deny).args(["--locked", "check", "advisories"])).map_err(
        |error| {
            format!(
                "{error}; if its output says that the database could not be fetched, run again where its server is reachable: \
                 nothing is known about the vulnerabilities of the dependencies then"
            )
        },
    )
}

/// Returns the path of cargo-deny: that of this machine, or one installed in the build folder.
fn cargo_deny() -> Result<PathBuf> {
    if is_installed("cargo-deny") {
        return Ok(PathBuf::from("cargo-deny"));
    }
    let folder = std::path::absolute(target().join("tools")).map_err(|error| error.to_string())?;
    let program = folder.join("bin/cargo-deny");
    if !program.is_file() {
        let mut install = command("cargo");
        install.args(["install", "--locked", "--debug", "--root"]).arg(&folder);
        step("cargo-deny", install.arg(format!("cargo-deny@{VERSION}")))?;
    }
    Ok(program)
}

/// Returns the licences that `deny.toml` allows, in the order of preference.
pub fn allowed_licences() -> Result<Vec<String>> {
    let table: toml::Table =
        crate::inputs::text("deny.toml")?.parse().map_err(|error| format!("deny.toml: {error}"))?;
    let allowed = table.get("licenses").and_then(|licences| licences.get("allow")?.as_array());
    let allowed = allowed.ok_or("deny.toml: [licenses] allow is missing")?;
    Ok(allowed.iter().filter_map(|licence| licence.as_str().map(str::to_owned)).collect())
}
