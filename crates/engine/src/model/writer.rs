//! Atomic writing of containers.

use std::fs::{self, File};
use std::io::{self, Write};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};

use zip::write::SimpleFileOptions;
use zip::{CompressionMethod, ZipWriter};

use super::part::{inside, parts_of};
use super::{MANIFEST_NAME, Manifest, Model, ModelFile, Sha256, member_path};
use crate::{Error, Result, ResultExt};

/// Writes a container to a temporary folder beside its path, and renames it when it is complete.
///
/// ```
/// # fn main() -> opendr_engine::Result<()> {
/// use opendr_engine::model::{Manifest, Model, ModelWriter};
///
/// let path = std::env::temp_dir().join(format!("opendr-doc-{}", std::process::id()));
/// let mut writer = ModelWriter::new(&path, Manifest::new("nanodet", "mine"))?;
/// writer.add("model.onnx", b"the network")?;
/// let model = writer.finish()?;
/// assert_eq!(model.file("model.onnx")?, b"the network");
/// # std::fs::remove_dir_all(path)?;
/// # Ok(()) }
/// ```
#[derive(Debug)]
pub struct ModelWriter {
    target: PathBuf,
    temporary: PathBuf,
    manifest: Manifest,
}

static COUNTER: AtomicU64 = AtomicU64::new(0);

impl ModelWriter {
    /// Starts a container at `path`: a zip if it ends in `.zip`, otherwise a folder. The list of files of the manifest is
    /// replaced by the added files.
    ///
    /// # Errors
    /// Returns `InvalidInput` if something other than a model is at `path`, `Io` if the parent folder is not writable.
    pub fn new(path: impl AsRef<Path>, mut manifest: Manifest) -> Result<Self> {
        let target = std::path::absolute(path)?;
        check_replaceable(&target)?;
        let (Some(parent), Some(name)) = (target.parent(), target.file_name()) else {
            return Err(Error::invalid_input(format!(
                "{} cannot be the folder of a model; give another path",
                target.display()
            )));
        };
        fs::create_dir_all(parent).context(|| parent.display().to_string())?;
        let count = COUNTER.fetch_add(1, Ordering::Relaxed);
        let temporary =
            parent.join(format!(".{}.{}.{count}.partial", name.to_string_lossy(), std::process::id()));
        fs::create_dir(&temporary).context(|| temporary.display().to_string())?;
        manifest.files.clear();
        Ok(Self { target, temporary, manifest })
    }

    /// Adds a file.
    ///
    /// # Errors
    /// Returns `Integrity` if the name could leave the folder, `InvalidInput` if it exists already, `Io` if writing fails.
    pub fn add(&mut self, name: &str, bytes: &[u8]) -> Result<()> {
        let path = self.temporary.join(member_path(name)?);
        let taken = |file: &ModelFile| file.name.eq_ignore_ascii_case(name);
        if name.eq_ignore_ascii_case(MANIFEST_NAME) || self.manifest.files.iter().any(taken) {
            return Err(Error::invalid_input(format!("the model already has a file {name:?}")));
        }
        if let Some(parent) = path.parent() {
            fs::create_dir_all(parent)?;
        }
        write_synced(&path, bytes)?;
        self.manifest.files.push(entry(name, bytes));
        Ok(())
    }

    /// Adds a model as the part `name` and checks all its files; [`Model::part`] opens it.
    ///
    /// # Errors
    /// As [`ModelWriter::add`] and [`Model::file`].
    pub fn add_part(&mut self, name: &str, part: &Model) -> Result<()> {
        let mut manifest = part.manifest().clone();
        for file in &mut manifest.files {
            let bytes = part.file(&file.name)?;
            self.add(&format!("{name}/{}", file.name), &bytes)?;
            *file = entry(&file.name, &bytes);
        }
        self.add(&format!("{name}/{MANIFEST_NAME}"), &manifest.to_json()?)
    }

    /// Moves the container to its path, where it replaces an older one, and opens it.
    ///
    /// # Errors
    /// Returns `Io` if writing or renaming fails.
    pub fn finish(self) -> Result<Model> {
        self.finish_checked(|_| Ok(()))
    }

