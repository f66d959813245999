//! The files of a Debian package, staged in a folder and built with dpkg-deb.

use std::fmt::Write;
use std::fs;
use std::os::unix::fs::{PermissionsExt, symlink};
use std::path::{Path, PathBuf};

use crate::install_c::files_below;
use crate::shell::{Result, command, output, step};
use crate::source_date::SourceDate;

/// The fields of a package that are not those of all.
pub struct Fields<'a> {
    /// Name of the package.
    pub name: &'a str,
    /// `amd64`, or `all` where it has no machine code.
    pub architecture: &'a str,
    /// `same`, where versions of several architectures can be installed together, `foreign`, where one serves all, or neither.
    pub multi_arch: Option<&'a str>,
    /// Section of Debian's archive.
    pub section: &'a str,
    /// Relations to other packages: field and value, in the order of the control file. Those without a value are left out.
    pub relations: &'a [(&'a str, String)],
    /// First line of the description.
    pub synopsis: &'a str,
    /// The rest of it; paragraphs.
    pub description: &'a [&'a str],
}

/// The fields that all packages share.
pub struct Common {
    /// Version with Debian's revision: `0.1.0-1`.
    pub version: String,
    /// Name and address.
    pub maintainer: String,
    /// Address of the sources.
    pub homepage: String,
    /// Date of all files.
    pub date: SourceDate,
}

/// A staged package.
pub struct Tree {
    folder: PathBuf,
}

impl Tree {
    /// Creates an empty folder for a package.
    pub fn new(folder: PathBuf) -> Result<Self> {
        // A missing folder is no error.
        fs::remove_dir_all(&folder).ok();
        fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
        Ok(Self { folder })
    }

    /// Returns the path of a file of the package, whose folder exists afterwards.
    pub fn path(&self, name: &str) -> Result<PathBuf> {
        let path = self.folder.join(name);
        let parent = path.parent().unwrap_or(&self.folder);
        fs::create_dir_all(parent).map_err(|error| format!("{}: {error}", parent.display()))?;
        Ok(path)
    }

    /// Writes a file.
    pub fn write(&self, name: &str, text: &str) -> Result<()> {
        let path = self.path(name)?;
        fs::write(&path, text).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Writes a file compressed, with `.gz` after its name. The time of the compression is not in it.
    pub fn write_gzipped(&self, name: &str, text: &str) -> Result<()> {
        self.write(name, text)?;
        output(command("gzip").args(["--best", "--no-name", "--force"]).arg(self.path(name)?))?;
        Ok(())
    }

    /// Copies a file.
    pub fn copy(&self, from: &Path, name: &str) -> Result<()> {
        let path = self.path(name)?;
        fs::copy(from, &path)
            .map_err(|error| format!("{} to {}: {error}", from.display(), path.display()))?;
        Ok(())
    }

    /// Creates a symbolic link.
    pub fn link(&self, to: &str, name: &str) -> Result<()> {
        let path = self.path(name)?;
        symlink(to, &path).map_err(|error| format!("{}: {error}", path.display()))
    }

    /// Moves the files below `from` whose relative path matches into the same places of the package, links as links.
    pub fn take(&self, from: &Path, matches: impl Fn(&str) -> bool) -> Result<()> {
        for (file, name) in files_below(from)? {
            if matches(&name) {
                let path = self.path(&name)?;
                fs::rename(&file, &path)
                    .map_err(|error| format!("{} to {}: {error}", file.display(), path.display()))?;
            }
        }
        Ok(())
    }

    /// Builds the package into `folder` and returns its path.
    pub fn build(&self, fields: &Fields, common: &Common, folder: &Path) -> Result<PathBuf> {
        let (mut sums, mut kibibytes) = (String::new(), 0);
        let mut files = files_below(&self.folder)?;
        files.retain(|(_, name)| !name.starts_with("DEBIAN/"));
        files.sort();
        for (file, name) in &files {
            let about = fs::symlink_metadata(file).map_err(|error| format!("{}: {error}", file.display()))?;
            kibibytes += about.len().div_ceil(1024).max(1);
            if about.is_file() {
                let sum = output(command("md5sum").arg("--").arg(file))?;
                let sum = sum.split(' ').next().unwrap_or_default().trim_start_matches('\\');
                let _ = writeln!(sums, "{sum}  {name}");
            }
        }
        self.write("DEBIAN/md5sums", &sums)?;
        self.write("DEBIAN/control", &control(fields, common, kibibytes))?;
        allow(&self.folder)?;
        let path = folder.join(format!("{}_{}_{}.deb", fields.name, common.version, fields.architecture));
        let mut build = command("dpkg-deb");
        build.args(["--root-owner-group", "-Zxz", "--build"]).arg(&self.folder).arg(&path);
        build.env("SOURCE_DATE_EPOCH", common.date.seconds().to_string());
        step(&format!("package {}", fields.name), &mut build)?;
        Ok(path)
    }
}

/// Returns the control file.
fn control(fields: &Fields, common: &Common, kibibytes: u64) -> String {
    let mut text = format!(
        "Package: {}\nSource: opendr\nVersion: {}\nArchitecture: {}\n",
        fields.name, common.version, fields.architecture
    );
    if let Some(multi_arch) = fields.multi_arch {
        let _ = writeln!(text, "Multi-Arch: {multi_arch}");
    }
    let _ = writeln!(text, "Maintainer: {}\nInstalled-Size: {kibibytes}", common.maintainer);
    for (field, value) in fields.relations.iter().filter(|(_, value)| !value.is_empty()) {
        let _ = writeln!(text, "{field}: {value}");
    }
    let _ = writeln!(text, "Section: {}\nPriority: optional\nHomepage: {}", fields.section, common.homepage);
    let _ = writeln!(text, "Description: {}", fields.synopsis);
    text + &paragraphs(fields.description)
}

/// Returns paragraphs as the lines of a field.
fn paragraphs(paragraphs: &[&str]) -> String {
    let wrapped = paragraphs.iter().map(|paragraph| {
        let mut lines = vec![String::new()];
        for word in paragraph.split_whitespace() {
            let last = lines.last().map_or(0, String::len);
            if last + word.len() > 76 {
                lines.push(String::new());
            }
            if let Some(line) = lines.last_mut() {
                line.push(' ');
                line.push_str(word);
            }
        }
        lines.join("\n") + "\n"
    });
    wrapped.collect::<Vec<_>>().join(" .\n")
}

/// Gives folders and programs the mode 755 and other files 644, whatever the mask of the user.
fn allow(folder: &Path) -> Result<()> {
    let failed = |path: &Path, error: std::io::Error| format!("{}: {error}", path.display());
    let set = |path: &Path, mode| {
        fs::set_permissions(path, fs::Permissions::from_mode(mode)).map_err(|error| failed(path, error))
    };
    set(folder, 0o755)?;
    for entry in fs::read_dir(folder).map_err(|error| failed(folder, error))? {
        let path = entry.map_err(|error| failed(folder, error))?.path();
        let kind = fs::symlink_metadata(&path).map_err(|error| failed(&path, error))?.file_type();
        if kind.is_dir() {
            allow(&path)?;
        } else if kind.is_file() {
            set(&path, if folder.ends_with("bin") { 0o755 } else { 0o644 })?;
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paragraphs_are_lines_of_a_field() {
        let long = ["word"; 30].join(" ");
        let text = paragraphs(&[long.as_str(), "end"]);
        assert!(text.lines().all(|line| line.starts_with(' ') && line.len() <= 80), "{text}");
        assert!(text.ends_with("\n .\n end\n"), "{text}");
    }
}
