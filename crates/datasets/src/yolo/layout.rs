//! Images and labels of a YOLO data set, by its `data.yaml` or its folders.

use std::collections::{HashMap, HashSet};
use std::fs;
use std::path::{Component, Path, PathBuf};

use opendr_engine::target::Classes;
use opendr_engine::{Error, Result, ResultExt};

use super::yaml::{Keys, Yaml};
use crate::folder::{folders_in, has_extension, names_in, path_inside, read_text};
use crate::picture_files::is_picture;
use crate::{Problem, Problems};

/// Largest depth of nested folders.
const MAX_DEPTH: usize = 16;

/// Names of parts; the first existing one is used.
const SPLITS: [&str; 3] = ["val", "test", "train"];

/// A folder of images and the folder of their labels.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Folder {
    pub pictures: PathBuf,
    pub labels: PathBuf,
}

/// All images: index of their folder and name in it.
#[derive(Debug, Default)]
pub(super) struct Layout {
    pub folders: Vec<Folder>,
    pub pictures: Vec<(u32, String)>,
    pub classes: Classes,
    /// Class ids of the label files, if they are not 0, 1, 2, ...
    pub class_ids: Vec<i64>,
}

/// Returns the folder of a data set: `path` itself, the folder of its YAML file, or `object_detection` in it.
pub(super) fn root_of(path: &Path) -> PathBuf {
    if path.is_file() {
        return path.parent().unwrap_or(Path::new("")).to_owned();
    }
    let inner = path.join("object_detection");
    let own = yaml_file(path).is_some() || path.join("labels").is_dir();
    if !own && inner.join("labels").is_dir() { inner } else { path.to_owned() }
}

/// Returns the YAML file of a data set.
pub(super) fn yaml_file(path: &Path) -> Option<PathBuf> {
    if path.is_file() {
        return has_extension(&path.to_string_lossy(), &["yaml", "yml"]).then(|| path.to_owned());
    }
    let names = names_in(path).unwrap_or_default();
    let mut files: Vec<_> = names.into_iter().filter(|name| has_extension(name, &["yaml", "yml"])).collect();
    files.sort_by_key(|name| !name.starts_with("data."));
    files.into_iter().map(|name| path.join(name)).find(|file| {
        let keys = read_text(file).and_then(|text| Keys::new(file, &text));
        keys.is_ok_and(|keys| {
            keys.get("names").is_some() && SPLITS.iter().any(|split| keys.get(split).is_some())
        })
    })
}

impl Layout {
    /// Lists the images of a part.
    pub fn new(path: &Path, split: Option<&str>, problems: &Problems) -> Result<Self> {
        let root = root_of(path);
        let mut layout = Self::default();
        let file = if path.is_file() { Some(path.to_owned()) } else { yaml_file(&root) };
        let Some(file) = file else {
            let parts = folders_in(&root.join("images"));
            let split = choose(split, &parts)?;
            let folder = split.map_or("images".to_owned(), |split| format!("images/{split}"));
            layout.add(&root, &folder, problems).context(|| root.display().to_string())?;
            return Ok(layout);
        };
        let keys = Keys::new(&file, &read_text(&file)?)?;
        if keys.get("kpt_shape").is_some() {
            let file = file.display();
            return Err(Error::unsupported(format!(
                "{file}: YOLO's keypoints are not supported; convert them to COCO"
            )));
        }
        layout.name_classes(&file, &keys)?;
        let parts: Vec<_> = keys.names().filter(|name| SPLITS.contains(name)).map(str::to_owned).collect();
        let base = base_of(&root, &keys);
        match choose(split, &parts) {
            Ok(Some(part)) => {
                let entries = keys.texts(&part).iter();
                entries
                    .into_iter()
                    .try_for_each(|entry| layout.add(&base, entry, problems))
                    .context(|| format!("{} at {part}", file.display()))?;
            }
            Ok(None) => {
                return Err(Error::format("the file has none of the keys val, test, train")
                    .context(file.display().to_string()));
            }
            // A part that exists only as a folder, e.g. "val2017".
            Err(error) => {
                let folder = format!("images/{}", split.unwrap_or_default());
                layout.add(&base, &folder, problems).map_err(|_| error)?;
            }
        }
        Ok(layout)
    }

    fn name_classes(&mut self, file: &Path, keys: &Keys) -> Result<()> {
        match keys.get("names") {
            Some(Yaml::List(names)) => self.classes = names.iter().map(String::as_str).collect(),
            Some(Yaml::Table(names)) => {
                let mut numbered = Vec::new();
                for (number, name) in names {
                    let number: i64 = number.parse().map_err(|_| {
                        Problem::at_key(file, "names", format!("{number:.40?} is not a class index"))
                    })?;
                    numbered.push((number, name.as_str()));
                }
                numbered.sort_unstable();
                self.classes = numbered.iter().map(|(_, name)| *name).collect();
                if numbered.iter().enumerate().any(|(at, (number, _))| at as i64 != *number) {
                    self.class_ids = numbered.iter().map(|(number, _)| *number).collect();
                }
            }
            _ => {
                return Err(Problem::at_key(
                    file,
                    "names",
                    "it is neither a list nor a table of class names",
                )
                .into());
            }
        }
        Ok(())
    }

