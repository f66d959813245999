//! ROS arguments: remappings and parameters after `--ros-args`, and the syntax of ROS 1.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use opendr_engine::{Error, Result, ResultExt};
use serde::Deserialize;

/// Remappings and parameters of `ros2 run PACKAGE NODE --ros-args ...`.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct RosArgs {
    /// `from:=to`, `__node:=name`, `__ns:=/namespace`.
    pub remappings: Vec<String>,
    /// Parameters by name, with values as written; of several with one name the last applies.
    pub parameters: Vec<(String, String)>,
}

#[derive(Deserialize)]
struct OfNode {
    #[serde(default, rename = "ros__parameters")]
    parameters: BTreeMap<String, Scalar>,
}

#[derive(Deserialize)]
#[serde(untagged)]
enum Scalar {
    Bool(bool),
    Int(i64),
    Float(f64),
    Text(String),
    List(Vec<Scalar>),
}

impl Scalar {
    fn text(&self) -> String {
        match self {
            Self::Bool(value) => value.to_string(),
            Self::Int(value) => value.to_string(),
            Self::Float(value) => value.to_string(),
            Self::Text(value) => value.clone(),
            Self::List(values) => values.iter().map(Self::text).collect::<Vec<_>>().join(","),
        }
    }
}

impl RosArgs {
    /// Parses the words after `--ros-args`: `-r`/`--remap RULE`, `-p`/`--param NAME:=VALUE`, `--params-file FILE`;
    /// `--log-level`, `--enclave` and the switches of logging are accepted without effect. `node` and `namespace` are the node's, by
    /// which parameter files select parameters.
    ///
    /// # Errors
    /// `InvalidInput` for another word; `NotFound`, `Io` or `Format` for a file that cannot be read.
    pub fn parse<S: AsRef<str>>(words: &[S], namespace: &str, node: &str) -> Result<Self> {
        let mut args = Self::default();
        let mut files = Vec::new();
        let mut words = words.iter().map(AsRef::as_ref);
        while let Some(word) = words.next() {
            let mut value =
                || words.next().ok_or_else(|| Error::invalid_input(format!("{word} needs an argument")));
            match word {
                "-r" | "--remap" => args.remappings.push(value()?.to_owned()),
                "-p" | "--param" => {
                    let text = value()?;
                    let (name, value) = text.split_once(":=").ok_or_else(|| {
                        Error::invalid_input(format!("{text:?} is not a parameter; write name:=value"))
                    })?;
                    // Rules with a colon are for a certain node.
                    match name.split_once(':') {
                        Some((only, name)) if only == node => {
                            args.parameters.push((name.to_owned(), value.to_owned()))
                        }
                        Some(_) => {}
                        None => args.parameters.push((name.to_owned(), value.to_owned())),
                    }
                }
                "--params-file" => files.push(value()?.to_owned()),
                "--log-level" | "-e" | "--enclave" | "--log-config-file" | "--log-file-name" => {
                    value()?;
                }
                "--ros-args" | "--" => {}
                _ if word.starts_with("--enable-") || word.starts_with("--disable-") => {}
                _ => {
                    return Err(Error::invalid_input(format!(
                        "unknown word {word:?} after --ros-args; there are -r FROM:=TO, -p NAME:=VALUE and --params-file FILE"
                    )));
                }
            }
        }
        let named =
            crate::Names::new(namespace, node, args.remappings.iter().filter(|rule| rule.contains("__")))?;
        let mut of_files = Vec::new();
        for file in files {
            of_files.extend(parameters_of_file(Path::new(&file), &named.full())?);
        }
        of_files.append(&mut args.parameters);
        args.parameters = of_files;
        Ok(args)
    }
}

