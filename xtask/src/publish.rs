//! `cargo xtask publish`: the crates that users depend on, each after those that it needs.

use std::collections::BTreeSet;
use std::fs;
use std::path::{Component, Path, PathBuf};

use serde_json::Value;

use crate::shell::{Result, command, output, root, step, target};

/// Size that a published crate is refused above, in bytes.
const LARGEST: u64 = 10_000_000;

/// What a published crate states about itself.
const STATED: [&str; 6] = ["description", "license", "repository", "readme", "keywords", "categories"];

/// A crate to publish.
struct Crate {
    name: String,
    folder: PathBuf,
    /// Names of the crates of the workspace that must be published before it.
    needs: BTreeSet<String>,
}

/// Checks the crates and packs them; without `dry_run`, also publishes those whose version is not published yet.
pub fn run(dry_run: bool) -> Result<()> {
    let crates = ordered(crates()?)?;
    for one in &crates {
        check_files(one)?;
    }
    pack(&crates)?;
    if dry_run {
        return Ok(());
    }
    for one in crates.iter().filter(|one| !is_published(&one.name)) {
        step(
            &format!("publication of {}", one.name),
            command("cargo").args(["publish", "--locked", "--package", &one.name]),
        )?;
    }
    Ok(())
}

/// Returns the crates of the workspace that are published. Fails if one does not state what it must.
fn crates() -> Result<Vec<Crate>> {
    let mut metadata = command("cargo");
    let metadata = output(metadata.args(["metadata", "--no-deps", "--offline", "--format-version", "1"]))?;
    let metadata: Value =
        serde_json::from_str(&metadata).map_err(|error| format!("cargo metadata: {error}"))?;
    let packages = || metadata["packages"].as_array().into_iter().flatten();
    let is_published = |about: &Value| about["publish"].is_null();
    let published: BTreeSet<_> =
        packages().filter(|about| is_published(about)).map(|about| text(&about["name"])).collect();
    packages().filter(|about| is_published(about)).map(|about| of(about, &published)).collect()
}

fn of(about: &Value, published: &BTreeSet<String>) -> Result<Crate> {
    let name = text(&about["name"]);
    for field in STATED {
        let is_stated = about[field].as_str().is_some_and(|text| !text.is_empty())
            || about[field].as_array().is_some_and(|list| !list.is_empty());
        if !is_stated {
            return Err(format!(
                "{name}: {field} is missing; add \"{field}.workspace = true\" to its manifest"
            ));
        }
    }
    let version = format!("^{}", text(&about["version"]));
    let mut needs = BTreeSet::new();
    for dependency in about["dependencies"].as_array().into_iter().flatten() {
        if dependency["path"].is_null() {
            continue;
        }
        let (other, asked) = (text(&dependency["name"]), text(&dependency["req"]));
        let is_for_tests = dependency["kind"] == "dev";
        match asked.as_str() {
            // Cargo leaves these out of what it publishes.
            "*" if is_for_tests => continue,
            _ if !published.contains(&other) => {
                return Err(format!("{name} depends on {other}, which is not published"));
            }
            _ if asked != version => {
                return Err(format!(
                    "{name} asks for {other} {asked}, not {version}; see [workspace.dependencies]"
                ));
            }
            _ => needs.insert(other),
        };
    }
    let manifest = PathBuf::from(text(&about["manifest_path"]));
    Ok(Crate { name, folder: manifest.parent().unwrap_or(Path::new("/")).to_owned(), needs })
}

/// Returns the crates, each after those that it needs. Fails if crates need each other.
fn ordered(mut waiting: Vec<Crate>) -> Result<Vec<Crate>> {
    let mut ordered: Vec<Crate> = Vec::new();
    while !waiting.is_empty() {
        let is_ready =
            |one: &Crate| one.needs.iter().all(|need| ordered.iter().any(|done| done.name == *need));
        let Some(ready) = waiting.iter().position(is_ready) else {
            let left: Vec<_> = waiting.iter().map(|one| one.name.as_str()).collect();
            return Err(format!(
                "these crates need each other, through their tests too: {}; a crate of one's tests may have a path without a version",
                left.join(", ")
            ));
        };
        ordered.push(waiting.remove(ready));
    }
    Ok(ordered)
}

