//! Parsing of `.msg` and `.srv` files.

use opendr_engine::{Error, Result};

use crate::{Array, BaseType, Constant, Definition, Field, FieldType, Primitive, Service, TypeName};

impl Definition {
    /// Parses the text of a `.msg` file.
    ///
    /// # Errors
    /// `Format` with the line number.
    pub fn parse(name: TypeName, text: &str) -> Result<Self> {
        let mut definition = Self { name, fields: Vec::new(), constants: Vec::new(), doc: String::new() };
        let mut doc = String::new();
        for (index, line) in text.lines().enumerate() {
            let line = line.trim();
            if let Some(comment) = line.strip_prefix('#') {
                doc.push_str(comment.trim());
                doc.push('\n');
                continue;
            }
            if index > 0 && definition.is_empty() && definition.doc.is_empty() && doc.lines().count() > 0 {
                // The first comment line documents the message; the others belong to the first field.
                let (first, rest) = doc.split_once('\n').unwrap_or((doc.as_str(), ""));
                definition.doc = first.to_owned();
                doc = rest.to_owned();
            }
            if line.is_empty() {
                continue;
            }
            definition.add_line(line, std::mem::take(&mut doc)).map_err(|reason| {
                Error::format(format!("{}, line {}: {reason}: {line:?}", definition.name, index + 1))
            })?;
        }
        Ok(definition)
    }

    fn is_empty(&self) -> bool {
        self.fields.is_empty() && self.constants.is_empty()
    }

    fn add_line(&mut self, line: &str, doc: String) -> Result<(), &'static str> {
        let (written_type, rest) =
            line.split_once(char::is_whitespace).ok_or("a type needs a name after it")?;
        let rest = rest.trim_start();
        let end = rest.find(|c: char| !c.is_ascii_alphanumeric() && c != '_').unwrap_or(rest.len());
        let (name, after) = rest.split_at(end);
        if !name.starts_with(|c: char| c.is_ascii_alphabetic()) {
            return Err("a name begins with a letter");
        }
        let after = after.trim_start();
        if let Some(value) = after.strip_prefix('=') {
            let primitive = Primitive::from_keyword(written_type).ok_or("constants are of simple types")?;
            // In a string constant, '#' is part of the value.
            let value = if primitive == Primitive::String { value } else { without_comment(value) };
            self.constants.push(Constant {
                primitive,
                name: name.to_owned(),
                value: value.trim().to_owned(),
            });
            return Ok(());
        }
        let default = without_comment(after).trim();
        self.fields.push(Field {
            name: name.to_owned(),
            field_type: field_type(written_type, &self.name.package)?,
            default: (!default.is_empty()).then(|| default.to_owned()),
            doc: doc.trim_end().to_owned(),
        });
        Ok(())
    }
}

impl Service {
    /// Parses the text of a `.srv` file.
    ///
    /// # Errors
    /// As [`Definition::parse`]; `Format` when the line `---` is missing.
    pub fn parse(name: TypeName, text: &str) -> Result<Self> {
        let line = text.lines().position(|line| line.trim() == "---").ok_or_else(|| {
            Error::format(format!("{name}: a service has a line `---` between its request and its response"))
        })?;
        let lines: Vec<&str> = text.lines().collect();
        let part = |end: &str, lines: &[&str]| {
            Definition::parse(TypeName::new(&name.package, format!("{}_{end}", name.name)), &lines.join("\n"))
        };
        let request = part("Request", lines.get(..line).unwrap_or_default())?;
        let response = part("Response", lines.get(line + 1..).unwrap_or_default())?;
        Ok(Self { name, request, response })
    }
}

fn without_comment(text: &str) -> &str {
    text.split_once('#').map_or(text, |(before, _)| before)
}

fn field_type(written: &str, package: &str) -> Result<FieldType, &'static str> {
    let (base, array) = match written.split_once('[') {
        None => (written, Array::None),
        Some((base, bounds)) => {
            let bounds = bounds.strip_suffix(']').ok_or("`[` without `]`")?;
            let number = |text: &str| text.parse().map_err(|_| "the length of an array is a number");
            let array = match bounds.strip_prefix("<=") {
                Some(most) => Array::Bounded(number(most)?),
                None if bounds.is_empty() => Array::Unbounded,
                None => Array::Fixed(number(bounds)?),
            };
            (base, array)
        }
    };
    let base = match (Primitive::from_keyword(base), base) {
        (Some(primitive), _) => BaseType::Primitive(primitive),
        (None, "time") => BaseType::Message(TypeName::new("builtin_interfaces", "Time")),
        (None, "duration") => BaseType::Message(TypeName::new("builtin_interfaces", "Duration")),
        (None, "Header") => BaseType::Message(TypeName::new("std_msgs", "Header")),
        (None, _) if base.contains("<=") || base == "wstring" => {
            return Err("bounded and wide texts are not supported");
        }
        (None, _) => BaseType::Message(match base.split_once('/') {
            Some((package, name)) => TypeName::new(package, name),
            None => TypeName::new(package, base),
        }),
    };
    Ok(FieldType { base, array })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn parsed(text: &str) -> Result<Definition> {
        Definition::parse(TypeName::new("p", "M"), text)
    }

    #[test]
    fn fields_constants_defaults_and_comments() {
        let definition = parsed(
            "# A message.\n\n# The place.\nPose2D at\nuint8[] data # bytes\nint32 TWO = 2 # two\nstring C=a # b\nfloat64[36] c\nfloat64 w 1\nstring[<=3] names\ntime stamp\n",
        )
        .unwrap();
        assert_eq!(definition.doc, "A message.");
        assert_eq!(definition.fields[0].doc, "The place.");
        assert_eq!(
            definition.fields[0].field_type,
            FieldType { base: BaseType::Message(TypeName::new("p", "Pose2D")), array: Array::None }
        );
        assert_eq!(definition.fields[1].default, None);
        assert_eq!(definition.fields[2].field_type.array, Array::Fixed(36));
        assert_eq!(definition.fields[3].default.as_deref(), Some("1"));
        assert_eq!(definition.fields[4].field_type.array, Array::Bounded(3));
        assert_eq!(
            definition.fields[5].field_type.base,
            BaseType::Message(TypeName::new("builtin_interfaces", "Time"))
        );
        let values: Vec<_> = definition.constants.iter().map(|constant| constant.value.as_str()).collect();
        assert_eq!(values, ["2", "a # b"]);
    }

    #[test]
    fn broken_lines_are_reported_by_number() {
        for (text, part) in [
            ("int32", "line 1: a type needs a name"),
            ("int32 a\nint32 9", "line 2: a name begins"),
            ("int32[ a", "`[` without `]`"),
            ("int32[x] a", "is a number"),
            ("Pose A=1", "simple types"),
            ("wstring a", "wide texts"),
        ] {
            let error = parsed(text).unwrap_err().to_string();
            assert!(error.contains(part), "{error}");
        }
        assert!(Service::parse(TypeName::new("p", "S"), "int32 a").is_err());
    }
}
