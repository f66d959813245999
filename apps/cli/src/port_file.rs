//! Files of further ports. A file of targets holds one target for all frames, one per line, or the lines of
//! `opendr infer --json`. Data come from one file for all frames, or from a folder with one file per frame.

use std::fs;
use std::path::{Path, PathBuf};

use opendr::datasets::{open_value, value_files};
use opendr::learner::Port;
use opendr::{Error, Result, ResultExt, Value, ValueType};
use serde_json::{Map, Value as Json};

/// Maximum size of a file of targets, in bytes.
const MAX_BYTES: u64 = 1 << 30;

/// Values of one port.
#[derive(Debug)]
pub struct PortFile {
    name: &'static str,
    values: Values,
}

#[derive(Debug)]
enum Values {
    Same(Box<Value>),
    PerFrame(Vec<Option<Value>>),
    Files { kind: ValueType, paths: Vec<PathBuf> },
}

impl PortFile {
    /// Reads the file that the user gave for `port`.
    ///
    /// # Errors
    /// `NotFound` or `Io` when the file cannot be read, `Format` for other content, `Unsupported` for a data type without a file
    /// format.
    pub fn read(port: &Port, path: &Path) -> Result<Self> {
        let reading = || format!("reading {} for input {:?}", path.display(), port.name);
        Self::from_file(port, path).context(reading)
    }

    fn from_file(port: &Port, path: &Path) -> Result<Self> {
        if !port.value_type.is_target() {
            let values = match path.is_dir() {
                true => Values::Files { kind: port.value_type, paths: value_files(port.value_type, path)? },
                false => Values::Same(Box::new(open_value(port.value_type, path)?)),
            };
            return Ok(Self { name: port.name, values });
        }
        let size = fs::metadata(path)?.len();
        if size > MAX_BYTES {
            return Err(Error::invalid_input(format!(
                "the file has {size} bytes; at most {MAX_BYTES} are allowed"
            )));
        }
        let text = fs::read(path)?;
        let values = match serde_json::from_slice::<Value>(&text) {
            Ok(value) => Values::Same(Box::new(of_type(port.value_type, value)?)),
            Err(no_target) => Values::PerFrame(values_of_lines(port, &text).map_err(|error| {
                error.context(format!(
                    "neither one target ({no_target}) nor lines of them or of \"opendr infer --json\""
                ))
            })?),
        };
        Ok(Self { name: port.name, values })
    }

    /// Returns the name of the port.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// Returns the value for the frame of `index` among all inputs.
    ///
    /// # Errors
    /// `InvalidInput` when there is no value for the frame; the error of a file that cannot be read.
    pub fn value(&self, index: u64) -> Result<Value> {
        let at = usize::try_from(index).unwrap_or(usize::MAX);
        let none = |what: &str, count: usize| {
            let name = self.name;
            Error::invalid_input(format!("input {name:?} has no value for frame {index} ({count} {what})"))
        };
        match &self.values {
            Values::Same(value) => Ok((**value).clone()),
            Values::PerFrame(values) => {
                let value = values.get(at).and_then(Option::as_ref);
                value.cloned().ok_or_else(|| none("lines", values.len()))
            }
            Values::Files { kind, paths } => {
                open_value(*kind, paths.get(at).ok_or_else(|| none("files", paths.len()))?)
            }
        }
    }
}

fn values_of_lines(port: &Port, text: &[u8]) -> Result<Vec<Option<Value>>> {
    let lines = text.split(|byte| *byte == b'\n').filter(|line| !line.trim_ascii().is_empty());
    let value = |(number, line)| {
        value_of_line(port, line).map_err(|error| error.context(format!("line {}", number + 1)))
    };
    lines.enumerate().map(value).collect()
}

/// Returns the target of a line: the line itself, or an output of a line of `opendr infer --json`.
fn value_of_line(port: &Port, line: &[u8]) -> Result<Option<Value>> {
    let wrong = |error: serde_json::Error| Error::format(error.to_string());
    let mut line: Map<String, Json> = serde_json::from_slice(line).map_err(wrong)?;
    if line.contains_key("type") {
        let value = serde_json::from_value(Json::Object(line)).map_err(wrong)?;
        return of_type(port.value_type, value).map(Some);
    }
    // A frame that failed has no outputs.
    let Some(Json::Object(outputs)) = line.remove("outputs") else { return Ok(None) };
    let mut outputs = outputs.into_iter().map(|(_, json)| json);
    let found = outputs.find(|json| json["type"] == port.value_type.name());
    found.map(serde_json::from_value).transpose().map_err(wrong)
}

fn of_type(expected: ValueType, value: Value) -> Result<Value> {
    let given = value.as_value_ref().value_type();
    if given == expected {
        return Ok(value);
    }
    Err(Error::invalid_input(format!(
        "the file contains a {}, but the input is a {}",
        given.name(),
        expected.name()
    )))
}

#[cfg(test)]
mod tests {
    use super::*;

    const PORT: Port = Port {
        name: "detections",
        doc: "",
        value_type: ValueType::BoundingBoxList,
        optional: false,
        init: false,
    };
    const BOXES: &str = r#"{"type":"BoundingBoxList","boxes":[]}"#;

    fn read(name: &str, text: &str) -> Result<PortFile> {
        let path = std::env::temp_dir().join(format!("opendr-port-{name}-{}", std::process::id()));
        fs::write(&path, text).unwrap();
        let file = PortFile::read(&PORT, &path);
        fs::remove_file(path).unwrap();
        file
    }

    #[test]
    fn one_target_applies_to_every_frame() {
        let file = read("one", BOXES).unwrap();
        assert_eq!(file.value(0).unwrap(), file.value(99).unwrap());
        let error = read("poses", r#"{"type":"PoseList","poses":[]}"#).unwrap_err();
        assert!(
            error.to_string().contains("contains a PoseList, but the input is a BoundingBoxList"),
            "{error}"
        );
    }

    #[test]
    fn each_line_applies_to_one_frame() {
        let line = format!(r#"{{"input":"a","index":0,"outputs":{{"boxes":{BOXES}}}}}"#);
        let file = read("lines", &format!("{line}\n{{\"error\":{{}}}}\n\n{line}\n")).unwrap();
        assert!(file.value(0).is_ok() && file.value(2).is_ok());
        assert!(file.value(1).is_err() && file.value(3).is_err());
    }

    #[test]
    fn each_line_may_be_a_target() {
        let file = read("targets", &format!("{BOXES}\n\n{BOXES}\n")).unwrap();
        assert!(file.value(0).is_ok() && file.value(1).is_ok() && file.value(2).is_err());
        let wrong = read("wrong", &format!("{BOXES}\n{{\"type\":\"PoseList\",\"poses\":[]}}\n"));
        assert!(wrong.unwrap_err().to_string().contains("line 2"));
    }

    #[test]
    fn other_files_are_refused() {
        for text in ["", "text", "[1,2]", r#"{"type":"Nonsense"}"#] {
            let refused = read("other", text).and_then(|file| file.value(0));
            assert!(refused.is_err(), "{text:?}");
        }
    }
}
