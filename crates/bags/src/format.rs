//! Formats of recordings.

use std::fmt;
use std::str::FromStr;

use opendr_engine::Error;

/// Format of a recording.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
pub enum BagFormat {
    /// rosbag 1, format 2.0: a `.bag` file.
    Bag1,
    /// rosbag 2 with SQLite: a folder with `metadata.yaml` and a `.db3` file.
    Bag2Sqlite,
    /// rosbag 2 with MCAP: a folder with `metadata.yaml` and a `.mcap` file.
    Bag2Mcap,
    /// An MCAP file.
    Mcap,
}

impl BagFormat {
    /// All formats.
    pub const ALL: [Self; 4] = [Self::Bag1, Self::Bag2Sqlite, Self::Bag2Mcap, Self::Mcap];

    /// Returns the name for the command line and parameters.
    pub const fn name(self) -> &'static str {
        match self {
            Self::Bag1 => "bag1",
            Self::Bag2Sqlite => "bag2_sqlite",
            Self::Bag2Mcap => "bag2_mcap",
            Self::Mcap => "mcap",
        }
    }

    /// Returns whether a recording of this format is a folder.
    pub const fn is_folder(self) -> bool {
        matches!(self, Self::Bag2Sqlite | Self::Bag2Mcap)
    }
}

impl fmt::Display for BagFormat {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

impl FromStr for BagFormat {
    type Err = Error;

    fn from_str(text: &str) -> Result<Self, Error> {
        let names = || Self::ALL.map(Self::name).join(", ");
        let unknown = || Error::invalid_param(format!("unknown format {text:?}: use one of {}", names()));
        Self::ALL.into_iter().find(|format| format.name() == text).ok_or_else(unknown)
    }
}
