//! `cargo xtask deb`: Debian packages of the command, the C library, its development files and our own models.
//!
//! The files are staged in `target/deb` ([`tree`]), the C library by the same code as `cargo xtask install-c`. Debian's tools find the
//! dependencies and the symbols ([`relations`]); the manual pages are made from `--help` ([`manual`]), the licences from the linked crates
//! ([`copyright`]).

mod copyright;
mod manual;
mod relations;
mod tree;

use std::fs;
use std::path::{Path, PathBuf};

use crate::deny::allowed_licences;
use crate::inputs;
use crate::install_c::{self, Libraries};
use crate::linked::{self, Build};
use crate::shell::{Result, command, is_installed, output, root, step, target};
use crate::source_date::SourceDate;
use relations::Sources;
use tree::{Common, Fields, Tree};

/// Version of the packages with Debian's revision.
const VERSION: &str = concat!(env!("CARGO_PKG_VERSION"), "-1");

/// Programs that this task starts, with the Debian packages that have them.
const TOOLS: [(&str, &str); 6] = [
    ("dpkg-deb", "dpkg"),
    ("dpkg-shlibdeps", "dpkg-dev"),
    ("help2man", "help2man"),
    ("lintian", "lintian"),
    ("md5sum", "coreutils"),
    ("strip", "binutils"),
];

const TOOLKIT: &str = "OpenDR is a toolkit of perception and learning for robots: object detection, tracking, pose estimation, \
    segmentation, speech, grasping, reinforcement learning. This implementation in Rust needs neither Python nor PyTorch.";

/// Builds the packages into `target/deb` from a build in the profile `dist`, or from the programs in `binaries`, and checks them.
pub fn run(binaries: Option<&Path>) -> Result<()> {
    let missing: Vec<_> =
        TOOLS.iter().filter(|(tool, _)| !is_installed(tool)).map(|(_, package)| *package).collect();
    if !missing.is_empty() {
        return Err(format!("run \"apt-get install {}\" first", missing.join(" ")));
    }
    let binaries = match binaries {
        Some(folder) => folder.to_owned(),
        None => build()?,
    };
    let folder = std::path::absolute(target().join("deb")).map_err(|error| error.to_string())?;
    fs::create_dir_all(&folder).map_err(|error| format!("{}: {error}", folder.display()))?;
    let packages = Packages::new(folder)?;
    packages.stage(&binaries)?;
    let built = packages.build()?;
    for package in &built {
        let size = fs::metadata(package).map_err(|error| format!("{}: {error}", package.display()))?.len();
        println!("{}: {:.2} MB", package.display(), size as f64 / 1e6);
    }
    step("lintian", command("lintian").args(["--fail-on", "error,warning", "--allow-root"]).args(&built))
}

/// Builds the command and the C library for users, and returns their folder.
fn build() -> Result<PathBuf> {
    let mut cargo = command("cargo");
    cargo.args([
        "build",
        "--locked",
        "--profile",
        "dist",
        "--package",
        "opendr-cli",
        "--package",
        "opendr-c",
    ]);
    step("command and C library", cargo.args(["--features", "opendr-cli/training"]))?;
    Ok(target().join("dist"))
}

/// The packages while they are made.
struct Packages {
    folder: PathBuf,
    common: Common,
    architecture: String,
    /// Folder of libraries relative to `/usr`: `lib/x86_64-linux-gnu`.
    libraries: String,
    command: Tree,
    library: Tree,
    development: Tree,
    models: Tree,
}

impl Packages {
    fn new(folder: PathBuf) -> Result<Self> {
        let triplet = output(command("dpkg-architecture").arg("-qDEB_HOST_MULTIARCH"))?;
        let architecture = output(command("dpkg").arg("--print-architecture"))?;
        let of = |name: &str| Tree::new(folder.join("staged").join(name));
        Ok(Self {
            common: Common {
                version: VERSION.to_owned(),
                maintainer: maintainer(),
                homepage: env!("CARGO_PKG_REPOSITORY").to_owned(),
                date: SourceDate::get()?,
            },
            architecture: architecture.trim().to_owned(),
            libraries: format!("lib/{}", triplet.trim()),
            command: of("opendr")?,
            library: of("libopendr0")?,
            development: of("libopendr-dev")?,
            models: of("opendr-models")?,
            folder,
        })
    }

    /// Puts the files into the packages.
    fn stage(&self, binaries: &Path) -> Result<()> {
        self.command.copy(&binaries.join("opendr"), "usr/bin/opendr")?;
        strip(
            &self.command.path("usr/bin/opendr")?,
            &["--remove-section=.comment", "--remove-section=.note"],
        )?;
        for (name, page) in manual::pages(&self.command.path("usr/bin/opendr")?, self.common.date)? {
            self.command.write_gzipped(&format!("usr/share/man/man1/{name}.1"), &page)?;
        }
        let c = self.folder.join("staged/c");
        // A missing folder is no error.
        fs::remove_dir_all(&c).ok();
        install_c::install(&c.join("usr"), binaries, &Libraries(&self.libraries))?;
        let shared = format!("usr/{}/libopendr.so.", self.libraries);
        self.library.take(&c, |name| name.starts_with(&shared))?;
        self.models.take(&c, |name| name.starts_with("usr/share/opendr/models/"))?;
        self.development.take(&c, |_| true)?;
        let file = |name: &str| format!("usr/{}/{name}", self.libraries);
        let library = self.library.path(&file(&format!("libopendr.so.{}", env!("CARGO_PKG_VERSION"))))?;
        strip(&library, &["--strip-unneeded", "--remove-section=.comment", "--remove-section=.note"])?;
        let archive = self.development.path(&file("libopendr.a"))?;
        strip(&archive, &["--strip-debug", "--enable-deterministic-archives", "--remove-section=.comment"])?;
        let shlibs = format!("libopendr 0 libopendr0 (>= {})\n", env!("CARGO_PKG_VERSION"));
        self.library.write("DEBIAN/shlibs", &shlibs)?;
        self.library.write("DEBIAN/triggers", "activate-noawait ldconfig\n")?;
        self.document()
    }

