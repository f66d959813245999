//! `cargo xtask layers`: checks that no crate depends on a higher layer, and that no two files of a crate import each other.

use std::fs;

use crate::imports::{self, Import, Pair};
use crate::inputs;
use crate::shell::{Result, root};
use crate::workspace::{Package, packages};

/// The table of layers.
const TABLE: &str = "xtask/layers.tsv";

/// Folder of the Python package, and the package in it.
const PYTHON: (&str, &str) = ("bindings/python/python", "bindings/python/python/opendr/");

/// Prints every violation with both of its lines; fails if there is one.
pub fn run() -> Result<()> {
    let packages = packages()?;
    let layers = Layers::read()?;
    let upwards = layers.violations(&packages, &line_of);
    let pairs = pairs(&packages)?;
    for violation in &upwards {
        println!("{violation}\n");
    }
    for Pair(first, second) in &pairs {
        println!("{}\n{}\n", import_line(first), import_line(second));
    }
    match (upwards.len(), pairs.len()) {
        (0, 0) => Ok(()),
        (upwards, pairs) => Err(format!(
            "{upwards} dependencies that do not point downwards in {TABLE}, and {pairs} pairs of files that import each other; move \
             the item that both sides need to the lower crate, or to the file that owns it"
        )),
    }
}

/// Returns whether a file of the repository is an input of this check.
pub fn is_input(file: &str) -> bool {
    file.ends_with(".rs") || file.ends_with("Cargo.toml") || file == TABLE || is_of_python(file)
}

fn is_of_python(file: &str) -> bool {
    file.starts_with(PYTHON.1) && file.ends_with(".py")
}

/// Returns the pairs of files that import each other, of every crate and of the Python package.
fn pairs(packages: &[Package]) -> Result<Vec<Pair>> {
    let read = |file: &str| fs::read_to_string(root().join(file)).ok();
    let mut found = Vec::new();
    for source in packages.iter().flat_map(|package| &package.roots) {
        found.extend(imports::pairs(&imports::of_crate(source, &read)));
    }
    let modules = inputs::files()?.into_iter().filter(|file| is_of_python(file));
    let modules: Vec<_> = modules.filter_map(|file| read(&file).map(|text| (file, text))).collect();
    found.extend(imports::pairs(&imports::of_python(PYTHON.0, &modules)));
    Ok(found)
}

fn import_line(import: &Import) -> String {
    format!("{}:{}: {}", import.from, import.line, import.path)
}

/// Returns the first line of a file that contains a text, as `file:line: text`.
fn line_of(file: &str, text: &str) -> String {
    let content = fs::read_to_string(root().join(file)).unwrap_or_default();
    let line = (1..).zip(content.lines()).find(|(_, line)| line.contains(text));
    line.map_or_else(
        || format!("{file}: {text}"),
        |(number, line)| format!("{file}:{number}: {}", line.trim()),
    )
}

/// The crates of the workspace in the order of the layers, from the bottom to the top.
pub struct Layers(Vec<Place>);

/// The place of a crate in the layers.
pub struct Place {
    /// Name of the layer.
    pub layer: String,
    /// Name of the crate.
    pub name: String,
    /// Line in the table.
    line: usize,
}

impl Layers {
    /// Reads the table.
    pub fn read() -> Result<Self> {
        Self::parse(&fs::read_to_string(root().join(TABLE)).map_err(|error| format!("{TABLE}: {error}"))?)
    }

    fn parse(table: &str) -> Result<Self> {
        let mut places: Vec<Place> = Vec::new();
        for (line, text) in (1..).zip(table.lines()).filter(|(_, text)| !text.starts_with('#')) {
            let (layer, name) = text.split_once('\t').ok_or_else(|| {
                format!("{TABLE}:{line}: write the name of a layer, a tab and the name of a crate")
            })?;
            if places.iter().any(|place| place.name == name) {
                return Err(format!("{TABLE}:{line}: {name} is listed twice; remove one of the lines"));
            }
            let is_new = places.last().is_some_and(|last| last.layer != layer);
            if is_new && places.iter().any(|place| place.layer == layer) {
                return Err(format!(
                    "{TABLE}:{line}: move the crate to the other crates of the layer {layer:?}"
                ));
            }
            places.push(Place { layer: layer.to_owned(), name: name.to_owned(), line });
        }
        Ok(Self(places))
    }

    /// Returns the crates from the bottom to the top.
    pub fn places(&self) -> &[Place] {
        &self.0
    }

    fn position(&self, name: &str) -> Option<usize> {
        self.0.iter().position(|place| place.name == name)
    }

    /// Describes every dependency between crates of the workspace that does not point downwards, and every difference between table and
    /// workspace. `line_of` returns the line of a file with a text.
    fn violations(&self, packages: &[Package], line_of: &dyn Fn(&str, &str) -> String) -> Vec<String> {
        let mut violations = Vec::new();
        for package in packages {
            let manifest = format!("{}/Cargo.toml", package.folder);
            let Some(position) = self.position(&package.name) else {
                violations.push(format!("{manifest}: add a line for {} to {TABLE}", package.name));
                continue;
            };
            for dependency in &package.dependencies {
                let Some(lower) = self.position(dependency) else { continue };
                if lower >= position {
                    let place = |position: usize| {
                        let Place { layer, name, line } = &self.0[position];
                        format!("{TABLE}:{line}: {layer}: {name}")
                    };
                    let dependency = line_of(&manifest, dependency);
                    violations.push(format!("{dependency}\n{}\n{}", place(position), place(lower)));
                }
            }
        }
        for place in &self.0 {
            if !packages.iter().any(|package| package.name == place.name) {
                violations.push(format!("{TABLE}:{}: remove {}, which is no crate", place.line, place.name));
            }
        }
        violations
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const LAYERS: &str = "# comment\nlow\ta\nlow\tb\nhigh\tc\n";

    fn violations(dependencies: &[(&str, &[&str])]) -> Vec<String> {
        let packages: Vec<_> = dependencies
            .iter()
            .map(|(name, dependencies)| Package {
                name: (*name).to_owned(),
                folder: format!("crates/{name}"),
                roots: Vec::new(),
                dependencies: dependencies.iter().map(|name| (*name).to_owned()).collect(),
            })
            .collect();
        Layers::parse(LAYERS).unwrap().violations(&packages, &|file, text| format!("{file}:7: {text}"))
    }

    #[test]
    fn dependencies_point_downwards() {
        assert!(violations(&[("a", &["serde"]), ("b", &["a"]), ("c", &["b", "a"])]).is_empty());
        let upwards = violations(&[("a", &["c"]), ("b", &[]), ("c", &[])]);
        assert_eq!(
            upwards,
            ["crates/a/Cargo.toml:7: c\nxtask/layers.tsv:2: low: a\nxtask/layers.tsv:4: high: c"]
        );
        assert_eq!(violations(&[("a", &["b"]), ("b", &["a"]), ("c", &["c"])]).len(), 2);
    }

    #[test]
    fn the_table_lists_every_crate_once() {
        let missing = violations(&[("a", &[]), ("b", &[]), ("d", &["a"])]);
        let expected = [
            "crates/d/Cargo.toml: add a line for d to xtask/layers.tsv",
            "xtask/layers.tsv:4: remove c, which is no crate",
        ];
        assert_eq!(missing, expected);
        for (table, error) in
            [("low a", ":1: "), ("low\ta\nhigh\ta", ":2: "), ("low\ta\nhigh\tb\nlow\tc", ":3: ")]
        {
            assert!(Layers::parse(table).err().unwrap().starts_with(&format!("xtask/layers.tsv{error}")));
        }
    }
}
