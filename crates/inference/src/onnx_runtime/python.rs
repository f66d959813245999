//! Search for the packages of the Python environment by inspecting folders, because starting Python is slow.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, PoisonError};

/// Prefix of the Python environment of this process, if it runs in Python.
static OWN: Mutex<Option<PathBuf>> = Mutex::new(None);

/// Makes the search begin in the environment `prefix` (`sys.prefix`), for a process that Python runs in. Takes effect
/// only before the first session is opened.
pub fn prefer_python(prefix: PathBuf) {
    *OWN.lock().unwrap_or_else(PoisonError::into_inner) = Some(prefix);
}

/// Returns the `capi` folders of every `onnxruntime` package that the user's Python would import, in order of
/// preference.
pub(super) fn onnxruntime_folders() -> Vec<PathBuf> {
    let mut folders = Vec::new();
    for prefix in prefixes() {
        for packages in package_folders(&prefix) {
            let folder = packages.join("onnxruntime").join("capi");
            if folder.is_dir() && !folders.contains(&folder) {
                folders.push(folder);
            }
        }
    }
    folders
}

/// Returns the installation prefixes: the active environment, then that of the Python on the search path, then the
/// user's.
fn prefixes() -> Vec<PathBuf> {
    let own = OWN.lock().unwrap_or_else(PoisonError::into_inner).clone();
    let named = ["VIRTUAL_ENV", "CONDA_PREFIX"].iter().filter_map(env::var_os).map(PathBuf::from);
    let mut prefixes: Vec<_> = own.into_iter().chain(named).collect();
    let path = env::var_os("PATH").unwrap_or_default();
    for name in ["python3", "python"] {
        let file = format!("{name}{}", env::consts::EXE_SUFFIX);
        let Some(found) =
            env::split_paths(&path).map(|folder| folder.join(&file)).find(|file| file.is_file())
        else {
            continue;
        };
        prefixes.extend(prefixes_of(&found));
    }
    prefixes.extend(env::home_dir().map(|home| home.join(".local")));
    prefixes
}

/// Returns the prefixes that a `python3` may belong to: that of the link itself (a virtual environment) and that of
/// its target.
fn prefixes_of(python: &Path) -> Vec<PathBuf> {
    let Some(folder) = python.parent() else { return Vec::new() };
    if folder.file_name().is_some_and(|name| name == "shims") {
        return folder.parent().map(pyenv_prefixes).unwrap_or_default();
    }
    let resolved = python.canonicalize().unwrap_or_default();
    [Some(folder), resolved.parent()]
        .into_iter()
        .flatten()
        .filter_map(|folder| if cfg!(windows) { Some(folder) } else { folder.parent() })
        .map(Path::to_owned)
        .collect()
}

/// Returns the prefixes of the versions that pyenv's `python3` selects: `PYENV_VERSION`, else the nearest
/// `.python-version`, else the global choice.
fn pyenv_prefixes(root: &Path) -> Vec<PathBuf> {
    let local = || {
        let folder = env::current_dir().ok()?;
        folder.ancestors().find_map(|folder| fs::read_to_string(folder.join(".python-version")).ok())
    };
    let chosen = env::var("PYENV_VERSION")
        .ok()
        .filter(|versions| !versions.is_empty())
        .map(|versions| versions.replace(':', "\n"))
        .or_else(local)
        .or_else(|| fs::read_to_string(root.join("version")).ok())
        .unwrap_or_default();
    let versions = root.join("versions");
    let names = chosen.lines().map(str::trim).filter(|name| !name.is_empty() && !name.contains(['/', '\\']));
    names.map(|name| versions.join(name)).collect()
}

/// Returns the folders that the Python under `prefix` imports from.
fn package_folders(prefix: &Path) -> Vec<PathBuf> {
    if cfg!(windows) {
        return vec![prefix.join("Lib").join("site-packages")];
    }
    let mut folders = Vec::new();
    for lib in ["lib", "local/lib", "lib64"] {
        let Ok(entries) = fs::read_dir(prefix.join(lib)) else { continue };
        let mut versions: Vec<_> = entries
            .flatten()
            .map(|entry| entry.path())
            .filter(|path| path.file_name().is_some_and(|name| name.to_string_lossy().starts_with("python3")))
            .collect();
        // Newest first; 3.10 sorts after 3.9 by length.
        versions.sort_by_key(|path| std::cmp::Reverse((path.as_os_str().len(), path.clone())));
        for version in versions {
            folders.extend(["site-packages", "dist-packages"].map(|name| version.join(name)));
        }
    }
    folders
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn prefix_of_a_virtual_environment_comes_before_that_of_its_python() {
        let root = env::temp_dir().join(format!("opendr-python-{}", std::process::id()));
        for folder in ["real/bin", "venv/bin", "venv/lib/python3.9/site-packages", "venv/lib/python3.11"] {
            fs::create_dir_all(root.join(folder)).unwrap();
        }
        let root = root.canonicalize().unwrap();
        fs::write(root.join("real/bin/python3"), "").unwrap();
        #[cfg(unix)]
        {
            std::os::unix::fs::symlink(root.join("real/bin/python3"), root.join("venv/bin/python3")).unwrap();
            assert_eq!(prefixes_of(&root.join("venv/bin/python3")), [root.join("venv"), root.join("real")]);
            let folders = package_folders(&root.join("venv"));
            assert_eq!(folders[0], root.join("venv/lib/python3.11/site-packages"));
            assert_eq!(folders[2], root.join("venv/lib/python3.9/site-packages"));
        }
        fs::remove_dir_all(root).unwrap();
    }

    #[test]
    fn pyenv_names_stay_within_its_folder() {
        let root = env::temp_dir().join(format!("opendr-pyenv-{}", std::process::id()));
        fs::create_dir_all(&root).unwrap();
        fs::write(root.join("version"), "3.11.7\n../../evil\n3.9.18\n").unwrap();
        let versions = root.join("versions");
        if env::var_os("PYENV_VERSION").is_none() {
            assert_eq!(pyenv_prefixes(&root), [versions.join("3.11.7"), versions.join("3.9.18")]);
        }
        fs::remove_dir_all(root).unwrap();
    }
}
