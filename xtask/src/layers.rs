//! `cargo xtask layers`: checks that no crate depends on a higher layer, and that no two files of a crate import each other, except
//! pairs of a list.

use crate::imports::{self, Import, Pair};
use crate::inputs;
use crate::shell::Result;
use crate::workspace::{Package, packages};

/// The table of layers.
const TABLE: &str = "xtask/layers.tsv";

/// The list of pairs of files that may import each other.
const ALLOWED: &str = "xtask/mutual_imports.tsv";

/// Folder of the Python package, and the package in it.
const PYTHON: (&str, &str) = ("bindings/python/python", "bindings/python/python/opendr/");

/// Prints every violation with both of its lines; fails if there is one.
pub fn run() -> Result<()> {
    let packages = packages()?;
    let layers = Layers::read()?;
    let upwards = layers.violations(&packages, &line_of);
    let mutual = mutual_imports(&pairs(&packages)?, &inputs::text(ALLOWED)?)?;
    for violation in upwards.iter().chain(&mutual) {
        println!("{violation}\n");
    }
    match (upwards.len(), mutual.len()) {
        (0, 0) => Ok(()),
        (upwards, mutual) => Err(format!(
            "{upwards} dependencies that do not point downwards in {TABLE}, and {mutual} differences between {ALLOWED} and the files \
             that import each other; move the item that both sides need to the lower crate, or to the file that owns it"
        )),
    }
}

/// Returns whether a file of the repository is an input of this check.
pub fn is_input(file: &str) -> bool {
    file.ends_with(".rs")
        || file.ends_with("Cargo.toml")
        || [TABLE, ALLOWED].contains(&file)
        || is_of_python(file)
}

fn is_of_python(file: &str) -> bool {
    file.starts_with(PYTHON.1) && file.ends_with(".py")
}

/// Returns the pairs of files that import each other, of every crate and of the Python package.
fn pairs(packages: &[Package]) -> Result<Vec<Pair>> {
    let read = |file: &str| inputs::text(file).ok();
    let mut found = Vec::new();
    for source in packages.iter().flat_map(|package| &package.roots) {
        found.extend(imports::pairs(&imports::of_crate(source, &read)));
    }
    let modules = inputs::files()?.into_iter().filter(|file| is_of_python(file));
    let modules: Vec<_> = modules.filter_map(|file| read(&file).map(|text| (file, text))).collect();
    found.extend(imports::pairs(&imports::of_python(PYTHON.0, &modules)));
    Ok(found)
}

/// Describes every pair that the list does not have, and every line of the list whose files do not import each other.
fn mutual_imports(pairs: &[Pair], list: &str) -> Result<Vec<String>> {
    let mut allowed = Vec::new();
    for (line, text) in (1..).zip(list.lines()).filter(|(_, text)| !text.starts_with('#')) {
        let [first, second, reason] = text.split('\t').collect::<Vec<_>>()[..] else {
            return Err(format!(
                "{ALLOWED}:{line}: write two files and how to separate them, with tabs between"
            ));
        };
        if first >= second || reason.is_empty() {
            return Err(format!(
                "{ALLOWED}:{line}: write the files in the order of their paths, and a reason"
            ));
        }
        allowed.push((line, first, second));
    }
    let is_of = |pair: &Pair, first: &str, second: &str| pair.0.from == first && pair.0.to == second;
    let unknown =
        pairs.iter().filter(|pair| !allowed.iter().any(|(_, first, second)| is_of(pair, first, second)));
    let unknown =
        unknown.map(|Pair(first, second)| format!("{}\n{}", import_line(first), import_line(second)));
    let separate =
        allowed.iter().filter(|(_, first, second)| !pairs.iter().any(|pair| is_of(pair, first, second)));
    let separate = separate.map(|(line, first, second)| {
        format!("{ALLOWED}:{line}: remove the line: {first} and {second} do not import each other")
    });
    Ok(unknown.chain(separate).collect())
}

fn import_line(import: &Import) -> String {
    format!("{}:{}: {}", import.from, import.line, import.path)
}

/// Returns the first line of a file that contains a text, as `file:line: text`.
fn line_of(file: &str, text: &str) -> String {
    let content = inputs::text(file).unwrap_or_default();
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
        Self::parse(&inputs::text(TABLE)?)
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
    fn only_listed_pairs_import_each_other() {
        let import = |from: &str, to: &str| Import {
            from: from.to_owned(),
            to: to.to_owned(),
            line: 3,
            path: format!("use crate::{to}"),
        };
        let pairs = [Pair(import("a", "b"), import("b", "a"))];
        assert!(mutual_imports(&pairs, "# comment\na\tb\tmove it\n").unwrap().is_empty());
        assert_eq!(mutual_imports(&pairs, "").unwrap(), ["a:3: use crate::b\nb:3: use crate::a"]);
        let stale = mutual_imports(&pairs, "a\tb\tmove it\na\tc\tmove it").unwrap();
        assert_eq!(stale, ["xtask/mutual_imports.tsv:2: remove the line: a and c do not import each other"]);
        for list in ["a\tb", "b\ta\tmove it", "a\tb\t"] {
            assert!(mutual_imports(&pairs, list).unwrap_err().starts_with("xtask/mutual_imports.tsv:1: "));
        }
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
