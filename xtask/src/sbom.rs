//! `cargo xtask sbom`: the bill of materials of each package, in the format CycloneDX 1.6.

use std::fs;
use std::path::PathBuf;

use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::linked::{self, Build, Linked};
use crate::shell::{Result, target};
use crate::source_date::SourceDate;

/// The packages that users install: name of the file, kind, package of the workspace, features.
const PRODUCTS: [(&str, &str, &str, &[&str]); 3] = [
    ("opendr", "application", "opendr-cli", &["opendr-cli/training"]),
    ("libopendr", "library", "opendr-c", &[]),
    ("opendr-rs", "library", "opendr-python", &[]),
];

/// Writes `target/sbom/NAME.cdx.json` of each product.
pub fn run() -> Result<()> {
    let date = SourceDate::get()?;
    for (name, kind, package, features) in PRODUCTS {
        let crates = linked::crates(&Build { packages: &[package], features })?;
        let bill = bill(kind, package, &crates, date)?;
        let path = write(name, &bill)?;
        println!("{}: {} crates", path.display(), crates.len());
    }
    Ok(())
}

fn write(name: &str, bill: &Value) -> Result<PathBuf> {
    let folder = target().join("sbom");
    let path = folder.join(format!("{name}.cdx.json"));
    let text = serde_json::to_string_pretty(bill).map_err(|error| error.to_string())?;
    fs::create_dir_all(&folder)
        .and_then(|()| fs::write(&path, text + "\n"))
        .map_err(|error| format!("{}: {error}", path.display()))?;
    Ok(path)
}

/// Returns the bill of `package`, which is one of the crates. The same crates and date give the same bill.
fn bill(kind: &str, package: &str, crates: &[Linked], date: SourceDate) -> Result<Value> {
    let own = crates.iter().find(|linked| linked.name == package);
    let own = own.ok_or_else(|| format!("cargo tree: {package} is not listed"))?;
    let others = crates.iter().filter(|linked| linked.name != package);
    let edges = crates.iter().map(|linked| {
        let needed: Vec<_> =
            linked.dependencies.iter().map(|(name, version)| reference(name, version)).collect();
        json!({ "ref": reference(&linked.name, &linked.version), "dependsOn": needed })
    });
    let components: Vec<_> = others.map(|linked| component("library", linked)).collect();
    let edges: Vec<_> = edges.collect();
    let serial = serial(&json!([component(kind, own), components, date.seconds()]).to_string());
    Ok(json!({
        "bomFormat": "CycloneDX",
        "specVersion": "1.6",
        "serialNumber": serial,
        "version": 1,
        "metadata": {
            "timestamp": date.rfc3339(),
            "tools": { "components": [{ "type": "application", "name": "cargo xtask sbom", "version": env!("CARGO_PKG_VERSION") }] },
            "component": component(kind, own),
        },
        "components": components,
        "dependencies": edges,
    }))
}

fn component(kind: &str, linked: &Linked) -> Value {
    let reference = reference(&linked.name, &linked.version);
    let mut component = json!({
        "type": kind,
        "bom-ref": reference,
        "name": linked.name,
        "version": linked.version,
        "purl": reference,
    });
    if let Some(description) = &linked.description {
        component["description"] = json!(description.split_whitespace().collect::<Vec<_>>().join(" "));
    }
    component["licenses"] = if linked.licence.is_empty() {
        json!([{ "license": { "name": "see the file LICENSE of the crate" } }])
    } else {
        // The older form of OR is no expression of SPDX.
        json!([{ "expression": linked.licence.replace(" / ", " OR ").replace('/', " OR ") }])
    };
    if let Some(checksum) = &linked.checksum {
        component["hashes"] = json!([{ "alg": "SHA-256", "content": checksum }]);
    }
    if let Some(repository) = &linked.repository {
        component["externalReferences"] = json!([{ "type": "vcs", "url": repository }]);
    }
    component
}

/// Returns the package URL of a crate.
fn reference(name: &str, version: &str) -> String {
    format!("pkg:cargo/{name}@{}", version.replace('+', "%2B"))
}

/// Returns a UUID that is made of the content (version 8 of RFC 9562).
fn serial(content: &str) -> String {
    let mut bytes: Vec<u8> = Sha256::digest(content)[..16].to_vec();
    bytes[6] = bytes[6] & 0x0f | 0x80;
    bytes[8] = bytes[8] & 0x3f | 0x80;
    let hex: String = bytes.iter().map(|byte| format!("{byte:02x}")).collect();
    format!("urn:uuid:{}-{}-{}-{}-{}", &hex[..8], &hex[8..12], &hex[12..16], &hex[16..20], &hex[20..])
}
