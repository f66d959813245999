//! Sources of a card's files.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;

/// Name of the data package with OpenDR's own weights in the Python package index.
pub(crate) const PACKAGE: &str = "opendr-rs-models";

/// Folder of the weights in its wheel.
pub(crate) const MEMBERS: &str = "opendr_rs_models/weights";

/// Size of the wheel in bytes, for the progress bar.
const WHEEL_BYTES: u64 = 12_900_000;

/// Place in the source for each file name of the card.
pub type FilePlaces = BTreeMap<String, String>;

/// A source of all files of an item.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Source {
    /// Relative paths inside `OPENDR_MODEL_REPOSITORY`, a folder or an address.
    Repository {
        /// Returns the location of each file.
        files: FilePlaces,
    },
    /// Files of `models/weights/`, OpenDR's own weights: in the data package `opendr-rs-models` on this machine
    /// ([`ZooOptions::models`](crate::ZooOptions::models)), else downloaded with the installed pip.
    ModelsPackage {
        /// Path of each file below the package's weights.
        files: FilePlaces,
    },
    /// URLs.
    Url {
        /// Returns the location of each file.
        files: FilePlaces,
    },
    /// A commit of a repository on GitHub.
    Github {
        /// `owner/name`.
        repository: String,
        /// At least twelve digits of the commit hash.
        commit: String,
        /// Paths in the repository.
        files: FilePlaces,
    },
    /// A package of the npm registry, downloaded with the installed client.
    Npm(Package),
    /// A wheel of the Python package index, downloaded with the installed client.
    Pypi(Package),
}

/// A version of a package.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Package {
    /// Name in the registry.
    pub package: String,
    /// Version.
    pub version: String,
    /// Size of the download in bytes.
    pub size: u64,
    /// PyPI: Python version of the wheel, such as `"3.8"` (default: the installed one).
    #[serde(default)]
    pub python: Option<String>,
    /// PyPI: platform of the wheel, such as `"manylinux1_x86_64"` (default: that of this machine).
    #[serde(default)]
    pub platform: Option<String>,
    /// Members of the archive.
    pub files: FilePlaces,
}

impl Source {
    /// Returns the location of each file.
    pub fn files(&self) -> &FilePlaces {
        match self {
            Self::Repository { files }
            | Self::ModelsPackage { files }
            | Self::Url { files }
            | Self::Github { files, .. } => files,
            Self::Npm(package) | Self::Pypi(package) => &package.files,
        }
    }

    /// Returns whether both sources use the same archive.
    pub(crate) fn is_same_package(&self, other: &Self) -> bool {
        let same = |one: &Package, two: &Package| {
            (&one.package, &one.version, &one.python, &one.platform)
                == (&two.package, &two.version, &two.python, &two.platform)
        };
        match (self, other) {
            (Self::Npm(one), Self::Npm(two)) | (Self::Pypi(one), Self::Pypi(two)) => same(one, two),
            _ => false,
        }
    }

    /// Returns the source with the package of OpenDR's own weights replaced by its wheel in the Python package index.
    pub(crate) fn published(&self) -> Cow<'_, Self> {
        match self {
            Self::ModelsPackage { files } => Cow::Owned(Self::Pypi(published(files))),
            other => Cow::Borrowed(other),
        }
    }

    /// Returns the package of an npm or PyPI source.
    pub fn package(&self) -> Option<&Package> {
        match self {
            Self::Npm(package) | Self::Pypi(package) => Some(package),
            _ => None,
        }
    }
}

/// Returns the wheel of OpenDR's own weights of this version in the package index.
fn published(files: &FilePlaces) -> Package {
    Package {
        package: PACKAGE.to_owned(),
        version: env!("CARGO_PKG_VERSION").to_owned(),
        size: WHEEL_BYTES,
        python: None,
        platform: None,
        files: files.iter().map(|(name, place)| (name.clone(), format!("{MEMBERS}/{place}"))).collect(),
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = |files: &FilePlaces| files.values().next().cloned().unwrap_or_default();
        match self {
            Self::Repository { files } => write!(f, "OPENDR_MODEL_REPOSITORY {}", first(files)),
            Self::ModelsPackage { .. } => f.write_str(PACKAGE),
            Self::Url { files } => f.write_str(&first(files)),
            Self::Github { repository, commit, files } => {
                write!(f, "GitHub {repository}@{commit} {}", first(files))
            }
            Self::Npm(package) => write!(f, "npm {}@{}", package.package, package.version),
            Self::Pypi(package) => write!(f, "PyPI {}=={}", package.package, package.version),
        }
    }
}
