//! The page of the examples: the code of each in both languages, and its image, which is stored in the repository or drawn for the site.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;

use crate::inputs;
use crate::shell::{Result, command, line, target};

/// Page of the repository that lists the examples, in whose place the site has the page with their code.
pub const LIST: &str = "examples/README.md";
/// Place of the page on the site, and folder of the images that are drawn for it.
pub const PAGE: &str = "examples.md";
const DRAWN: &str = "examples";

/// Folders of the examples in Python, of those in Rust, and of their stored images.
const PYTHON: &str = "examples/python/";
const RUST: &str = "examples/rust/src/";
const IMAGES: &str = "examples/images/";

/// Examples that are drawn for the site, on a photograph under the names of their inputs.
const OF_PHOTOGRAPHS: [&str; 8] = [
    "detect_faces",
    "detect_objects",
    "estimate_poses",
    "face_mesh",
    "mask_persons",
    "name_expression",
    "panoptic",
    "segment_scene",
];
const PHOTOGRAPH: &str = "astronaut.jpg";
const NAMES: [&str; 3] = ["astronaut.png", "people.jpg", "street.jpg"];

/// The examples in the order of their names.
pub struct Examples(Vec<Example>);

struct Example {
    name: String,
    python: String,
    rust: String,
    /// File of the image in the repository.
    image: Option<String>,
}

impl Examples {
    /// Reads the examples. Fails with the file of one whose twin is missing.
    pub fn read() -> Result<Self> {
        let files = inputs::files()?;
        let names = files.iter().filter_map(|file| file.strip_prefix(PYTHON)?.strip_suffix(".py"));
        let example = |name: &str| {
            let stored = |file: &&String| {
                file.strip_prefix(IMAGES)
                    .and_then(|image| image.split_once('.'))
                    .is_some_and(|(stem, _)| stem == name)
            };
            let [python, rust] =
                [format!("{PYTHON}{name}.py"), format!("{RUST}{name}.rs")].map(|file| inputs::text(&file));
            let image = files.iter().find(stored).cloned();
            Ok(Example { name: name.to_owned(), python: python?, rust: rust?, image })
        };
        let mut examples = names.map(example).collect::<Result<Vec<_>>>()?;
        examples.sort_by(|one, other| one.name.cmp(&other.name));
        Ok(Self(examples))
    }

    /// Returns the files of the repository that the page shows.
    pub fn images(&self) -> impl Iterator<Item = String> {
        self.0.iter().filter_map(|example| example.image.clone())
    }

    /// Returns the text of the page. `place` returns the place of a file of the repository on the site.
    pub fn page(&self, drawings: &Drawings, place: impl Fn(&str) -> String) -> String {
        let mut text = format!(
            "# Examples\n\n{} programs of at most 40 lines, in Python and in Rust, which print and draw the same in both. The first line of each \
             names its inputs. In Rust: `cargo run --release -p opendr-examples -- NAME`.\n",
            self.0.len()
        );
        for Example { name, python, rust, image } in &self.0 {
            let drawn = drawings.0.contains(name).then(|| format!("{DRAWN}/{name}.png"));
            let image = image.as_deref().map(&place).or(drawn);
            let image =
                image.map_or_else(String::new, |image| format!("![{name}]({image}){{ loading=lazy }}\n\n"));
            let tab = |title: &str, language: &str, code: &str| {
                let code: String =
                    code.lines().map(|line| format!("    {line}").trim_end().to_owned() + "\n").collect();
                format!("=== \"{title}\"\n\n    ```{language}\n{code}    ```\n\n")
            };
            let tabs = [tab("Python", "python", python), tab("Rust", "rust", rust)].concat();
            text += &format!("\n## {name}\n\n{image}{tabs}");
        }
        text
    }
}

/// Names of the examples that were drawn for the site.
#[derive(Default)]
pub struct Drawings(Vec<String>);

impl Drawings {
    /// Runs the examples of photographs with `opendr-examples`, which is beside `program`, if it is built. An example whose model is not
    /// available has no image.
    pub fn make(program: &Path, photographs: &Path) -> Result<Self> {
        let program = program.with_file_name("opendr-examples");
        if !program.is_file() {
            println!("no images of the examples: {} is not built", program.display());
            return Ok(Self::default());
        }
        let folder = Self::folder();
        fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        for name in NAMES {
            let to = folder.join(name);
            fs::copy(photographs.join(PHOTOGRAPH), &to)
                .map_err(|error| format!("{}: {error}", to.display()))?;
        }
        let mut drawn = Vec::new();
        for example in OF_PHOTOGRAPHS {
            let mut run = command(&program);
            run.arg(example).current_dir(&folder).stdin(Stdio::null());
            let done = run.output().map_err(|error| format!("cannot run {}: {error}", line(&run)))?;
            if done.status.success() {
                drawn.push(example.to_owned());
            } else {
                println!("no image of {example}: {}", String::from_utf8_lossy(&done.stderr).trim());
            }
        }
        Ok(Self(drawn))
    }

    /// Copies the images into the folder of the pages.
    pub fn copy(&self, docs: &Path) -> Result<()> {
        let to = docs.join(DRAWN);
        let failed = |error: std::io::Error| format!("{}: {error}", to.display());
        fs::create_dir_all(&to).map_err(failed)?;
        for name in self.0.iter().map(|name| format!("{name}.png")) {
            fs::copy(Self::folder().join(&name), to.join(&name)).map_err(failed)?;
        }
        Ok(())
    }

    fn folder() -> PathBuf {
        target().join("site-examples")
    }
}
