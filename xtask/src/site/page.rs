//! Pages of the repository as pages of the site: the same text, whose links lead to the places of the files on the site.

use std::collections::BTreeSet;

use super::examples;
use crate::shell::{Result, root};

/// Folder of the site with the files outside `docs/` that pages link to.
const REPOSITORY: &str = "repository";

/// A page for the site.
pub struct Page {
    /// Text in Markdown.
    pub text: String,
    /// Files of the repository that it links to or shows.
    pub linked: BTreeSet<String>,
}

/// Returns the place of a file of the repository on the site: the files of `docs/` are at the root.
pub fn place(file: &str) -> String {
    if file == examples::LIST {
        return examples::PAGE.to_owned();
    }
    file.strip_prefix("docs/").map_or_else(|| format!("{REPOSITORY}/{file}"), str::to_owned)
}

/// Returns a page of the repository for the site, from its path and its text. `is_made` states which places of the site have no file in
/// the repository. Fails with the line of a link to a missing file.
pub fn of_repository(file: &str, text: &str, is_made: impl Fn(&str) -> bool) -> Result<Page> {
    let mut page = Page { text: String::with_capacity(text.len()), linked: BTreeSet::new() };
    let mut block: Option<Block> = None;
    for (number, line) in (1..).zip(text.lines()) {
        let written = match (&block, fence(line)) {
            (None, Some(info)) => {
                let (block_begins, line) = Block::begin(line, info);
                block = Some(block_begins);
                Some(line)
            }
            (Some(_), Some("")) => {
                block = None;
                Some(line.to_owned())
            }
            (Some(block), _) => (!block.hides(line)).then(|| line.to_owned()),
            (None, None) => {
                let relinked = relinked(line, |link| resolved(file, link, &is_made, &mut page.linked));
                Some(relinked.map_err(|error| format!("{file}:{number}: {error}"))?)
            }
        };
        if let Some(line) = written {
            page.text += &line;
            page.text.push('\n');
        }
    }
    Ok(page)
}

/// A block of code.
struct Block {
    is_rust: bool,
}

impl Block {
    /// Returns the block that a line begins, and the line without what only the tests read: words after the language, except for a title.
    fn begin(line: &str, info: &str) -> (Self, String) {
        let language = info.split([',', ' ']).next().unwrap_or_default();
        let title = info.find("title=").map_or("", |at| &info[at..]);
        let indent = &line[..line.len() - line.trim_start().len()];
        let begin = format!("{indent}```{language} {title}").trim_end().to_owned();
        (Self { is_rust: language == "rust" }, begin)
    }

    /// Returns whether rustdoc hides a line.
    fn hides(&self, line: &str) -> bool {
        self.is_rust && (line == "#" || line.starts_with("# "))
    }
}

/// Returns what follows the backticks of a line that begins or ends a block of code.
fn fence(line: &str) -> Option<&str> {
    line.trim_start().strip_prefix("```").map(str::trim)
}

/// Returns a line with `target` applied to each of its links outside of code.
fn relinked(line: &str, mut target: impl FnMut(&str) -> Result<String>) -> Result<String> {
    let mut text = String::with_capacity(line.len());
    // Every second part is between backticks.
    for (number, part) in line.split('`').enumerate() {
        if number > 0 {
            text.push('`');
        }
        let mut rest = part;
        while let Some((before, link)) = rest.split_once("](").filter(|_| number % 2 == 0) {
            let (link, after) =
                link.split_once(')').ok_or_else(|| format!("\"]({link}\": close the link on its line"))?;
            text += &format!("{before}]({})", target(link)?);
            rest = after;
        }
        text += rest;
    }
    Ok(text)
}

