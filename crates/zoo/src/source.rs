//! Where a card's files can be had.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;

use serde::Deserialize;

use crate::models_package::{PACKAGE, published};

/// From a file's name in the card to its place in the source.
pub type Places = BTreeMap<String, String>;

/// One place that has all files of an item.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(tag = "kind", rename_all = "snake_case", deny_unknown_fields)]
#[non_exhaustive]
pub enum Source {
    /// Relative paths inside `OPENDR_MODEL_REPOSITORY`, a folder or an address.
    Repository {
        /// Where each file is.
        files: Places,
    },
    /// Files of `models/weights/`, weights of our own: in the data package `opendr-rs-models`, wherever it lies on this machine
    /// ([`ZooOptions::models`](crate::ZooOptions::models)), else got with the installed pip.
    ModelsPackage {
        /// Where each file is below the package's weights.
        files: Places,
    },
    /// Plain addresses.
    Url {
        /// Where each file is.
        files: Places,
    },
    /// A commit of a repository on GitHub.
    Github {
        /// `owner/name`.
        repository: String,
        /// At least twelve digits of the commit.
        commit: String,
        /// Paths in the repository.
        files: Places,
    },
    /// A package of the npm registry, got with the installed client.
    Npm(Package),
    /// A wheel of the Python package index, got with the installed client.
    Pypi(Package),
}

/// A version of a package.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
#[non_exhaustive]
pub struct Package {
    /// Its name in the registry.
    pub package: String,
    /// Its version.
    pub version: String,
    /// Bytes of the download.
    pub size: u64,
    /// PyPI: the Python version that the wheel is for, e.g. `"3.8"`; the installed one when absent.
    #[serde(default)]
    pub python: Option<String>,
    /// PyPI: the platform that the wheel is for, e.g. `"manylinux1_x86_64"`; this machine's when absent.
    #[serde(default)]
    pub platform: Option<String>,
    /// Members of the archive.
    pub files: Places,
}

impl Source {
    /// Where each file is.
    pub fn files(&self) -> &Places {
        match self {
            Self::Repository { files }
            | Self::ModelsPackage { files }
            | Self::Url { files }
            | Self::Github { files, .. } => files,
            Self::Npm(package) | Self::Pypi(package) => &package.files,
        }
    }

    /// Whether both get the same archive.
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

    /// The source with the package of weights of our own as what it is in the Python package index.
    pub(crate) fn published(&self) -> Cow<'_, Self> {
        match self {
            Self::ModelsPackage { files } => Cow::Owned(Self::Pypi(published(files))),
            other => Cow::Borrowed(other),
        }
    }

    /// The package, when it is one.
    pub fn package(&self) -> Option<&Package> {
        match self {
            Self::Npm(package) | Self::Pypi(package) => Some(package),
            _ => None,
        }
    }
}

impl fmt::Display for Source {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let first = |files: &Places| files.values().next().cloned().unwrap_or_default();
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