/// Fails if a packed crate lacks a file that its sources include, or has one that is for tests.
fn check_files(one: &Crate) -> Result<()> {
    let mut list = command("cargo");
    let listed =
        output(list.args(["package", "--list", "--offline", "--allow-dirty", "--package", &one.name]))?;
    let files: BTreeSet<_> = listed.lines().collect();
    for file in &files {
        if file.starts_with("tests/") || file.starts_with("benches/") {
            return Err(format!(
                "{}: {file} is for tests; add \"exclude.workspace = true\" to its manifest",
                one.name
            ));
        }
        if !file.ends_with(".rs") || file.ends_with("tests.rs") || file.contains("/tests/") {
            continue;
        }
        let source = one.folder.join(file);
        let source = fs::read_to_string(&source).map_err(|error| format!("{}: {error}", source.display()))?;
        for included in included(&source) {
            let path = normal(&Path::new(file).parent().unwrap_or(Path::new("")).join(included));
            if !path.to_str().is_some_and(|path| files.contains(path)) {
                return Err(format!(
                    "{}: {file} includes {included}, which is not in the published crate",
                    one.name
                ));
            }
        }
    }
    Ok(())
}

/// Returns the paths that a source includes outside of its tests.
fn included(source: &str) -> Vec<&str> {
    let code = source.split("#[cfg(test)]").next().unwrap_or_default();
    let mut found = Vec::new();
    let mut is_for_tests = false;
    for line in code.lines() {
        if let Some(rest) = ["include_str!(\"", "include_bytes!(\""]
            .iter()
            .find_map(|call| line.split_once(call))
            .map(|(_, rest)| rest)
            && !is_for_tests
        {
            found.extend(rest.split('"').next());
        }
        is_for_tests = line.contains("#[cfg(doctest)]");
    }
    found
}

/// Returns a relative path without `..` where that is possible.
fn normal(path: &Path) -> PathBuf {
    path.components().fold(PathBuf::new(), |mut normal, part| {
        if !(part == Component::ParentDir && normal.pop()) {
            normal.push(part);
        }
        normal
    })
}

/// Packs the crates as they would be published. Fails if one is too large.
fn pack(crates: &[Crate]) -> Result<()> {
    let mut package = command("cargo");
    package.args(["package", "--locked", "--no-verify", "--allow-dirty", "--quiet"]);
    package.args(crates.iter().flat_map(|one| ["--package", one.name.as_str()]));
    step("crates", &mut package)?;
    let version = env!("CARGO_PKG_VERSION");
    let (mut whole, mut largest) = (0, (0, ""));
    for one in crates {
        let path = target().join(format!("package/{}-{version}.crate", one.name));
        let size =
            fs::metadata(root().join(&path)).map_err(|error| format!("{}: {error}", path.display()))?.len();
        if size > LARGEST {
            return Err(format!("{}: {size} bytes, above the limit of {LARGEST}", path.display()));
        }
        whole += size;
        largest = largest.max((size, &one.name));
    }
    println!(
        "{} crates in this order, {:.2} MB, the largest {:.2} MB ({}):",
        crates.len(),
        whole as f64 / 1e6,
        largest.0 as f64 / 1e6,
        largest.1
    );
    for one in crates {
        println!("  {}", one.name);
    }
    Ok(())
}

/// Returns whether the registry has the version of a crate. Outside of the workspace, since cargo prefers the crate in it.
fn is_published(name: &str) -> bool {
    let mut info = command("cargo");
    info.current_dir(std::env::temp_dir()).args(["info", "--quiet"]);
    output(info.arg(format!("{name}@{}", env!("CARGO_PKG_VERSION")))).is_ok()
}

fn text(value: &Value) -> String {
    value.as_str().unwrap_or_default().to_owned()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn crates_follow_what_they_need() {
        let one = |name: &str, needs: &[&str]| Crate {
            name: name.to_owned(),
            folder: PathBuf::new(),
            needs: needs.iter().map(|&need| need.to_owned()).collect(),
        };
        let names: Vec<_> =
            ordered(vec![one("top", &["middle", "base"]), one("middle", &["base"]), one("base", &[])])
                .unwrap()
                .into_iter()
                .map(|one| one.name)
                .collect();
        assert_eq!(names, ["base", "middle", "top"]);
        assert!(ordered(vec![one("a", &["b"]), one("b", &["a"])]).is_err());
    }

    #[test]
    fn finds_what_a_source_includes() {
        let source = "const A: &str = include_str!(\"a.txt\");\n#[cfg(doctest)]\n#[doc = include_str!(\"b.md\")]\n\
                      #[cfg(test)]\nmod tests { include_bytes!(\"c\") }";
        assert_eq!(included(source), ["a.txt"]);
        assert_eq!(normal(Path::new("src/x/../../models/a.txt")), Path::new("models/a.txt"));
    }

    #[test]
    fn every_published_crate_states_what_it_must() {
        let crates = ordered(crates().unwrap()).unwrap();
        assert!(crates.len() > 50, "{}", crates.len());
    }
}