/// Returns a link of a file for the site and adds the file that it leads to.
fn resolved(
    file: &str,
    link: &str,
    is_made: impl Fn(&str) -> bool,
    linked: &mut BTreeSet<String>,
) -> Result<String> {
    let (path, anchor) = link.split_once('#').map_or((link, None), |(path, anchor)| (path, Some(anchor)));
    if path.is_empty() || path.contains("://") || path.starts_with("mailto:") {
        return Ok(link.to_owned());
    }
    let target = joined(file, path).ok_or_else(|| format!("{link} leads out of the repository"))?;
    let place_of_target = place(&target);
    if !is_made(&place_of_target) {
        if !root().join(&target).is_file() {
            return Err(format!("{link} leads to {target}, which is no file of the repository"));
        }
        linked.insert(target);
    }
    let relative = relative(&place(file), &place_of_target);
    Ok(anchor.map_or(relative.clone(), |anchor| format!("{relative}#{anchor}")))
}

/// Returns the path that a relative link of a file leads to.
fn joined(file: &str, link: &str) -> Option<String> {
    let mut folders: Vec<&str> = file.split('/').collect();
    folders.pop();
    for part in link.split('/') {
        match part {
            "." | "" => (),
            ".." => drop(folders.pop()?),
            part => folders.push(part),
        }
    }
    Some(folders.join("/"))
}

/// Returns the relative link from a page to a file, both by their places on the site.
pub fn relative(page: &str, file: &str) -> String {
    let [from, to] = [page, file].map(|path| path.split('/').collect::<Vec<_>>());
    let folders = from.len() - 1;
    let common = from[..folders].iter().zip(&to[..to.len() - 1]).take_while(|(a, b)| a == b).count();
    let up = vec![".."; folders - common];
    up.into_iter().chain(to[common..].iter().copied()).collect::<Vec<_>>().join("/")
}

#[cfg(test)]
mod tests {
    use super::*;

    fn text(file: &str, text: &str) -> Result<String> {
        of_repository(file, text, |place| place.starts_with("learners/")).map(|page| page.text)
    }

    #[test]
    fn links_lead_to_the_places_on_the_site() {
        for (file, link, expected) in [
            ("docs/c.md", "json.md#category", "json.md#category"),
            ("docs/c.md", "../README.md", "repository/README.md"),
            ("docs/tutorials/python.md", "../python.md", "../python.md"),
            ("docs/tutorials/python.md", "../../DESIGN.md", "../repository/DESIGN.md"),
            ("docs/index.md", "learners/nanodet.md", "learners/nanodet.md"),
            ("README.md", "docs/python.md", "../python.md"),
            ("CONTRIBUTING.md", "models/README.md", "models/README.md"),
            ("models/README.md", "../README.md#use-it", "../README.md#use-it"),
            ("README.md", "#use-it", "#use-it"),
            ("README.md", "https://a.b/c.md", "https://a.b/c.md"),
        ] {
            assert_eq!(text(file, &format!("a [b]({link}), c")).unwrap(), format!("a [b]({expected}), c\n"));
        }
    }

    #[test]
    fn a_link_to_a_missing_file_is_an_error_with_its_line() {
        let error = text("docs/c.md", "a\n[b](json.md) [c](missing.md)").unwrap_err();
        assert_eq!(
            error,
            "docs/c.md:2: missing.md leads to docs/missing.md, which is no file of the repository"
        );
        assert!(text("README.md", "[a](../outside.md)").unwrap_err().contains("out of the repository"));
        assert!(text("README.md", "[a](docs").unwrap_err().contains("close the link"));
    }

    #[test]
    fn code_is_not_changed_but_for_what_only_tests_read() {
        let page = "`[a](x)`\n\n```rust,no_run\n# fn main() {\n#[derive(A)]\n#\nlet b = c[0](1);\n# }\n```\n\
                    ```python no_run title=\"a.py\"\n# comment\n```\n";
        let expected = "`[a](x)`\n\n```rust\n#[derive(A)]\nlet b = c[0](1);\n```\n\
                        ```python title=\"a.py\"\n# comment\n```\n";
        assert_eq!(text("README.md", page).unwrap(), expected);
    }

    #[test]
    fn linked_files_are_those_of_the_repository() {
        let page =
            of_repository("docs/c.md", "[a](json.md) [b](../LICENSE#x) [c](https://d.e)", |_| false).unwrap();
        assert_eq!(page.linked.into_iter().collect::<Vec<_>>(), ["LICENSE", "docs/json.md"]);
    }
}
