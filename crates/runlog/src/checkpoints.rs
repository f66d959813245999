//! A folder of checkpoints.

use std::fs;
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Result};

use crate::atomic_file::{INCOMPLETE_SUFFIX, sync_folder, temporary_name, write_atomically, write_error};
use crate::checkpoint::Checkpoint;

const PREFIX: &str = "step-";
/// Suffix of a checkpoint while a newer one of the same step replaces it.
const REPLACED: &str = ".replaced";
const BEST: &str = "best";

/// A folder of checkpoints, `step-0000001200` each, of which the newest ones and the best one are kept.
///
/// Each is written under another name, synced and renamed. After a kill or crash at any time, [`Checkpoints::latest`]
/// finds the newest intact one. Only one process at a time may write to a folder.
///
/// ```
/// # fn main() -> opendr_engine::Result<()> {
/// # let folder = std::env::temp_dir().join(format!("opendr-checkpoints-{}", std::process::id()));
/// let checkpoints = opendr_runlog::Checkpoints::new(&folder, 2)?;
/// for step in [100, 200, 300] {
///     checkpoints.save(step, &[("weights.bin", &step.to_le_bytes())])?;
///     if step == 100 {
///         checkpoints.mark_best(100)?;
///     }
/// }
/// let latest = checkpoints.latest()?.map(|checkpoint| checkpoint.step);
/// assert_eq!((latest, checkpoints.steps()?), (Some(300), vec![100, 200, 300]));
/// # std::fs::remove_dir_all(folder)?;
/// # Ok(()) }
/// ```
#[derive(Debug, Clone)]
pub struct Checkpoints {
    folder: PathBuf,
    keep: usize,
}

impl Checkpoints {
    /// Opens the checkpoints in `folder`, which is created if missing. The newest `keep` are kept, and the best one.
    ///
    /// # Errors
    /// `InvalidParam` when `keep` is 0, `Io` when the folder cannot be created.
    pub fn new(folder: &Path, keep: usize) -> Result<Self> {
        if keep == 0 {
            return Err(Error::invalid_param("the number of kept checkpoints is 0; keep 1 or more"));
        }
        fs::create_dir_all(folder).map_err(|error| write_error(folder, error))?;
        Ok(Self { folder: folder.to_owned(), keep })
    }

    /// Saves `files` as the checkpoint of a step and returns its folder. An older checkpoint of the step is replaced; checkpoints that
    /// need not be kept and incomplete ones of killed processes are removed.
    ///
    /// # Errors
    /// `Io` when the disk is full; other checkpoints are then unchanged, and nothing of this one is left. `Integrity` and
    /// `InvalidParam` for file names that leave the folder or are duplicates.
    pub fn save(&self, step: u64, files: &[(&str, &[u8])]) -> Result<PathBuf> {
        let path = self.folder.join(format!("{PREFIX}{step:010}"));
        self.remove_incomplete();
        let temporary = temporary_name(&path).map_err(|error| write_error(&path, error))?;
        let saved = Checkpoint::write(&temporary, step, files).and_then(|()| self.place(&temporary, &path));
        if let Err(error) = saved {
            // The first failure is the one to report.
            fs::remove_dir_all(&temporary).ok();
            return Err(error.context(format!("saving the checkpoint {}", path.display())));
        }
        self.prune(step)?;
        Ok(path)
    }

    fn place(&self, temporary: &Path, path: &Path) -> Result<()> {
        let replaced = self.folder.join(format!("{}{REPLACED}", name_of(path)));
        let rename = || {
            if path.exists() {
                // Left by an earlier kill, after the folder at `path` had replaced it.
                fs::remove_dir_all(&replaced).ok();
                fs::rename(path, &replaced)?;
            }
            fs::rename(temporary, path)?;
            sync_folder(path)
        };
        rename().map_err(|error| write_error(path, error))
    }

    /// Returns the newest intact checkpoint, after verification of all its files. Damaged ones are skipped and listed in
    /// [`Checkpoint::skipped`].
    ///
    /// # Errors
    /// `Integrity` when all checkpoints are damaged, so that no training restarts unintentionally; `Io`.
    pub fn latest(&self) -> Result<Option<Checkpoint>> {
        let mut skipped = Vec::new();
        for (_, path) in self.list()?.into_iter().rev() {
            match Checkpoint::open(path.clone()) {
                Ok(mut checkpoint) => {
                    checkpoint.skipped = skipped;
                    return Ok(Some(checkpoint));
                }
                Err(error) => skipped.push(format!("{} is damaged: {error}", path.display())),
            }
        }
        if skipped.is_empty() {
            return Ok(None);
        }
        Err(Error::integrity(format!(
            "all checkpoints in {} are damaged: {}; use another folder, or delete it to start again",
            self.folder.display(),
            skipped.join("; ")
        )))
    }

