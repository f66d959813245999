//! `cargo xtask site`: builds the documentation site.
//!
//! The pages of the repository stay where they are, and their links work on a forge too. This task copies them beside `mkdocs.yml`
//! ([`page`]), writes a page for each learner of the registry ([`learners`]) with its predictions on photographs ([`predictions`]) and one of
//! the examples ([`examples`]), and runs MkDocs, which fails on broken links, missing anchors and pages outside of the navigation.

mod examples;
mod generated;
mod learners;
mod page;
mod predictions;

use std::collections::BTreeSet;
use std::collections::btree_map::{BTreeMap, Entry};
use std::fs;
use std::path::Path;
use std::process::Command;

use crate::inputs;
use crate::shell::{Result, command, is_installed, root, step, target};
use crate::tools::{Python, requirements};
use examples::{Drawings, Examples};
use learners::Learners;
use predictions::Predictions;

/// Pages outside of `docs/`, by their paths in the repository. Further files follow from links.
const PAGES: [&str; 5] = ["README.md", "DESIGN.md", "CONTRIBUTING.md", "SECURITY.md", "CHANGELOG.md"];

/// Place in the navigation of `mkdocs.yml` where the pages of the learners are inserted.
const LEARNERS: &str = "      # learners: `cargo xtask site` lists the page of each learner here\n";

/// Package of npm with the program that draws the diagrams, without the kinds of diagrams that no page has.
const MERMAID: (&str, &str) = ("@mermaid-js/tiny", "11.17.2");

/// What the pages of the learners show.
#[derive(Clone, Copy, PartialEq)]
pub enum Show {
    /// All, with predictions on photographs by the built command.
    Everything,
    /// All but predictions, which takes seconds and needs no build: for the check of pages and links.
    Pages,
}

/// Builds the site into the folder `site` of the build folder, and prints its first page.
pub fn run(show: Show) -> Result<()> {
    let python = Python::install(&requirements("site-venv", &["xtask/site/requirements.txt"]))?;
    let source = target().join("site-source");
    let learners = Learners::read()?;
    let (predictions, drawings) = match show {
        Show::Everything => {
            let program = predictions::program()?;
            let photographs = predictions::photographs(&python)?;
            let predictions = Predictions::make(&program, &photographs, &learners.of_images())?;
            (predictions, Drawings::make(&program, &photographs)?)
        }
        Show::Pages => Default::default(),
    };
    let pages = pages(&learners, &predictions, &drawings)?;
    write(&source, &pages)?;
    predictions.copy(&source.join("docs").join(learners::FOLDER))?;
    drawings.copy(&source.join("docs"))?;
    add_mermaid(&source.join("docs/assets"))?;
    let site = target().join("site");
    step("site", &mut mkdocs(&python.program(), &source, &site))?;
    println!("{}", site.join("index.html").display());
    Ok(())
}

/// Returns the command that builds the site of a folder, and fails on warnings. It prints them: with `--quiet`, MkDocs would not count them.
fn mkdocs(python: &Path, source: &Path, site: &Path) -> Command {
    let mut mkdocs = command(python);
    mkdocs.args(["-m", "mkdocs", "build", "--strict", "--config-file"]).arg(source.join("mkdocs.yml"));
    mkdocs.arg("--site-dir").arg(site);
    // The theme's news about MkDocs.
    mkdocs.env("NO_MKDOCS_2_WARNING", "1");
    mkdocs
}

/// Returns whether a file affects the site.
pub fn is_input(file: &str) -> bool {
    let ends = [".md", ".toml", ".tsv", ".pyi", ".jpg", ".gif", ".ipynb"];
    ends.iter().any(|end| file.ends_with(end))
        || ["mkdocs.yml", "bindings/c/include/opendr.h"].contains(&file)
        || file.starts_with("xtask/")
        // Pages link to sources.
        || file.ends_with(".rs") && file.contains("/examples/")
        || file.starts_with("examples/")
}

/// The files of the site.
struct Pages {
    config: String,
    /// Texts by their places.
    texts: BTreeMap<String, String>,
    /// Other files of the repository that pages link to or show.
    files: BTreeSet<String>,
}

/// Returns the pages of the repository, of the learners and of the examples.
fn pages(learners: &Learners, predictions: &Predictions, drawings: &Drawings) -> Result<Pages> {
    let mut texts = learners.pages(predictions);
    let examples = Examples::read()?;
    texts.insert(examples::PAGE.to_owned(), examples.page(drawings, page::place));
    let config = inputs::text("mkdocs.yml")?;
    let (before, after) =
        config.split_once(LEARNERS).ok_or_else(|| format!("mkdocs.yml: write the line {LEARNERS:?}"))?;
    let config = format!("{before}{}{after}", learners.navigation());
    let made: BTreeSet<String> = texts.keys().cloned().collect();
    let of_docs =
        inputs::files()?.into_iter().filter(|file| file.starts_with("docs/") && file.ends_with(".md"));
    let mut waiting: Vec<String> = of_docs.chain(PAGES.map(str::to_owned)).collect();
    let mut files: BTreeSet<String> = examples.images().collect();
    while let Some(file) = waiting.pop() {
        let place = page::place(&file);
        if !file.ends_with(".md") {
            files.insert(file);
        } else if let Entry::Vacant(entry) = texts.entry(place) {
            let page = page::of_repository(&file, &inputs::text(&file)?, |place| made.contains(place))?;
            entry.insert(page.text);
            waiting.extend(page.linked);
        }
    }
    Ok(Pages { config, texts, files })
}

