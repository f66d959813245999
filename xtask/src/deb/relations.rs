//! What a Debian package needs and provides: the shared libraries of its programs, the symbols of its library.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

use crate::deb::tree::Tree;
use crate::shell::{Result, output};

/// A folder with the `debian/control` that Debian's tools read.
pub struct Sources(PathBuf);

impl Sources {
    /// Writes `debian/control` with the names of the packages into a folder.
    pub fn new(folder: PathBuf, packages: &[&str]) -> Result<Self> {
        let tree = Tree::new(folder.clone())?;
        let stanzas = packages.iter().map(|package| format!("\nPackage: {package}\nArchitecture: any\n"));
        tree.write("debian/control", &format!("Source: opendr\n{}", stanzas.collect::<String>()))?;
        Ok(Self(folder))
    }

    /// Returns the packages whose shared libraries a program or library uses, as a value of `Depends`.
    pub fn needed(&self, program: &Path) -> Result<String> {
        let mut shlibdeps = self.tool("dpkg-shlibdeps");
        let listed = output(shlibdeps.args(["--warnings=1", "-O", "-e"]).arg(program))?;
        let depends = listed.lines().find_map(|line| line.strip_prefix("shlibs:Depends="));
        depends
            .map(str::to_owned)
            .ok_or_else(|| format!("dpkg-shlibdeps: no dependencies of {}", program.display()))
    }

    /// Writes the control file `symbols` of a library: each symbol with the version that introduced it.
    pub fn write_symbols(&self, tree: &Path, package: &str, version: &str) -> Result<()> {
        let upstream = version.rsplit_once('-').map_or(version, |(upstream, _)| upstream);
        let mut gensymbols = self.tool("dpkg-gensymbols");
        gensymbols.arg(format!("-p{package}")).arg(format!("-v{upstream}"));
        gensymbols.arg(format!("-P{}", tree.display()));
        let path = tree.join("DEBIAN/symbols");
        output(gensymbols.arg(format!("-O{}", path.display())))?;
        let failed = |error: std::io::Error| format!("{}: {error}", path.display());
        let symbols = fs::read_to_string(&path).map_err(failed)?;
        // Builders of other packages name the development package by it.
        let symbols = symbols.replacen("#MINVER#\n", "#MINVER#\n* Build-Depends-Package: libopendr-dev\n", 1);
        fs::write(&path, symbols).map_err(failed)
    }

    fn tool(&self, name: &str) -> Command {
        let mut tool = Command::new(name);
        tool.current_dir(&self.0);
        tool
    }
}
