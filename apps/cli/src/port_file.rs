//! The file behind a further port. Of targets: one for every frame, one a line, or what `opendr infer --json` wrote, a line a
//! frame. Of data: one for every frame, or a folder with one for each.

use std::fs;
use std::path::{Path, PathBuf};

use opendr::datasets::{open_value, value_files};
use opendr::learner::Port;
use opendr::{Error, Result, ResultExt, Value, ValueType};
use serde_json::{Map, Value as Json};

/// Larger files are no list of targets.
const MAX_BYTES: u64 = 1 << 30;

/// The values of one port.
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
    /// `NotFound` or `Io` when the file cannot be read, `Format` when it holds something else, `Unsupported` for data that is in
    /// no file of its own.
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
            return Err(Error::invalid_input(format!("{size} bytes; at most {MAX_BYTES}")));
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

    /// The port's name.
    pub fn name(&self) -> &'static str {
        self.name
    }

    /// The value for frame number `index` of all that is read.
    ///
    /// # Errors
    /// `InvalidInput` when the file has no value for it; what kept a file of the folder from being read.
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

/// The target that a line is, or that a line of `opendr infer --json` has among its outputs.
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

fn of_type(wanted: ValueType, value: Value) -> Result<Value> {
    let given = value.as_value_ref().value_type();
    if given == wanted {
        return Ok(value);
    }
    Err(Error::invalid_input(format!("a {} where a {} is wanted", given.name(), wanted.name())))
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
    fn one_target_serves_every_frame() {
        let file = read("one", BOXES).unwrap();
        assert_eq!(file.value(0).unwrap(), file.value(99).unwrap());
        let error = read("poses", r#"{"type":"PoseList","poses":[]}"#).unwrap_err();
        assert!(error.to_string().contains("PoseList where a BoundingBoxList"), "{error}");
    }

    #[test]
    fn lines_serve_a_frame_each() {
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