/// Writes the source of the site into a folder, in place of an earlier one.
fn write(folder: &Path, pages: &Pages) -> Result<()> {
    let failed = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    if folder.is_dir() {
        fs::remove_dir_all(folder).map_err(|error| failed(folder, error))?;
    }
    let put = |place: &str, content: &[u8]| {
        let path = folder.join(place);
        fs::create_dir_all(path.parent().unwrap_or(folder)).map_err(|error| failed(&path, error))?;
        fs::write(&path, content).map_err(|error| failed(&path, error))
    };
    put("mkdocs.yml", pages.config.as_bytes())?;
    put("theme/main.html", inputs::text("xtask/site/main.html")?.as_bytes())?;
    put("docs/assets/style.css", inputs::text("xtask/site/style.css")?.as_bytes())?;
    for (place, text) in &pages.texts {
        put(&format!("docs/{place}"), text.as_bytes())?;
    }
    for file in &pages.files {
        let content = fs::read(root().join(file)).map_err(|error| format!("{file}: {error}"))?;
        put(&format!("docs/{}", page::place(file)), &content)?;
    }
    Ok(())
}

/// Puts the program that draws the diagrams into a folder, so that browsers load it from the site.
fn add_mermaid(folder: &Path) -> Result<()> {
    let (package, version) = MERMAID;
    let prefix = target().join(format!("site-npm/{version}"));
    let program = prefix.join(format!("node_modules/{package}/dist/mermaid.tiny.js"));
    if !program.is_file() {
        if !is_installed("npm") {
            return Err(format!(
                "npm is not installed; install it: {package} draws the diagrams of the site"
            ));
        }
        let mut npm = command("npm");
        npm.args(["install", "--silent", "--no-save", "--ignore-scripts", "--prefix"]).arg(&prefix);
        step("program of the diagrams", npm.arg(format!("{package}@{version}")))?;
    }
    fs::copy(&program, folder.join("mermaid.js"))
        .map(drop)
        .map_err(|error| format!("{}: {error}", program.display()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_learner_of_the_registry_has_a_page_in_the_navigation() {
        let pages = pages(&Learners::read().unwrap(), &Predictions::default(), &Drawings::default()).unwrap();
        let registry = inputs::text("xtask/learners.tsv").unwrap();
        let names: Vec<_> = registry
            .lines()
            .filter(|line| !line.starts_with('#'))
            .filter_map(|line| line.split_once('\t').map(|(name, _)| name))
            .collect();
        assert!(names.len() > 50, "{names:?}");
        for name in names {
            let place = format!("learners/{name}.md");
            let page = &pages.texts[&place];
            assert!(page.starts_with(&format!("# {name}\n")), "{page}");
            assert!(pages.config.contains(&format!("- {name}: {place}\n")), "{name}");
            assert!(pages.texts["learners/index.md"].contains(&format!("({name}.md)")), "{name}");
        }
    }

    /// Builds a site of one page beside the index, and returns whether that succeeds.
    fn builds(python: &Path, name: &str, page: &str, navigation: &str) -> bool {
        let folder = target().join("tmp").join(format!("site-{name}-{}", std::process::id()));
        let config = inputs::text("mkdocs.yml").unwrap();
        let (config, _) = config.split_once("\nnav:\n").unwrap();
        let text = |place: &str, text: &str| (place.to_owned(), text.to_owned());
        let texts = [text("index.md", "# Index\n\n## One\n"), text("page.md", page)].into();
        let config = format!("{config}\nnav:\n{navigation}");
        write(&folder, &Pages { config, texts, files: BTreeSet::new() }).unwrap();
        let built = mkdocs(python, &folder, &folder.join("site")).output().unwrap();
        fs::remove_dir_all(folder).unwrap();
        built.status.success()
    }

    #[test]
    fn broken_links_anchors_and_navigation_fail() {
        let python = target().join("site-venv/bin/python");
        if !python.is_file() {
            println!("skipped: MkDocs is not installed; `cargo xtask site --check` installs it");
            return;
        }
        let both = "  - index.md\n  - page.md\n";
        assert!(builds(&python, "right", "# Page\n\n[One](index.md#one)\n", both));
        assert!(!builds(&python, "anchor", "# Page\n\n[Two](index.md#two)\n", both));
        assert!(!builds(&python, "link", "# Page\n\n[Missing](missing.md)\n", both));
        assert!(!builds(&python, "alone", "# Page\n", "  - index.md\n"));
        assert!(!builds(&python, "entry", "# Page\n", &format!("{both}  - missing.md\n")));
    }

    #[test]
    fn the_security_policy_names_every_fuzz_target() {
        let policy = inputs::text("SECURITY.md").unwrap();
        let targets = fs::read_dir(root().join("fuzz/fuzz_targets")).unwrap();
        for target in targets {
            let path = target.unwrap().path();
            let name = path.file_stem().unwrap().to_string_lossy().into_owned();
            assert!(policy.contains(&format!("`{name}`")), "{name}");
        }
    }

    #[test]
    fn every_page_of_the_documentation_is_on_the_site() {
        let pages = pages(&Learners::read().unwrap(), &Predictions::default(), &Drawings::default()).unwrap();
        for file in
            inputs::files().unwrap().iter().filter(|file| file.starts_with("docs/") && file.ends_with(".md"))
        {
            assert!(pages.texts.contains_key(&page::place(file)), "{file}");
        }
        assert!(pages.texts.contains_key("repository/models/README.md"), "a page that only a link leads to");
        assert!(pages.files.contains("docs/viewer.jpg") && !pages.files.contains("docs/viewer.md"));
    }
}
