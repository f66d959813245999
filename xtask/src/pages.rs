//! The generated parts of README.md, DESIGN.md, docs/architecture.md, docs/models.md and docs/opendr.md: the tables of the crates, the
//! models and OpenDR's classes, and the diagram of the layers.

use std::collections::BTreeSet;
use std::fs;

use crate::inputs;
use crate::layers::Layers;
use crate::models::Models;
use crate::opendr::Opendr;
use crate::shell::{Result, root};
use crate::workspace::{Package, packages};

/// Longest title of a crate, in characters.
const LONGEST_TITLE: usize = 100;

/// Writes the generated parts.
pub fn write() -> Result<()> {
    for (file, page) in pages()? {
        fs::write(root().join(file), page).map_err(|error| format!("{file}: {error}"))?;
    }
    Ok(())
}

/// Returns whether a file decides what the generated parts contain.
pub fn is_input(file: &str) -> bool {
    let is_card = file.starts_with("models/") && file.ends_with(".toml");
    is_card || ["Cargo.toml", "src/lib.rs", "src/main.rs"].iter().any(|end| file.ends_with(end))
}

/// Returns the pages with their generated parts.
fn pages() -> Result<[(&'static str, String); 5]> {
    let (packages, layers) = (packages()?, Layers::read()?);
    let packages = ordered(&packages, &layers);
    let (models, opendr) = (Models::read()?, Opendr::read()?);
    let with = |file: &'static str, parts: &[(&str, String)]| {
        let mut page = inputs::text(file)?;
        for (part, text) in parts {
            page = replaced(&page, part, text).map_err(|error| format!("{file}: {error}"))?;
        }
        Ok::<_, String>((file, page))
    };
    Ok([
        with("README.md", &[("models", models.overview()), ("crates", table(&packages)?)])?,
        with("DESIGN.md", &[("layers", diagram(&packages))])?,
        with("docs/architecture.md", &[("layers", diagram(&packages))])?,
        with("docs/models.md", &[("models", models.tables(&opendr.learners))])?,
        with("docs/opendr.md", &[("opendr", opendr.tables(&models)?)])?,
    ])
}

/// Returns the crates in the order of the layers, each with its layer.
fn ordered<'a>(packages: &'a [Package], layers: &'a Layers) -> Vec<(&'a str, &'a Package)> {
    let places = layers.places().iter();
    let found = places.filter_map(|place| {
        let package = packages.iter().find(|package| package.name == place.name)?;
        Some((place.layer.as_str(), package))
    });
    found.collect()
}

/// Returns a page with `text` between the marker comments of a part.
fn replaced(page: &str, part: &str, text: &str) -> Result<String> {
    let begin = format!("<!-- {part}: written by `cargo xtask generate` -->\n");
    let end = format!("<!-- end of {part} -->");
    let (before, rest) = page.split_once(&begin).ok_or_else(|| format!("write a line {:?}", begin.trim()))?;
    let (_, after) = rest.split_once(&end).ok_or_else(|| format!("write a line {end:?}"))?;
    Ok(format!("{before}{begin}{text}{end}{after}"))
}

/// Returns the table of the crates: folder and title.
fn table(packages: &[(&str, &Package)]) -> Result<String> {
    let mut table = "\n| crate | contents |\n|---|---|\n".to_owned();
    for (_, package) in packages {
        let source = package.roots.first().ok_or_else(|| format!("{}: no source file", package.folder))?;
        let text = inputs::text(source)?;
        let title = title(&text).ok_or_else(|| {
            format!("{source}: begin with a line `//! TITLE.` of at most {LONGEST_TITLE} characters: the table of the crates shows it")
        })?;
        table += &format!("| `{}` | {} |\n", package.folder, title.replace('|', "\\|"));
    }
    Ok(table + "\n")
}

/// Returns the first line of a crate's documentation, if it is a title: one sentence on one line.
fn title(source: &str) -> Option<&str> {
    let title = source.lines().find_map(|line| line.strip_prefix("//!"))?.trim();
    let is_sentence = title.ends_with('.') && title.chars().count() <= LONGEST_TITLE;
    is_sentence.then(|| title.trim_end_matches('.'))
}

