//! Command-line arguments of ROS 1 programs: `from:=to`, `__name:=x`, `_parameter:=value`.

use crate::ParameterValue;

/// Parsed command-line arguments.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Arguments {
    /// Remappings of names, `from` and `to`.
    pub remappings: Vec<(String, String)>,
    /// Private parameters to set, such as `~rate` of `_rate:=10`.
    pub parameters: Vec<(String, ParameterValue)>,
    /// `__name:=`, the node's name.
    pub name: Option<String>,
    /// `__ns:=`, the node's namespace.
    pub namespace: Option<String>,
    /// `__hostname:=` or `__ip:=`, the name or address of this machine for other nodes.
    pub host: Option<String>,
    /// `__master:=`, the master's URI.
    pub master_uri: Option<String>,
    /// Everything else, in order.
    pub rest: Vec<String>,
}

impl Arguments {
    /// Parses `arguments` (without the program's name). `Node::new` checks the names.
    pub fn new(arguments: impl IntoIterator<Item = String>) -> Self {
        let mut found = Self::default();
        for argument in arguments {
            let Some((from, to)) = argument.split_once(":=") else {
                found.rest.push(argument);
                continue;
            };
            let to = to.to_owned();
            match from {
                "__name" => found.name = Some(to),
                "__ns" => found.namespace = Some(to),
                "__hostname" | "__ip" => found.host = Some(to),
                "__master" => found.master_uri = Some(to),
                _ if from.starts_with("__") => {} // `__log` and the like, which roslaunch adds.
                _ => match from.strip_prefix('_') {
                    Some(key) => found.parameters.push((format!("~{key}"), scalar(&to))),
                    None => found.remappings.push((from.to_owned(), to)),
                },
            }
        }
        found
    }
}

/// Parses a value as in roscpp: an integer, a number, a Boolean or a string.
fn scalar(text: &str) -> ParameterValue {
    if let Ok(number) = text.parse() {
        return ParameterValue::Int(number);
    }
    if let Ok(number) = text.parse() {
        return ParameterValue::Double(number);
    }
    match text {
        "true" | "True" | "TRUE" => ParameterValue::Bool(true),
        "false" | "False" | "FALSE" => ParameterValue::Bool(false),
        _ => ParameterValue::String(text.to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_command_line_is_parsed() {
        let line = "run image:=/usb/image __name:=left __ns:=drone _rate:=10 _on:=true _gain:=0.5 _who:=me \
                    __log:=/tmp/x __ip:=10.0.0.1 __master:=http://a:1 --fast";
        let found = Arguments::new(line.split_whitespace().map(str::to_owned));
        assert_eq!(found.remappings, [("image".to_owned(), "/usb/image".to_owned())]);
        assert_eq!(
            found.parameters,
            [
                ("~rate".to_owned(), ParameterValue::Int(10)),
                ("~on".to_owned(), ParameterValue::Bool(true)),
                ("~gain".to_owned(), ParameterValue::Double(0.5)),
                ("~who".to_owned(), ParameterValue::String("me".to_owned())),
            ]
        );
        assert_eq!(found.name.as_deref(), Some("left"));
        assert_eq!(found.namespace.as_deref(), Some("drone"));
        assert_eq!(found.host.as_deref(), Some("10.0.0.1"));
        assert_eq!(found.master_uri.as_deref(), Some("http://a:1"));
        assert_eq!(found.rest, ["run", "--fast"]);
    }
}