    /// Adds the images of a folder, or those of a list in a text file.
    fn add(&mut self, base: &Path, entry: &str, problems: &Problems) -> Result<()> {
        let entry = inside(entry);
        let path = if entry.is_empty() {
            base.to_owned()
        } else {
            path_inside(base, &entry).map_err(Error::format)?
        };
        if path.is_file() && has_extension(&entry, &["txt"]) {
            return self.add_list(base, &path, problems);
        }
        // Several data sets may share the images beside them.
        let beside = base.parent().map(|above| above.join(&entry)).filter(|_| !entry.is_empty());
        let pictures = [Some(path.clone()), beside].into_iter().flatten().find(|folder| folder.is_dir());
        let pictures = pictures.ok_or_else(|| {
            Error::not_found(format!("the folder of images {} does not exist", path.display()))
        })?;
        let labels = labels_of(base, &entry);
        let number = self.folders.len() as u32;
        let mut names = Vec::new();
        walk(&pictures, "", &mut HashSet::new(), &mut names, problems)?;
        self.pictures.extend(names.into_iter().map(|name| (number, name)));
        self.folders.push(Folder { pictures, labels });
        Ok(())
    }

    fn add_list(&mut self, base: &Path, list: &Path, problems: &Problems) -> Result<()> {
        let text = read_text(list)?;
        let mut numbers = HashMap::new();
        for (line, entry) in crate::fields::lines(&text) {
            let entry = inside(entry.trim());
            if let Err(message) = path_inside(base, &entry) {
                problems.report(Problem::at_line(list, line, message))?;
                continue;
            }
            let (folder, name) = entry.rsplit_once('/').unwrap_or(("", &entry));
            let number = *numbers.entry(folder.to_owned()).or_insert_with(|| {
                self.folders.push(Folder { pictures: base.join(folder), labels: labels_of(base, folder) });
                self.folders.len() as u32 - 1
            });
            self.pictures.push((number, name.to_owned()));
        }
        Ok(())
    }
}

/// Returns the `path` of the file if it is a folder inside the data set, since most files have a path of the
/// author's computer.
fn base_of(root: &Path, keys: &Keys) -> PathBuf {
    let named = keys.texts("path").first().and_then(|path| path_inside(root, path).ok());
    named.filter(|folder| folder.is_dir()).unwrap_or_else(|| root.to_owned())
}

/// Returns a path without leading `..`, which exporters write (`../train/images`).
fn inside(entry: &str) -> String {
    let parts = Path::new(entry).components().skip_while(|part| !matches!(part, Component::Normal(_)));
    let parts = parts.filter(|part| !matches!(part, Component::CurDir));
    parts.map(|part| part.as_os_str().to_string_lossy()).collect::<Vec<_>>().join("/")
}

/// Returns the folder of labels: the last `images` of the path becomes `labels`.
fn labels_of(base: &Path, pictures: &str) -> PathBuf {
    let mut parts: Vec<&str> = pictures.split('/').collect();
    if let Some(images) = parts.iter().rposition(|part| *part == "images") {
        parts[images] = "labels";
    }
    base.join(parts.join("/"))
}

fn choose(split: Option<&str>, parts: &[String]) -> Result<Option<String>> {
    let first = |wanted: &str| parts.iter().find(|part| *part == wanted || part.starts_with(wanted)).cloned();
    match split {
        None => Ok(SPLITS.iter().find_map(|split| first(split)).or_else(|| parts.first().cloned())),
        Some(split) => first(split).map(Some).ok_or_else(|| {
            Error::not_found(format!("no part {split:?}; the parts are: {}", parts.join(", ")))
        }),
    }
}

/// Lists the images in a folder and its subfolders; cycles of links are reported.
fn walk(
    folder: &Path,
    within: &str,
    above: &mut HashSet<PathBuf>,
    names: &mut Vec<String>,
    problems: &Problems,
) -> Result<()> {
    let real = fs::canonicalize(folder).context(|| format!("opening {}", folder.display()))?;
    if above.len() >= MAX_DEPTH || !above.insert(real.clone()) {
        return problems.report(Problem::new(
            folder,
            "the folder is a link to a folder above it, or nested too deep; remove it",
        ));
    }
    for name in names_in(folder)? {
        let path = folder.join(&name);
        let named = if within.is_empty() { name.clone() } else { format!("{within}/{name}") };
        if path.is_dir() {
            walk(&path, &named, above, names, problems)?;
        } else if is_picture(&path) {
            names.push(named);
        }
    }
    above.remove(&real);
    Ok(())
}
