//! `cargo xtask install-c PREFIX`: installation of the C library with headers, pkg-config files and CMake package.

use std::fs;
use std::path::{Path, PathBuf};

use crate::shell::{Result, command, root, step, target};

const VERSION: &str = env!("CARGO_PKG_VERSION");

/// Libraries that a program links with the static library, from `rustc --print native-static-libs`.
const SYSTEM_LIBRARIES: [&str; 7] = ["gcc_s", "util", "rt", "pthread", "m", "dl", "c"];

/// Builds the library for users and installs it under `prefix`.
pub fn run(prefix: &Path) -> Result<()> {
    step("C library", command("cargo").args(["build", "--profile", "dist", "--package", "opendr-c"]))?;
    install(prefix, &target().join("dist"), &Libraries("lib"))
}

/// Installs the library of [`surfaces::build`](crate::surfaces::build), which has the test learner.
pub fn install_for_tests(prefix: &Path) -> Result<()> {
    install(prefix, &target().join("debug"), &Libraries("lib"))
}

/// Folder of the libraries relative to the prefix: `lib`, or `lib/x86_64-linux-gnu` as Debian has it.
pub struct Libraries<'a>(pub &'a str);

impl Libraries<'_> {
    /// Returns the path from a folder `depth` levels below that of the libraries up to the prefix.
    fn prefix_from(&self, depth: usize) -> String {
        vec![".."; self.0.split('/').count() + depth].join("/")
    }
}

/// Installs the library that was built in the folder `built`.
pub fn install(prefix: &Path, built: &Path, libraries: &Libraries) -> Result<()> {
    let lib = libraries.0;
    let prefix = std::path::absolute(prefix).map_err(|error| format!("{}: {error}", prefix.display()))?;
    let place = Place(prefix.clone());
    for (file, name) in files_below(&root().join("bindings/c/include"))? {
        place.copy(&file, &format!("include/{name}"))?;
    }
    place.copy(&built.join("libopendr_c.a"), &format!("{lib}/libopendr.a"))?;
    if cfg!(target_os = "macos") {
        place.copy(&built.join("libopendr_c.dylib"), &format!("{lib}/libopendr.0.dylib"))?;
        place.link("libopendr.0.dylib", &format!("{lib}/libopendr.dylib"))?;
    } else {
        let file = format!("libopendr.so.{VERSION}");
        place.copy(&built.join("libopendr_c.so"), &format!("{lib}/{file}"))?;
        place.link(&file, &format!("{lib}/libopendr.so.0"))?;
        place.link("libopendr.so.0", &format!("{lib}/libopendr.so"))?;
    }
    for (file, name) in files_below(&root().join("models/weights"))? {
        place.copy(&file, &format!("share/opendr/models/{name}"))?;
    }
    place.write(&format!("{lib}/pkgconfig/opendr.pc"), &pkg_config(libraries))?;
    place.write(&format!("{lib}/pkgconfig/opendr-compat.pc"), &compat_pkg_config(libraries))?;
    place.write(&format!("{lib}/cmake/OpenDR/OpenDRConfig.cmake"), &cmake_config(libraries))?;
    place.write(&format!("{lib}/cmake/OpenDR/OpenDRConfigVersion.cmake"), &cmake_version())?;
    println!("installed OpenDR {VERSION} under {}", prefix.display());
    Ok(())
}

/// Returns the files below a folder, each with its relative path.
pub fn files_below(folder: &Path) -> Result<Vec<(PathBuf, String)>> {
    let failed = |error: std::io::Error| format!("{}: {error}", folder.display());
    let mut found = Vec::new();
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        let name = path.file_name().unwrap_or_default().to_string_lossy().into_owned();
        if path.is_dir() {
            let inner = files_below(&path)?;
            found.extend(inner.into_iter().map(|(path, below)| (path, format!("{name}/{below}"))));
        } else {
            found.push((path, name));
        }
    }
    Ok(found)
}

fn pkg_config(libraries: &Libraries) -> String {
    let private: Vec<_> = SYSTEM_LIBRARIES.iter().map(|library| format!("-l{library}")).collect();
    let (lib, up) = (libraries.0, libraries.prefix_from(1));
    format!(
        "prefix=${{pcfiledir}}/{up}\n\
         libdir=${{prefix}}/{lib}\n\
         includedir=${{prefix}}/include\n\n\
         Name: OpenDR\n\
         Description: Open deep-learning toolkit for robotics\n\
         Version: {VERSION}\n\
         Cflags: -I${{includedir}}\n\
         Libs: -L${{libdir}} -lopendr\n\
         Libs.private: {}\n",
        private.join(" ")
    )
}