    /// Writes licences and changelogs.
    fn document(&self) -> Result<()> {
        let build = Build { packages: &["opendr-cli", "opendr-c"], features: &["opendr-cli/training"] };
        let crates = linked::crates(&build)?;
        let homepage = &self.common.homepage;
        let licences = copyright::file(&crates, &allowed_licences()?, homepage)?;
        let changelog = format!(
            "opendr ({VERSION}) unstable; urgency=medium\n\n  * Release {} of OpenDR in Rust: see changelog.gz.\n\n -- {}  {}\n",
            env!("CARGO_PKG_VERSION"),
            self.common.maintainer,
            self.common.date.rfc2822()
        );
        let upstream = inputs::text("CHANGELOG.md")?;
        for (tree, name, licences) in [
            (&self.command, "opendr", licences.clone()),
            (&self.library, "libopendr0", licences),
            (&self.models, "opendr-models", copyright::own_file(homepage)?),
        ] {
            let overrides = root().join("packaging/debian/lintian-overrides");
            tree.copy(&overrides, &format!("usr/share/lintian/overrides/{name}"))?;
            tree.write(&format!("usr/share/doc/{name}/copyright"), &licences)?;
            tree.write_gzipped(&format!("usr/share/doc/{name}/changelog.Debian"), &changelog)?;
            tree.write_gzipped(&format!("usr/share/doc/{name}/changelog"), &upstream)?;
        }
        // The package depends on that of the library in the same version.
        self.development.link("libopendr0", "usr/share/doc/libopendr-dev")?;
        Ok(())
    }

    /// Builds the packages and returns their paths.
    fn build(&self) -> Result<Vec<PathBuf>> {
        let sources = Sources::new(self.folder.join("staged/sources"), &["opendr", "libopendr0"])?;
        let staged = self.folder.join("staged/libopendr0");
        let library =
            staged.join(format!("usr/{}/libopendr.so.{}", self.libraries, env!("CARGO_PKG_VERSION")));
        sources.write_symbols(&staged, "libopendr0", VERSION)?;
        let of_command = sources.needed(&self.command.path("usr/bin/opendr")?)?;
        let of_library = sources.needed(&library)?;
        let models = || format!("opendr-models (= {VERSION})");
        let build = |tree: &Tree, fields: &Fields| tree.build(fields, &self.common, &self.folder);
        Ok(vec![
            build(
                &self.command,
                &Fields {
                    name: "opendr",
                    architecture: &self.architecture,
                    multi_arch: None,
                    section: "science",
                    relations: &[
                        ("Depends", of_command),
                        ("Recommends", models()),
                        ("Suggests", "ffmpeg, npm, python3-pip".into()),
                    ],
                    synopsis: "perception and learning for robots (command)",
                    description: &[
                        TOOLKIT,
                        "This package has the command opendr, which runs, trains, evaluates and tunes models, and serves them as ROS nodes.",
                    ],
                },
            )?,
            build(
                &self.library,
                &Fields {
                    name: "libopendr0",
                    architecture: &self.architecture,
                    multi_arch: Some("same"),
                    section: "libs",
                    relations: &[("Depends", of_library), ("Recommends", models())],
                    synopsis: "perception and learning for robots (C library)",
                    description: &[
                        TOOLKIT,
                        "This package has the shared library with the interface for C and C++.",
                    ],
                },
            )?,
            build(
                &self.development,
                &Fields {
                    name: "libopendr-dev",
                    architecture: &self.architecture,
                    multi_arch: Some("same"),
                    section: "libdevel",
                    relations: &[("Depends", format!("libopendr0 (= {VERSION})"))],
                    synopsis: "perception and learning for robots (development files)",
                    description: &[
                        TOOLKIT,
                        "This package has the headers, the static library, the files for pkg-config and the package for CMake.",
                    ],
                },
            )?,
            build(
                &self.models,
                &Fields {
                    name: "opendr-models",
                    architecture: "all",
                    multi_arch: Some("foreign"),
                    section: "science",
                    relations: &[("Enhances", "opendr, libopendr0".into())],
                    synopsis: "perception and learning for robots (trained models)",
                    description: &[
                        TOOLKIT,
                        "This package has the models that OpenDR trained itself; the command and the library find them without network access.",
                    ],
                },
            )?,
        ])
    }
}

/// Returns `DEBFULLNAME <DEBEMAIL>`, by default the authors at the forge's address without replies.
fn maintainer() -> String {
    let of = |name: &str, otherwise: &str| std::env::var(name).unwrap_or_else(|_| otherwise.to_owned());
    format!(
        "{} <{}>",
        of("DEBFULLNAME", "The OpenDR authors"),
        of("DEBEMAIL", "opendr-rs@users.noreply.github.com")
    )
}

fn strip(program: &Path, options: &[&str]) -> Result<()> {
    output(command("strip").args(options).arg(program)).map(drop)
}
