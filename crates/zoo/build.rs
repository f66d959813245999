//! Lists the model cards, so that a new card needs no other edit.

use std::ffi::OsString;
use std::fmt::Write;
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::{env, fs, io};

fn main() -> io::Result<()> {
    // Read at run time, since a build folder shared by several checkouts keeps this program.
    let here = PathBuf::from(variable("CARGO_MANIFEST_DIR")?);
    // A published crate has the cards in it. In a checkout that is a link, which some systems write as a file.
    let models =
        Some(here.join("models")).filter(|folder| folder.is_dir()).unwrap_or(here.join("../../models"));
    let mut code = String::new();
    for (constant, folder, ending) in
        [("CARDS", models.clone(), "toml"), ("CLASS_LISTS", models.join("classes"), "txt")]
    {
        println!("cargo::rerun-if-changed={}", folder.display());
        let _ = writeln!(code, "pub(crate) const {constant}: &[(&str, &str)] = &[");
        for path in files(&folder, ending)? {
            let name = path.file_stem().unwrap_or_default();
            let _ = writeln!(code, "({:?}, include_str!({:?})),", name.display().to_string(), path);
        }
        code.push_str("];\n");
    }
    println!("cargo::rustc-env=OPENDR_IMPORTER={}", importer(&here)?);
    fs::write(Path::new(&variable("OUT_DIR")?).join("embedded.rs"), code)
}

/// Returns a variable that cargo sets.
fn variable(name: &str) -> io::Result<OsString> {
    env::var_os(name).ok_or_else(|| io::Error::other(format!("cargo sets {name}")))
}

/// Returns the importer's version with a fingerprint of its sources, if they are beside this crate.
fn importer(here: &Path) -> io::Result<String> {
    let mut hasher = DefaultHasher::new();
    let mut folders = vec![here.join("../import/src"), here.join("../onnx/src")];
    while let Some(folder) = folders.pop().filter(|folder| folder.is_dir()) {
        println!("cargo::rerun-if-changed={}", folder.display());
        let mut paths =
            fs::read_dir(&folder)?.map(|entry| Ok(entry?.path())).collect::<io::Result<Vec<_>>>()?;
        paths.sort();
        for path in paths {
            if path.is_dir() {
                folders.push(path);
            } else {
                fs::read(&path)?.hash(&mut hasher);
            }
        }
    }
    Ok(format!("opendr-import {}+{:08x}", env!("CARGO_PKG_VERSION"), hasher.finish() as u32))
}

fn files(folder: &Path, ending: &str) -> io::Result<Vec<PathBuf>> {
    let mut paths = fs::read_dir(fs::canonicalize(folder)?)?
        .map(|entry| Ok(entry?.path()))
        .collect::<io::Result<Vec<_>>>()?;
    paths.retain(|path| path.extension().is_some_and(|found| found == ending));
    paths.sort();
    Ok(paths)
}
