//! Predictions of the learners on photographs, for their pages.

use std::collections::{BTreeMap, VecDeque};
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Stdio;
use std::sync::{Mutex, PoisonError};

use crate::inputs::of_file;
use crate::shell::{Result, command, line, root, step, target};
use crate::surfaces;
use crate::tools::Python;

/// The photographs, in the order in which pages show them: name, and what the caption says.
pub const PHOTOGRAPHS: [(&str, &str); 3] = [
    ("astronaut.jpg", "Eileen Collins (NASA, public domain)"),
    ("coffee.jpg", "Rachel Michetti (CC0)"),
    ("chelsea.jpg", "Stefan van der Walt (CC0)"),
];

/// Exit codes of `opendr infer` for a model that no source at hand has: NotFound, Network.
const UNAVAILABLE: [i32; 2] = [13, 15];

/// The predictions of learners, by name.
#[derive(Default)]
pub struct Predictions(BTreeMap<String, Prediction>);

/// What `opendr infer` made of the photographs.
pub enum Prediction {
    /// Its printed predictions; `folder` has the photographs with the predictions drawn.
    Made { folder: PathBuf, printed: String },
    /// The model is not available on this machine: the first line of the error.
    Unavailable(String),
}

impl Predictions {
    /// Runs each learner on the photographs. Predictions of an unchanged program and unchanged photographs are kept. Fails where a program
    /// fails for another reason than a missing model.
    pub fn make(program: &Path, photographs: &Path, learners: &[&str]) -> Result<Self> {
        let mut key = of_file(program)?;
        for (photograph, _) in PHOTOGRAPHS {
            key = key.rotate_left(7) ^ of_file(&photographs.join(photograph))?;
        }
        println!("\n=== predictions: {} learners with {}", learners.len(), program.display());
        let waiting = Mutex::new(learners.iter().copied().collect::<VecDeque<_>>());
        let next = || waiting.lock().unwrap_or_else(PoisonError::into_inner).pop_front();
        let made = Mutex::new(Vec::new());
        let lanes = std::thread::available_parallelism().map_or(1, usize::from);
        std::thread::scope(|scope| {
            for _ in 0..lanes {
                scope.spawn(|| {
                    while let Some(learner) = next() {
                        let prediction = predict(program, photographs, learner, key);
                        let mut made = made.lock().unwrap_or_else(PoisonError::into_inner);
                        made.push(prediction.map(|prediction| (learner.to_owned(), prediction)));
                    }
                });
            }
        });
        let made = made.into_inner().unwrap_or_else(PoisonError::into_inner);
        made.into_iter().collect::<Result<_>>().map(Self)
    }

    /// Returns the prediction of a learner that was run.
    pub fn of(&self, learner: &str) -> Option<&Prediction> {
        self.0.get(learner)
    }

    /// Copies the drawings into a folder for each learner below `folder`.
    pub fn copy(&self, folder: &Path) -> Result<()> {
        for (learner, prediction) in &self.0 {
            let Prediction::Made { folder: from, .. } = prediction else { continue };
            let to = folder.join(learner);
            let failed = |error: std::io::Error| format!("{}: {error}", to.display());
            fs::create_dir_all(&to).map_err(failed)?;
            for (photograph, _) in PHOTOGRAPHS {
                fs::copy(from.join(photograph), to.join(photograph)).map_err(failed)?;
            }
        }
        Ok(())
    }
}

/// Returns the command that a page states, without the name of the program.
pub fn arguments(learner: &str) -> Vec<String> {
    let photographs = PHOTOGRAPHS.map(|(photograph, _)| photograph);
    ["infer", learner].into_iter().chain(photographs).map(str::to_owned).collect()
}

/// Returns the command that predicts: `OPENDR_BIN`, else that of the build folder.
pub fn program() -> Result<PathBuf> {
    let program = std::env::var_os("OPENDR_BIN").map_or_else(surfaces::opendr, PathBuf::from);
    if !program.is_file() {
        return Err(format!(
            "{} does not exist; build it with `cargo build --package opendr-cli`, or set OPENDR_BIN",
            program.display()
        ));
    }
    Ok(program)
}

/// Writes the photographs and returns their folder.
pub fn photographs(python: &Python) -> Result<PathBuf> {
    let folder = target().join("site-photographs");
    if PHOTOGRAPHS.iter().any(|(photograph, _)| !folder.join(photograph).is_file()) {
        let mut write = command(python.program());
        write.arg(root().join("xtask/site/photographs.py")).arg(&folder);
        if let Some(data) = std::env::var_os("OPENDR_TEST_DATA") {
            write.arg(Path::new(&data).join("data/photos"));
        }
        step("photographs", &mut write)?;
    }
    Ok(folder)
}

/// Runs a learner, unless its predictions of the same `key` are kept.
fn predict(program: &Path, photographs: &Path, learner: &str, key: u64) -> Result<Prediction> {
    let folder = target().join("site-predictions").join(learner);
    let (stamp, printed) = (folder.join("key"), folder.join("printed.txt"));
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    let key = format!("{key:016x}");
    if fs::read_to_string(&stamp).is_ok_and(|kept| kept == key) {
        let printed = fs::read_to_string(printed).map_err(failed)?;
        return Ok(Prediction::Made { folder, printed });
    }
    // A missing folder is no error.
    fs::remove_dir_all(&folder).ok();
    fs::create_dir_all(&folder).map_err(failed)?;
    let mut infer = command(program);
    infer.args(arguments(learner)).args([OsString::from("--quiet"), "--out".into(), folder.clone().into()]);
    // As many learners run as there are processors.
    infer.current_dir(photographs).env("OPENDR_THREADS", "1").stdin(Stdio::null());
    let done = infer.output().map_err(|error| format!("cannot run {}: {error}", line(&infer)))?;
    let error = String::from_utf8_lossy(&done.stderr).into_owned();
    match done.status.code() {
        Some(0) => {
            let text = String::from_utf8_lossy(&done.stdout).into_owned();
            fs::write(printed, &text).and_then(|()| fs::write(stamp, key)).map_err(failed)?;
            Ok(Prediction::Made { folder, printed: text })
        }
        Some(code) if UNAVAILABLE.contains(&code) => {
            let first = error.lines().next().unwrap_or_default().trim_start_matches("error: ");
            Ok(Prediction::Unavailable(first.trim_end_matches("; tried:").to_owned()))
        }
        _ => Err(format!("{} failed ({}): {}", line(&infer), done.status, error.trim())),
    }
}
