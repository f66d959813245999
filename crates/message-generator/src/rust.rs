//! Generation of the Rust source of `opendr-messages`: structs, and the table of all messages.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use opendr_engine::Result;

use crate::rihs01::EMPTY_FIELD;
use crate::text::definition_text;
use crate::{
    Array, BaseType, Definition, Field, Library, Primitive, TypeName, md5sum, rihs01, service_md5sum,
    service_rihs01,
};

const HEAD: &str =
    "// Made by `cargo xtask generate` from the definitions in `msg/` and `ros1/`: not edited by hand.\n";

/// Maximum length of arrays with `Default` and serde's traits.
const LONGEST_KNOWN_ARRAY: usize = 32;

/// Names of messages in ROS 1, where they differ; `None` for a message that ROS 1 does not have.
pub type Ros1Names = BTreeMap<TypeName, Option<TypeName>>;

/// Returns paths and contents of the source files for the messages of `ros2`, and for those of `ros1` with other fields.
///
/// # Errors
/// `NotFound` for an undefined type.
pub fn rust_files(ros2: &Library, ros1: &Library, names: &Ros1Names) -> Result<BTreeMap<String, String>> {
    let writer = Writer { ros2, ros1, names };
    let mut files = BTreeMap::new();
    let mut table = String::from("messages! {\n");
    for definition in ros2.messages() {
        let path = format!("{}.rs", definition.name.package);
        files.entry(path).or_insert_with(|| head(&definition.name.package, "")).push_str(&writer.structure(
            definition,
            "",
            &format!("`{}`", definition.name),
        )?);
        writer.write_row(&mut table, definition)?;
        if let Some(form) = writer.ros1_form(definition)?
            && writer.differs(definition, form)?
        {
            let path = format!("ros1/{}.rs", form.name.package);
            files
                .entry(path)
                .or_insert_with(|| head(&form.name.package, " as ROS 1 has them"))
                .push_str(&writer.structure(form, "ros1::", &format!("`{}` of ROS 1", form.name))?);
        }
    }
    table.push_str("}\n\nservices! {\n");
    for service in ros2.services() {
        let path = format!("{}.rs", service.name.package);
        let file = files.entry(path).or_insert_with(|| head(&service.name.package, ""));
        for (part, what) in [(&service.request, "Request"), (&service.response, "Response")] {
            file.push_str(&writer.structure(part, "", &format!("{what} of `{}`", service.name))?);
        }
        let TypeName { package, name } = &service.name;
        let (md5, hash) = (service_md5sum(ros1, service)?, service_rihs01(ros2, service)?);
        let _ = writeln!(
            table,
            "    {}({package}::{name}Request, {package}::{name}Response) = {package:?}, {name:?}, {md5:?}, {hash:?};",
            variant(&service.name)
        );
    }
    table.push_str("}\n");
    let (mut shared, own): (Vec<_>, Vec<_>) =
        files.keys().cloned().partition(|path| !path.starts_with("ros1/"));
    shared.push("ros1.rs".to_owned());
    shared.sort();
    files.insert(
        "ros1/mod.rs".to_owned(),
        format!("//! Messages that ROS 1 has with other fields.\n\n{HEAD}{}", modules(&own)),
    );
    files.insert(
        "mod.rs".to_owned(),
        format!("//! The messages, one module a package.\n\n{HEAD}\n{}\n{table}", modules(&shared)),
    );
    Ok(files)
}

fn head(package: &str, note: &str) -> String {
    format!("//! `{package}`{note}.\n\n{HEAD}\nuse serde::{{Deserialize, Serialize}};\n")
}

fn modules(paths: &[String]) -> String {
    let mut text = String::new();
    for name in paths.iter().filter_map(|path| path.rsplit('/').next()?.strip_suffix(".rs")) {
        let _ = writeln!(text, "pub mod {name};");
    }
    text
}

/// Returns the enum variant of a type: `SensorMsgsImage` for `sensor_msgs` and `Image`.
fn variant(TypeName { package, name }: &TypeName) -> String {
    let mut text = String::new();
    for word in package.split('_') {
        let mut letters = word.chars();
        text.extend(letters.next().map(|first| first.to_ascii_uppercase()));
        text.push_str(letters.as_str());
    }
    text + name
}