/// Returns the Mermaid diagram of the layers. A dependency that follows from others is left out.
fn diagram(packages: &[(&str, &Package)]) -> String {
    let mut diagram = "\n```mermaid\nflowchart TB\n".to_owned();
    let mut layers: Vec<&str> = packages.iter().map(|(layer, _)| *layer).collect();
    layers.dedup();
    for (number, layer) in layers.iter().enumerate().rev() {
        diagram += &format!("  subgraph layer{number}[\"{layer}\"]\n");
        for (_, package) in packages.iter().filter(|(of, _)| of == layer) {
            let name = package.name.trim_start_matches("opendr-");
            diagram += &format!("    {}[\"{name}\"]\n", package.name);
        }
        diagram += "  end\n";
    }
    for (_, package) in packages.iter().rev() {
        let dependencies = direct(package, packages);
        if !dependencies.is_empty() {
            let list: Vec<_> = dependencies.into_iter().collect();
            diagram += &format!("  {} --> {}\n", package.name, list.join(" & "));
        }
    }
    diagram + "```\n\n"
}

/// Returns the crates of the workspace that a crate depends on and that none of its other dependencies depends on.
fn direct<'a>(package: &'a Package, packages: &[(&str, &'a Package)]) -> BTreeSet<&'a str> {
    let dependencies = own(package, packages);
    let indirect: BTreeSet<_> =
        dependencies.iter().flat_map(|dependency| below(dependency, packages)).collect();
    dependencies
        .iter()
        .map(|dependency| dependency.name.as_str())
        .filter(|name| !indirect.contains(name))
        .collect()
}

/// Returns the names of all crates that a crate depends on, directly or not.
fn below<'a>(package: &'a Package, packages: &[(&str, &'a Package)]) -> BTreeSet<&'a str> {
    let mut names = BTreeSet::new();
    let mut waiting = own(package, packages);
    while let Some(dependency) = waiting.pop() {
        if names.insert(dependency.name.as_str()) {
            waiting.extend(own(dependency, packages));
        }
    }
    names
}

/// Returns the crates of the workspace that a crate names as dependencies.
fn own<'a>(package: &Package, packages: &[(&str, &'a Package)]) -> Vec<&'a Package> {
    let all = packages.iter().map(|(_, package)| *package);
    all.filter(|other| package.dependencies.contains(&other.name)).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn generated_parts_are_up_to_date() {
        for (file, page) in pages().unwrap() {
            assert!(
                inputs::text(file).unwrap() == page,
                "{file} is not up to date; run `cargo xtask generate --crates`"
            );
        }
    }

    #[test]
    fn only_the_generated_part_is_replaced() {
        let page = "a\n<!-- x: written by `cargo xtask generate` -->\nold\n<!-- end of x -->\nb\n";
        assert_eq!(replaced(page, "x", "new\n").unwrap(), page.replace("old", "new"));
        assert!(replaced("a\n", "x", "").unwrap_err().contains("written by"));
        assert!(replaced(&page.replace("end", "ende"), "x", "").unwrap_err().contains("end of x"));
    }

    #[test]
    fn a_title_is_a_sentence_on_one_line() {
        assert_eq!(title("#![allow(x)]\n//! Boxes and masks.\n//!\n//! More."), Some("Boxes and masks"));
        assert_eq!(title("//! Boxes and\n//! masks."), None);
        assert_eq!(title(&format!("//! {}.", "a".repeat(100))), None);
        assert_eq!(title("fn main() {}"), None);
    }

    #[test]
    fn the_diagram_leaves_out_what_follows() {
        let package = |name: &str, dependencies: &[&str]| Package {
            name: format!("opendr-{name}"),
            folder: String::new(),
            roots: Vec::new(),
            dependencies: dependencies.iter().map(|name| format!("opendr-{name}")).collect(),
        };
        let [a, b, c] = [package("a", &[]), package("b", &["a"]), package("c", &["a", "b", "serde"])];
        let diagram = diagram(&[("low", &a), ("low", &b), ("high", &c)]);
        let arrows: Vec<_> = diagram.lines().filter(|line| line.contains("-->")).collect();
        assert_eq!(arrows, ["  opendr-c --> opendr-b", "  opendr-b --> opendr-a"]);
        let boxes: Vec<_> = diagram.lines().filter(|line| line.contains('[')).collect();
        let expected = [
            "  subgraph layer1[\"high\"]",
            "    opendr-c[\"c\"]",
            "  subgraph layer0[\"low\"]",
            "    opendr-a[\"a\"]",
            "    opendr-b[\"b\"]",
        ];
        assert_eq!(boxes, expected);
    }
}
