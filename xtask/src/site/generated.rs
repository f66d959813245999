//! Parts of the generated files: `docs/learners.md`, `docs/models.md`, `docs/ros_topics.md`, the C header, and the stubs of Python.

use std::collections::BTreeMap;

use crate::inputs;
use crate::shell::Result;

/// An input of a learner.
#[derive(Debug, PartialEq)]
pub struct Port {
    /// Name of the port.
    pub name: String,
    /// Type of its values.
    pub kind: String,
    /// Whether it must be given.
    pub required: bool,
}

/// A section of `docs/learners.md`.
pub struct Section<'a> {
    /// What the learner does.
    pub about: &'a str,
    /// The sentence with inputs and outputs.
    pub signature: &'a str,
    /// The tables of its parameters.
    pub tables: Vec<&'a str>,
}

impl Section<'_> {
    /// Returns the inputs.
    pub fn inputs(&self) -> Vec<Port> {
        let takes = self.signature.split("; returns ").next().unwrap_or_default();
        let ports = names(takes).map(|(name, note)| {
            let kind = note.split(',').next().unwrap_or_default();
            Port { name: name.to_owned(), kind: kind.to_owned(), required: !note.contains(", optional") }
        });
        ports.collect()
    }

    /// Returns the names of the outputs.
    pub fn outputs(&self) -> Vec<String> {
        let returns = self.signature.split("; returns ").nth(1).unwrap_or_default();
        names(returns).map(|(name, _)| name.to_owned()).collect()
    }
}

/// Returns each name between backticks with what is in the parentheses after it.
fn names(list: &str) -> impl Iterator<Item = (&str, &str)> {
    list.split("), ").filter_map(|part| {
        let (_, rest) = part.split_once('`')?;
        let (name, rest) = rest.split_once("` (")?;
        Some((name, rest.split(')').next().unwrap_or(rest)))
    })
}

/// Returns the sections of `docs/learners.md` by the learner's name.
pub fn sections(page: &str) -> BTreeMap<&str, Section<'_>> {
    let found = page.split("\n### ").skip(1).filter_map(|text| {
        let text = text.split("\n## ").next().unwrap_or(text);
        let mut parts = text.trim_end().split("\n\n");
        let name = parts.next()?.split('`').nth(1)?;
        Some((name, Section { about: parts.next()?, signature: parts.next()?, tables: parts.collect() }))
    });
    found.collect()
}

/// Returns the rows of a page's tables whose first cell is wanted.
pub fn rows_of(page: &str, is_wanted: impl Fn(&str) -> bool) -> Vec<String> {
    let rows = page.lines().filter(|line| {
        let cell = line.strip_prefix("| ").and_then(|line| line.split(" |").next());
        cell.is_some_and(&is_wanted)
    });
    rows.map(|row| format!("{row}\n")).collect()
}

/// Returns the rows of a learner's topics without its name: the named row, and those below it without a name.
pub fn topics_of(page: &str, name: &str) -> Vec<String> {
    let begin = format!("| `{name}` |");
    let mut lines = page.lines().skip_while(|line| !line.starts_with(&begin));
    let first = lines.next();
    let rows = first.into_iter().chain(lines.take_while(|line| line.starts_with("|  |")));
    rows.filter_map(|row| Some(format!("|{}\n", row.strip_prefix("| ")?.split_once('|')?.1))).collect()
}

/// Returns the C declarations that load and run a learner.
pub fn declarations(header: &str, name: &str) -> Option<String> {
    let of = |function: &str| {
        let begin = header.find(&format!("static inline opendr_status opendr_{function}_{name}("))?;
        let length = header[begin..].find(" {")?;
        Some(header[begin..begin + length].trim_start_matches("static inline ").to_owned() + ";")
    };
    Some(format!("#include <opendr.h>\n\n{}\n\n{}", of("load")?, of("infer")?))
}

/// Returns the modules of the Python classes, from their stubs.
pub fn modules() -> Result<BTreeMap<String, String>> {
    let folder = "bindings/python/python/";
    let mut modules = BTreeMap::new();
    for file in inputs::files()? {
        let Some(module) = file.strip_prefix(folder).and_then(|path| path.strip_suffix(".pyi")) else {
            continue;
        };
        for line in inputs::text(&file)?.lines() {
            if let Some((class, _)) = line.strip_prefix("class ").and_then(|line| line.split_once(['(', ':']))
            {
                modules.insert(class.to_owned(), module.replace('/', "."));
            }
        }
    }
    Ok(modules)
}

#[cfg(test)]
mod tests {
    use super::*;

    const PAGE: &str = "# Learners\n\nText.\n\n## tasks_2d\n\n### ALearner: `a`\n\nFinds `b`.\n\nTakes `image` (Image), \
                        `box` (Box, with the first input of a stream), `depth` (Image, optional); returns `boxes` (BoxList), `map` (Map).\n\n\
                        | parameter |\n|---|\n| `x` |\n\n| parameter of `fit` |\n|---|\n\n## other\n\n### BLearner: `b`\n\nB.\n\n\
                        Takes `c` (C); returns `d` (D).\n\n| parameter |\n|---|\n";

    #[test]
    fn a_section_ends_where_the_next_begins() {
        let sections = sections(PAGE);
        assert_eq!(sections.keys().collect::<Vec<_>>(), [&"a", &"b"]);
        let a = &sections["a"];
        assert_eq!(a.about, "Finds `b`.");
        assert_eq!(a.tables, ["| parameter |\n|---|\n| `x` |", "| parameter of `fit` |\n|---|"]);
        let port = |name: &str, kind: &str, required| Port { name: name.into(), kind: kind.into(), required };
        assert_eq!(
            a.inputs(),
            [port("image", "Image", true), port("box", "Box", true), port("depth", "Image", false)]
        );
        assert_eq!(a.outputs(), ["boxes", "map"]);
        assert_eq!(sections["b"].inputs(), [port("c", "C", true)]);
    }

    #[test]
    fn rows_of_topics_are_those_below_the_name() {
        let page =
            "| `a` | `x` | `X` | `y` | `Y` |\n|  | `z` | `Z` |  |  |\n| `ab` | `q` | `Q` | `r` | `R` |\n";
        assert_eq!(topics_of(page, "a"), ["| `x` | `X` | `y` | `Y` |\n", "| `z` | `Z` |  |  |\n"]);
        assert_eq!(topics_of(page, "ab"), ["| `q` | `Q` | `r` | `R` |\n"]);
    }

    #[test]
    fn declarations_are_those_of_the_header() {
        let header = "static inline opendr_status opendr_load_a(const char *path) {\n}\n\
                      static inline opendr_status opendr_infer_a(int a,\n    int b) {\n}\n";
        let expected = "#include <opendr.h>\n\nopendr_status opendr_load_a(const char *path);\n\n\
                        opendr_status opendr_infer_a(int a,\n    int b);";
        assert_eq!(declarations(header, "a").unwrap(), expected);
        assert_eq!(declarations(header, "b"), None);
    }
}