    /// Finishes as [`ModelWriter::finish`], after `check` accepted the finished model in its temporary folder.
    ///
    /// # Errors
    /// Returns the error of `check`, which leaves the path unchanged; otherwise as [`ModelWriter::finish`].
    pub fn finish_checked(mut self, check: impl FnOnce(&Model) -> Result<()>) -> Result<Model> {
        self.renew_parts()?;
        write_synced(&self.temporary.join(MANIFEST_NAME), &self.manifest.to_json()?)?;
        check(&Model::open(&self.temporary)?)?;
        if self.target.extension().is_some_and(|extension| extension == "zip") {
            let packed = self.temporary.join("packed.zip");
            self.pack(&packed).context(|| packed.display().to_string())?;
            fs::rename(&packed, &self.target).context(|| self.target.display().to_string())?;
        } else {
            self.place_folder().context(|| self.target.display().to_string())?;
        }
        Model::open(&self.target)
    }

    /// Updates the file lists in the manifests of parts. They are outdated if a file of a part was added in another version,
    /// such as a quantised network.
    fn renew_parts(&mut self) -> Result<()> {
        let mut parts: Vec<_> = parts_of(&self.manifest.files).map(str::to_owned).collect();
        parts.sort_by_key(|part| std::cmp::Reverse(part.matches('/').count()));
        for part in parts {
            let name = format!("{part}/{MANIFEST_NAME}");
            let path = self.temporary.join(member_path(&name)?);
            let Ok(mut manifest) = Manifest::from_json(&fs::read(&path)?) else { continue };
            let added = |file: &ModelFile| {
                let same = |other: &&ModelFile| inside(&part, &other.name) == Some(&file.name);
                self.manifest
                    .files
                    .iter()
                    .find(same)
                    .map(|other| ModelFile { name: file.name.clone(), ..*other })
            };
            let files: Vec<_> =
                manifest.files.iter().map(|file| added(file).unwrap_or_else(|| file.clone())).collect();
            if files != manifest.files {
                manifest.files = files;
                let json = manifest.to_json()?;
                write_synced(&path, &json)?;
                self.manifest.files.iter_mut().filter(|file| file.name == name).for_each(|file| {
                    *file = entry(&name, &json);
                });
            }
        }
        Ok(())
    }

    fn pack(&self, path: &Path) -> Result<()> {
        let mut archive = ZipWriter::new(io::BufWriter::new(File::create(path)?));
        // Weights compress little, and stored members load faster.
        let options = SimpleFileOptions::default().compression_method(CompressionMethod::Stored);
        for name in self.manifest.files.iter().map(|file| file.name.as_str()).chain([MANIFEST_NAME]) {
            archive.start_file(name, options).map_err(io::Error::from)?;
            io::copy(&mut File::open(self.temporary.join(member_path(name)?))?, &mut archive)?;
        }
        let file =
            archive.finish().map_err(io::Error::from)?.into_inner().map_err(|error| error.into_error())?;
        Ok(file.sync_all()?)
    }

    fn place_folder(&self) -> io::Result<()> {
        let old = self.temporary.with_extension("old");
        let replaces = match fs::rename(&self.target, &old) {
            Ok(()) => true,
            Err(error) if error.kind() == io::ErrorKind::NotFound => false,
            Err(error) => return Err(error),
        };
        let placed = fs::rename(&self.temporary, &self.target);
        if placed.is_err() && replaces {
            fs::rename(&old, &self.target)?;
        } else if replaces {
            fs::remove_dir_all(&old)?;
        }
        placed
    }
}

impl Drop for ModelWriter {
    fn drop(&mut self) {
        // Removed already after a successful `finish`; a leftover only takes space.
        let _ = fs::remove_dir_all(&self.temporary);
    }
}

fn entry(name: &str, bytes: &[u8]) -> ModelFile {
    ModelFile { name: name.to_owned(), size: Some(bytes.len() as u64), sha256: Some(Sha256::of(bytes)) }
}

fn check_replaceable(target: &Path) -> Result<()> {
    let is_zip = target.extension().is_some_and(|extension| extension == "zip");
    let free = match fs::metadata(target) {
        Err(_) => true,
        Ok(found) if is_zip => found.is_file(),
        Ok(found) => {
            found.is_dir() && (target.join(MANIFEST_NAME).is_file() || fs::read_dir(target)?.next().is_none())
        }
    };
    if free {
        return Ok(());
    }
    Err(Error::invalid_input(format!("{} exists and is not a model; give another path", target.display())))
}

fn write_synced(path: &Path, bytes: &[u8]) -> Result<()> {
    let write = || {
        let mut file = File::create(path)?;
        file.write_all(bytes)?;
        file.sync_all()
    };
    write().context(|| path.display().to_string())
}