/// Returns the pkg-config file that adds the folder of the headers with OpenDR's names.
fn compat_pkg_config(libraries: &Libraries) -> String {
    let up = libraries.prefix_from(1);
    format!(
        "prefix=${{pcfiledir}}/{up}\n\
         includedir=${{prefix}}/include\n\n\
         Name: OpenDR, by the names of OpenDR 3.0\n\
         Description: The headers of OpenDR 3.0's C API over opendr.h\n\
         Version: {VERSION}\n\
         Requires: opendr\n\
         Cflags: -I${{includedir}}/opendr\n"
    )
}

fn cmake_config(libraries: &Libraries) -> String {
    let (lib, up) = (libraries.0, libraries.prefix_from(2));
    format!(
        "# The targets OpenDR::opendr (shared) and OpenDR::opendr_static, and OpenDR::opendr_compat with the headers of OpenDR 3.0.\n\
         get_filename_component(_opendr_prefix \"${{CMAKE_CURRENT_LIST_DIR}}/{up}\" ABSOLUTE)\n\
         if(NOT TARGET OpenDR::opendr)\n\
         \x20 add_library(OpenDR::opendr SHARED IMPORTED)\n\
         \x20 set_target_properties(OpenDR::opendr PROPERTIES\n\
         \x20   IMPORTED_LOCATION \"${{_opendr_prefix}}/{lib}/libopendr${{CMAKE_SHARED_LIBRARY_SUFFIX}}\"\n\
         \x20   INTERFACE_INCLUDE_DIRECTORIES \"${{_opendr_prefix}}/include\")\n\
         \x20 add_library(OpenDR::opendr_static STATIC IMPORTED)\n\
         \x20 set_target_properties(OpenDR::opendr_static PROPERTIES\n\
         \x20   IMPORTED_LOCATION \"${{_opendr_prefix}}/{lib}/libopendr.a\"\n\
         \x20   INTERFACE_INCLUDE_DIRECTORIES \"${{_opendr_prefix}}/include\"\n\
         \x20   INTERFACE_LINK_LIBRARIES \"{}\")\n\
         \x20 add_library(OpenDR::opendr_compat INTERFACE IMPORTED)\n\
         \x20 set_target_properties(OpenDR::opendr_compat PROPERTIES\n\
         \x20   INTERFACE_INCLUDE_DIRECTORIES \"${{_opendr_prefix}}/include/opendr\"\n\
         \x20   INTERFACE_LINK_LIBRARIES OpenDR::opendr)\n\
         endif()\n\
         unset(_opendr_prefix)\n",
        SYSTEM_LIBRARIES.join(";")
    )
}

/// Returns CMake's version file. Before version 1, a program needs the minor version that it was written for.
fn cmake_version() -> String {
    let minor = VERSION.rsplit_once('.').map_or(VERSION, |(minor, _)| minor);
    format!(
        "set(PACKAGE_VERSION \"{VERSION}\")\n\
         set(PACKAGE_VERSION_COMPATIBLE FALSE)\n\
         if(NOT PACKAGE_FIND_VERSION VERSION_GREATER PACKAGE_VERSION AND NOT PACKAGE_FIND_VERSION VERSION_LESS \"{minor}\")\n\
         \x20 set(PACKAGE_VERSION_COMPATIBLE TRUE)\n\
         endif()\n\
         if(PACKAGE_FIND_VERSION VERSION_EQUAL PACKAGE_VERSION)\n\
         \x20 set(PACKAGE_VERSION_EXACT TRUE)\n\
         endif()\n"
    )
}

/// The installation prefix.
struct Place(PathBuf);

impl Place {
    fn path(&self, name: &str) -> Result<PathBuf> {
        let path = self.0.join(name);
        let folder = path.parent().unwrap_or(&self.0);
        fs::create_dir_all(folder).map_err(|error| format!("creating {}: {error}", folder.display()))?;
        // Running programs keep the library that they have loaded.
        fs::remove_file(&path).ok();
        Ok(path)
    }

    fn copy(&self, from: &Path, name: &str) -> Result<()> {
        let path = self.path(name)?;
        fs::copy(from, &path)
            .map_err(|error| format!("copying {} to {}: {error}", from.display(), path.display()))?;
        Ok(())
    }

    fn write(&self, name: &str, text: &str) -> Result<()> {
        let path = self.path(name)?;
        fs::write(&path, text).map_err(|error| format!("writing {}: {error}", path.display()))
    }

    #[cfg(unix)]
    fn link(&self, to: &str, name: &str) -> Result<()> {
        let path = self.path(name)?;
        std::os::unix::fs::symlink(to, &path).map_err(|error| format!("linking {}: {error}", path.display()))
    }

    #[cfg(not(unix))]
    fn link(&self, _to: &str, name: &str) -> Result<()> {
        Err(format!(
            "{name} is a symbolic link, which this system does not support; copy the library instead"
        ))
    }
}