/// Converts arguments of `roslaunch` and `rosrun` (`from:=to`, `__name:=node`, `_param:=value`) to words for [`RosArgs::parse`];
/// returns `None` for another word.
///
/// # Errors
/// `Unsupported` for `__master`, `__ip` and `__hostname`, which are environment variables here.
pub fn ros_args_from_ros1(word: &str) -> Result<Option<Vec<String>>> {
    let Some((name, value)) = word.split_once(":=") else { return Ok(None) };
    if name.is_empty() || name.starts_with('-') {
        return Ok(None);
    }
    let words = |flag: &str, rule: String| Ok(Some(vec![flag.to_owned(), rule]));
    match name {
        "__log" => Ok(Some(Vec::new())),
        "__name" | "__ns" => words("-r", word.to_owned()),
        "__master" => Err(Error::unsupported("__master is not supported; set ROS_MASTER_URI")),
        "__ip" | "__hostname" => {
            Err(Error::unsupported(format!("{name} is not supported; set ROS_IP or ROS_HOSTNAME")))
        }
        _ => match name.strip_prefix('_') {
            Some(parameter) => words("-p", format!("{parameter}:={value}")),
            None => words("-r", word.to_owned()),
        },
    }
}

/// Returns the parameters of a file for the node `full`: under its name, or under `/**`.
fn parameters_of_file(path: &Path, full: &str) -> Result<Vec<(String, String)>> {
    let context = || format!("reading {}", path.display());
    let text = fs::read_to_string(path).map_err(Error::from).context(context)?;
    let nodes: BTreeMap<String, OfNode> = serde_saphyr::from_str(&text)
        .map_err(|error| Error::format(format!("not a parameter file: {error}")))
        .context(context)?;
    let short = full.rsplit('/').next().unwrap_or(full);
    let mut parameters = Vec::new();
    for names in [["/**", "**"], [short, full]] {
        for name in names {
            let rows = nodes.get(name).map(|node| &node.parameters);
            parameters.extend(rows.into_iter().flatten().map(|(name, value)| (name.clone(), value.text())));
        }
    }
    Ok(parameters)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn arguments_of_roslaunch_are_converted() {
        let words = |word| ros_args_from_ros1(word).unwrap().map(|words| words.join(" "));
        assert_eq!(words("image_raw:=/camera").as_deref(), Some("-r image_raw:=/camera"));
        assert_eq!(words("__name:=eyes").as_deref(), Some("-r __name:=eyes"));
        assert_eq!(words("_threshold:=0.5").as_deref(), Some("-p threshold:=0.5"));
        assert_eq!(words("__log:=/tmp/x.log").as_deref(), Some(""));
        assert_eq!((words("nanodet"), words("--image")), (None, None));
        assert!(ros_args_from_ros1("__master:=http://x").is_err());
    }

    #[test]
    fn arguments_of_launch_files_are_parsed() {
        let file = std::env::temp_dir().join(format!("opendr-params-{}.yaml", std::process::id()));
        let text = "/**:\n  ros__parameters:\n    threshold: 0.25\n    classes: [1, 2]\neyes:\n  ros__parameters: {annotate: false}\nother:\n  ros__parameters:\n    threshold: 0.9\n";
        fs::write(&file, text).unwrap();
        let file = file.display().to_string();
        let words = [
            "--ros-args",
            "-r",
            "__node:=eyes",
            "-r",
            "image_raw:=/camera",
            "--params-file",
            &file,
            "-p",
            "threshold:=0.5",
            "-p",
            "other:x:=1",
            "--log-level",
            "info",
            "--disable-stdout-logs",
        ];
        let args = RosArgs::parse(&words, "/", "nanodet").unwrap();
        assert_eq!(args.remappings, ["__node:=eyes", "image_raw:=/camera"]);
        let parameters: Vec<_> =
            args.parameters.iter().map(|(name, value)| format!("{name}={value}")).collect();
        assert_eq!(parameters, ["classes=1,2", "threshold=0.25", "annotate=false", "threshold=0.5"]);
        fs::write(&file, "a: [").unwrap();
        assert!(RosArgs::parse(&["--params-file", &file], "/", "nanodet").is_err());
        fs::remove_file(&file).unwrap();
        for words in [&["-p"][..], &["-p", "x"], &["stray"], &["--params-file", &file]] {
            assert!(RosArgs::parse(words, "/", "nanodet").is_err(), "{words:?}");
        }
    }
}