    /// Marks the checkpoint of a step as the best; it is kept until another one is marked.
    ///
    /// # Errors
    /// `NotFound` when there is no such checkpoint, `Io` when the mark cannot be written.
    pub fn mark_best(&self, step: u64) -> Result<()> {
        if !self.steps()?.contains(&step) {
            let folder = self.folder.display();
            return Err(Error::not_found(format!("no checkpoint of step {step} in {folder}; save it first")));
        }
        write_atomically(&self.folder.join(BEST), format!("{step}\n").as_bytes())
    }

    /// Returns the checkpoint marked as the best.
    ///
    /// # Errors
    /// `Integrity`, `NotFound` or `Format` when it is marked but incomplete or damaged.
    pub fn best(&self) -> Result<Option<Checkpoint>> {
        let Some(best) = self.best_step() else { return Ok(None) };
        let mut of_step = self.list()?.into_iter().rev().filter(|(step, _)| *step == best);
        of_step.next().map(|(_, path)| Checkpoint::open(path)).transpose()
    }

    /// Returns the steps of all checkpoints, intact or not, in increasing order.
    ///
    /// # Errors
    /// `Io` when the folder cannot be read.
    pub fn steps(&self) -> Result<Vec<u64>> {
        let mut steps: Vec<_> = self.list()?.into_iter().map(|(step, _)| step).collect();
        steps.dedup();
        Ok(steps)
    }

    fn best_step(&self) -> Option<u64> {
        fs::read_to_string(self.folder.join(BEST)).ok()?.trim().parse().ok()
    }

    /// Lists steps and folders in order of steps; of equal steps, the replaced one comes first.
    fn list(&self) -> Result<Vec<(u64, PathBuf)>> {
        let mut found = Vec::new();
        for entry in fs::read_dir(&self.folder).map_err(|error| write_error(&self.folder, error))? {
            let path = entry?.path();
            let name = name_of(&path);
            let digits = name.strip_suffix(REPLACED).unwrap_or(&name).strip_prefix(PREFIX);
            if let Some(step) = digits.and_then(|digits| digits.parse().ok()) {
                found.push((step, !name.ends_with(REPLACED), path));
            }
        }
        found.sort();
        Ok(found.into_iter().map(|(step, _, path)| (step, path)).collect())
    }

    /// Removes checkpoints that need not be kept. `saved` is kept even if later steps of an abandoned run exist.
    fn prune(&self, saved: u64) -> Result<()> {
        let best = self.best_step();
        let steps = self.steps()?;
        let newest = steps.iter().rev().take(self.keep);
        let kept: Vec<u64> = newest.copied().chain(best).chain([saved]).collect();
        let found = self.list()?;
        // A kill may leave a replaced checkpoint, partly removed, before its successor.
        let succeeded = |at: usize| found.get(at + 1).is_some_and(|next| next.0 == found[at].0);
        let goes = |at: usize| succeeded(at) || !kept.contains(&found[at].0);
        for path in (0..found.len()).filter(|at| goes(*at)).map(|at| &found[at].1) {
            // Renamed first, so that a folder being removed is not listed as a checkpoint.
            let removed = temporary_name(path).and_then(|gone| fs::rename(path, &gone));
            removed.map_err(|error| write_error(path, error))?;
        }
        self.remove_incomplete();
        Ok(())
    }

    fn remove_incomplete(&self) {
        let entries = fs::read_dir(&self.folder).into_iter().flatten().flatten().map(|entry| entry.path());
        let is_left = |path: &PathBuf| {
            let name = name_of(path);
            name.starts_with('.') && name.ends_with(INCOMPLETE_SUFFIX)
        };
        for path in entries.filter(is_left) {
            // A leftover only takes space.
            fs::remove_dir_all(&path).or_else(|_| fs::remove_file(&path)).ok();
        }
    }
}

fn name_of(path: &Path) -> String {
    path.file_name().unwrap_or_default().to_string_lossy().into_owned()
}