/// Returns the struct name: `TriggerRequest` for `Trigger_Request`.
fn struct_name(name: &TypeName) -> String {
    name.name.replace('_', "")
}

struct Writer<'a> {
    ros2: &'a Library,
    ros1: &'a Library,
    names: &'a Ros1Names,
}

impl Writer<'_> {
    /// Returns the ROS 1 definition of a message, if there is one.
    fn ros1_form(&self, definition: &Definition) -> Result<Option<&Definition>> {
        match self.names.get(&definition.name) {
            Some(None) => Ok(None),
            Some(Some(name)) => self.ros1.get(name).map(Some),
            None => self.ros1.get(&definition.name).map(Some),
        }
    }

    /// Returns whether two forms of a message differ in the wire format, apart from the header's `seq`, which the format adds.
    fn differs(&self, ros2: &Definition, ros1: &Definition) -> Result<bool> {
        if ros2.name == TypeName::new("std_msgs", "Header") {
            return Ok(false);
        }
        if ros2.fields.len() != ros1.fields.len() {
            return Ok(true);
        }
        for (a, b) in ros2.fields.iter().zip(&ros1.fields) {
            let (a, b) = (&a.field_type, &b.field_type);
            let differs = match (&a.base, &b.base) {
                _ if a.array != b.array => true,
                (BaseType::Message(a), BaseType::Message(b)) => {
                    a != b || self.differs(self.ros2.get(a)?, self.ros1.get(b)?)?
                }
                (a, b) => a != b,
            };
            if differs {
                return Ok(true);
            }
        }
        Ok(false)
    }

    /// Returns the Rust path of a message within the file of `package`.
    fn path(&self, name: &TypeName, package: &str, prefix: &str) -> Result<String> {
        let own = !prefix.is_empty()
            && match self.ros2.get(name) {
                Ok(ros2) => self.differs(ros2, self.ros1.get(name)?)?,
                Err(_) => true,
            };
        if name.package == package && own != prefix.is_empty() {
            return Ok(struct_name(name));
        }
        let prefix = if own { prefix } else { "" };
        Ok(format!("crate::{prefix}{}::{}", name.package, struct_name(name)))
    }

    fn structure(&self, definition: &Definition, prefix: &str, title: &str) -> Result<String> {
        let name = struct_name(&definition.name);
        let empty = [Field {
            name: EMPTY_FIELD.to_owned(),
            field_type: crate::FieldType { base: BaseType::Primitive(Primitive::Uint8), array: Array::None },
            default: None,
            doc: "ROS 2's filling of a message without fields; ROS 1 writes nothing.".to_owned(),
        }];
        let fields = if definition.fields.is_empty() { &empty[..] } else { &definition.fields };
        let own_default = fields.iter().any(|field| {
            field.default.as_deref().is_some_and(|value| !matches!(value, "0" | "0.0" | "false"))
                || matches!(field.field_type.array, Array::Fixed(length) if length > LONGEST_KNOWN_ARRAY)
        });
        let mut text = format!("\n/// {title}");
        text.push_str(if definition.doc.is_empty() { "." } else { ": " });
        text.push_str(&definition.doc);
        if fields.iter().any(|field| field.doc.is_empty()) {
            text.push_str("\n#[allow(missing_docs)]");
        }
        let derived = if own_default { "" } else { "Default, " };
        let _ = writeln!(
            text,
            "\n#[derive(Debug, Clone, PartialEq, {derived}Serialize, Deserialize)]\npub struct {name} {{"
        );
        let mut defaults = String::new();
        for field in fields {
            let (rust, attribute) = self.field_type(field, &definition.name.package, prefix)?;
            for line in field.doc.lines() {
                let _ = writeln!(text, "    /// {line}");
            }
            text.push_str(attribute);
            let field_name = rust_name(&field.name);
            let _ = writeln!(text, "    pub {field_name}: {rust},");
            let default = match (&field.default, &field.field_type) {
                (
                    Some(value),
                    crate::FieldType { base: BaseType::Primitive(primitive), array: Array::None },
                ) => literal(*primitive, value),
                (
                    _,
                    crate::FieldType { array: Array::Fixed(length), base: BaseType::Primitive(primitive) },
                ) => {
                    format!("[{}; {length}]", literal(*primitive, "0"))
                }
                _ => "Default::default()".to_owned(),
            };
            let _ = writeln!(defaults, "            {field_name}: {default},");
        }
        text.push_str("}\n");
        if own_default {
            let _ = writeln!(
                text,
                "\nimpl Default for {name} {{\n    fn default() -> Self {{\n        Self {{\n{defaults}        }}\n    }}\n}}"
            );
        }
        if !definition.constants.is_empty() {
            let _ = writeln!(text, "\n#[allow(missing_docs)]\nimpl {name} {{");
            for constant in &definition.constants {
                let rust = match constant.primitive {
                    Primitive::String => "&str",
                    primitive => primitive.rust(),
                };
                let value = literal(constant.primitive, &constant.value);
                let _ = writeln!(text, "    pub const {}: {rust} = {value};", constant.name);
            }
            text.push_str("}\n");
        }
        Ok(text)
    }

    /// Returns the Rust type of a field and its serde attribute.
    fn field_type(&self, field: &Field, package: &str, prefix: &str) -> Result<(String, &'static str)> {
        let base = match &field.field_type.base {
            // The package has a message of the name String.
            BaseType::Primitive(Primitive::String) if package == "std_msgs" => {
                "std::string::String".to_owned()
            }
            BaseType::Primitive(primitive) => primitive.rust().to_owned(),
            BaseType::Message(name) => self.path(name, package, prefix)?,
        };
        Ok(match field.field_type.array {
            Array::None => (base, ""),
            Array::Fixed(length) if length > LONGEST_KNOWN_ARRAY => {
                (format!("[{base}; {length}]"), "    #[serde(with = \"crate::long_array\")]\n")
            }
            Array::Fixed(length) => (format!("[{base}; {length}]"), ""),
            Array::Bounded(_) | Array::Unbounded if base == "u8" => {
                ("Vec<u8>".to_owned(), "    #[serde(with = \"serde_bytes\")]\n")
            }
            Array::Bounded(_) | Array::Unbounded => (format!("Vec<{base}>"), ""),
        })
    }

    fn write_row(&self, table: &mut String, definition: &Definition) -> Result<()> {
        let TypeName { package, name } = &definition.name;
        let names = |used: &[&Definition]| -> String {
            let names: Vec<_> = used.iter().map(|used| format!("{:?}", used.name.to_string())).collect();
            names.join(", ")
        };
        let _ = writeln!(
            table,
            "    {}({package}::{name}) = {package:?}, {name:?}{} {{\n        ros2: {:?}, {:?}, [{}];",
            variant(&definition.name),
            if has_header(definition) { " header" } else { "" },
            rihs01(self.ros2, definition)?,
            definition_text(definition, false),
            names(&self.ros2.dependencies(definition)?),
        );
        if let Some(form) = self.ros1_form(definition)? {
            let kind = if self.differs(definition, form)? {
                format!("own(ros1::{}::{})", form.name.package, form.name.name)
            } else {
                "same()".to_owned()
            };
            let mut used = self.ros1.dependencies(form)?;
            // Time and duration are primitives in ROS 1.
            used.retain(|used| self.names.get(&used.name) != Some(&None));
            let _ = writeln!(
                table,
                "        ros1: {kind} {:?}, {:?}, {:?}, [{}];",
                form.name.to_string(),
                md5sum(self.ros1, form)?,
                definition_text(form, true),
                names(&used),
            );
        }
        table.push_str("    }\n");
        Ok(())
    }
}

/// Returns whether a message begins with a header.
fn has_header(definition: &Definition) -> bool {
    let base = definition.fields.first().map(|field| &field.field_type.base);
    base == Some(&BaseType::Message(TypeName::new("std_msgs", "Header")))
}

fn rust_name(name: &str) -> String {
    if matches!(name, "type" | "move" | "ref" | "loop" | "match" | "use" | "in") {
        return format!("r#{name}");
    }
    name.to_owned()
}

fn literal(primitive: Primitive, value: &str) -> String {
    match primitive {
        Primitive::String => format!("{value:?}"),
        Primitive::Float32 | Primitive::Float64 if !value.contains(['.', 'e', 'n', 'i']) => {
            format!("{value}.0")
        }
        Primitive::Bool => matches!(value, "true" | "True" | "1").to_string(),
        _ => value.to_owned(),
    }
}
