//! Versions of the JSON files that users keep.

use serde::de::DeserializeOwned;
use serde::{Serialize, Serializer};
use serde_json::Value;

use crate::{Error, Result};

/// Key of the version.
const KEY: &str = "format_version";

/// A format of JSON files with its version. Each format is one constant, beside the type that is written.
///
/// A version is an object with the key `format_version`. The version increases when a key changes its name or its meaning; the
/// type reads the former keys by `#[serde(alias)]`.
///
/// ```
/// use opendr_engine::JsonFormat;
///
/// const REPORT: JsonFormat = JsonFormat::new("report", 2);
/// let json = REPORT.to_json(&[("map", 0.5)].into_iter().collect::<std::collections::BTreeMap<_, _>>())?;
/// assert_eq!(json, r#"{"format_version":2,"map":0.5}"#);
/// assert!(REPORT.read::<serde_json::Value>(br#"{"format_version": 3}"#).is_err());
/// # Ok::<_, opendr_engine::Error>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct JsonFormat {
    name: &'static str,
    version: u32,
    former_key: Option<&'static str>,
}

impl JsonFormat {
    /// Creates a format; `name` is used in errors, `version` is the version that is written.
    pub const fn new(name: &'static str, version: u32) -> Self {
        Self { name, version, former_key: None }
    }

    /// Reads the version from `key` where there is no `format_version`.
    #[must_use]
    pub const fn with_former_key(mut self, key: &'static str) -> Self {
        self.former_key = Some(key);
        self
    }

    /// Adds the version to a value that serialises as an object.
    pub fn versioned<'a, T: Serialize>(&self, content: &'a T) -> impl Serialize + use<'a, T> {
        Versioned { format_version: self.version, content }
    }

    /// Returns a value with its version as a line of JSON.
    ///
    /// # Errors
    /// `Internal` for a value that does not serialise as an object.
    pub fn to_json(&self, content: &impl Serialize) -> Result<String> {
        serde_json::to_string(&self.versioned(content)).map_err(|error| self.not_serialisable(error))
    }

    /// Returns a value with its version as indented JSON that ends with a line feed.
    ///
    /// # Errors
    /// As [`Self::to_json`].
    pub fn to_pretty_json(&self, content: &impl Serialize) -> Result<String> {
        let text = serde_json::to_string_pretty(&self.versioned(content));
        text.map(|text| text + "\n").map_err(|error| self.not_serialisable(error))
    }

    /// Reads JSON of this version or of an earlier one. JSON without a version is of version 1.
    ///
    /// # Errors
    /// `Unsupported` for a newer version, `Format` for JSON that is not of this format.
    pub fn read<T: DeserializeOwned>(&self, json: &[u8]) -> Result<T> {
        let value: Value = serde_json::from_slice(json).map_err(|error| self.invalid(error))?;
        self.check(&value)?;
        serde_json::from_value(value).map_err(|error| self.invalid(error))
    }

    /// Checks the version of a parsed value and returns it.
    ///
    /// # Errors
    /// `Unsupported` for a newer version, `Format` for a version that is not a positive number.
    pub fn check(&self, value: &Value) -> Result<u64> {
        let former = || value.get(self.former_key?);
        let Some(stated) = value.get(KEY).or_else(former) else { return Ok(1) };
        let version = stated.as_u64().ok_or_else(|| self.no_version(stated))?;
        self.check_version(version).map(|()| version)
    }

    /// Checks a version that was read from a file.
    ///
    /// # Errors
    /// `Unsupported` for a newer version, `Format` for 0.
    pub fn check_version(&self, version: u64) -> Result<()> {
        match version {
            0 => Err(self.no_version(&Value::from(version))),
            version if version > u64::from(self.version) => Err(Error::unsupported(format!(
                "the {} has format version {version}, but this OpenDR reads up to {}; update OpenDR",
                self.name, self.version
            ))),
            _ => Ok(()),
        }
    }

    fn no_version(&self, stated: &Value) -> Error {
        Error::format(format!("the {} has format version {stated} instead of a number from 1", self.name))
    }

    fn invalid(&self, error: serde_json::Error) -> Error {
        Error::format(format!("this is not a {}", self.name)).with_source(error)
    }

    fn not_serialisable(&self, error: serde_json::Error) -> Error {
        Error::internal(format!("the {} cannot be written as JSON", self.name)).with_source(error)
    }
}

#[derive(Serialize)]
struct Versioned<'a, T: Serialize> {
    format_version: u32,
    #[serde(flatten, serialize_with = "content")]
    content: &'a T,
}

fn content<T: Serialize, S: Serializer>(content: &&T, serializer: S) -> std::result::Result<S::Ok, S::Error> {
    content.serialize(serializer)
}

#[cfg(test)]
mod tests {
    use serde::Deserialize;

    use super::*;
    use crate::ErrorKind;

    const FORMAT: JsonFormat = JsonFormat::new("report", 2).with_former_key("schema");

    #[derive(Debug, PartialEq, Serialize, Deserialize)]
    struct Report {
        #[serde(alias = "worst")]
        lowest: u64,
    }

    #[test]
    fn former_keys_and_versions_are_read() {
        let written = FORMAT.to_json(&Report { lowest: 3 }).unwrap();
        assert_eq!(written, r#"{"format_version":2,"lowest":3}"#);
        for json in [written.as_str(), r#"{"worst": 3}"#, r#"{"schema": 1, "worst": 3}"#] {
            assert_eq!(FORMAT.read::<Report>(json.as_bytes()).unwrap(), Report { lowest: 3 });
        }
    }

    #[test]
    fn newer_versions_are_refused_by_name() {
        for json in [r#"{"format_version": 3, "lowest": 3}"#, r#"{"schema": 18446744073709551615}"#] {
            let error = FORMAT.read::<Report>(json.as_bytes()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Unsupported);
            assert!(error.to_string().contains("the report has format version"), "{error}");
            assert!(error.to_string().contains("update OpenDR"), "{error}");
        }
    }

    #[test]
    fn other_json_is_refused() {
        for json in [
            "",
            "[]",
            "{}",
            r#"{"format_version": 0, "lowest": 3}"#,
            r#"{"format_version": "2", "lowest": 3}"#,
        ] {
            let error = FORMAT.read::<Report>(json.as_bytes()).unwrap_err();
            assert_eq!(error.kind(), ErrorKind::Format, "{json}: {error}");
        }
        assert_eq!(FORMAT.to_json(&[1]).unwrap_err().kind(), ErrorKind::Internal);
    }
}
