//! Functions for single learners, implemented with those for any learner.

use std::fmt::Write;

use opendr::ValueType;
use opendr::learner::{Entry, Port};
use opendr::params::Field;

use crate::value_functions::c_name;

pub const INTRODUCTION: &str = "\
/*
 * Learners. opendr_load_X() is opendr_load() with the learner's name; opendr_infer_X() is opendr_infer() with its inputs
 * and outputs. An output that is not needed may be NULL.
 */
";

/// Keywords of C and C++.
const KEYWORDS: [&str; 8] = ["class", "default", "delete", "new", "operator", "register", "template", "this"];

/// Returns `opendr_load_X` and `opendr_infer_X`.
pub fn of_entry(entry: &Entry) -> String {
    let name = entry.spec.name;
    format!(
        "{}static inline opendr_status opendr_load_{name}(const char *path, const char *device, const char *params_json,\n    \
         opendr_learner **learner) {{\n    return opendr_load(\"{name}\", path, device, params_json, learner);\n}}\n\n{}",
        comment(entry),
        infer(entry)
    )
}

fn comment(entry: &Entry) -> String {
    let mut text = format!("{}: {}\n\nParameters:\n", entry.spec.class, entry.spec.about);
    entry.params.iter().for_each(|field| text += &parameter(field));
    let inputs = entry.ports.iter().map(|port| described(port.name, port.value_type, port.doc, how(port)));
    let outputs =
        entry.outputs.iter().map(|output| described(output.name, output.value_type, output.doc, ""));
    write!(text, "\nInputs:\n{}\nOutputs:\n{}", inputs.collect::<String>(), outputs.collect::<String>())
        .unwrap();
    // A comment within a comment would end it.
    let lines = text.replace("*/", "* /");
    let lines = lines.lines().map(|line| format!(" * {line}").trim_end().to_owned() + "\n");
    format!("/*\n{} */\n", lines.collect::<String>())
}

fn parameter(field: &Field) -> String {
    let mut kind = field.kind.to_string();
    if let Some(range) = field.range {
        write!(kind, " {range}").unwrap();
    }
    if !field.unit.is_empty() {
        write!(kind, " {}", field.unit).unwrap();
    }
    if !field.choices.is_empty() {
        write!(kind, ", one of {}", field.choices.join(", ")).unwrap();
    }
    if field.live {
        kind += ", live";
    }
    let doc = field.doc.split("\n\n").next().unwrap_or_default().replace('\n', " ");
    format!("  {} ({kind}, default {}): {doc}\n", field.name, field.default.value())
}

fn how(port: &Port) -> &'static str {
    match (port.init, port.optional) {
        (true, _) => " Given in the first call of a stream, otherwise NULL.",
        (false, true) => " Optional: may be NULL.",
        (false, false) => "",
    }
}

fn described(name: &str, kind: ValueType, doc: &str, how: &str) -> String {
    let text = format!("  {name} ({}): {}{how}", kind.name(), doc.replace('\n', " "));
    text.trim_end().trim_end_matches(':').to_owned() + "\n"
}

fn infer(entry: &Entry) -> String {
    let mut arguments = vec!["const opendr_learner *learner".to_owned()];
    let (mut fill, mut take) = (String::new(), String::new());
    for (index, port) in entry.ports.iter().enumerate() {
        let argument = argument_name(port.name);
        arguments.push(format!("const {} *{argument}", c_name(port.value_type)));
        fill += &format!("    inputs_[{index}].name = \"{}\";\n", port.name);
        fill += &format!("    inputs_[{index}].value = (const opendr_value *){argument};\n");
    }
    for (index, output) in entry.outputs.iter().enumerate() {
        let (argument, kind) = (argument_name(output.name), c_name(output.value_type));
        arguments.push(format!("{kind} **{argument}"));
        fill += &format!(
            "    outputs_[{index}].name = \"{}\";\n    outputs_[{index}].value = NULL;\n",
            output.name
        );
        take += &format!("    if ({argument} != NULL) *{argument} = ({kind} *)outputs_[{index}].value;\n");
        take += &format!("    else opendr_value_free(&outputs_[{index}].value);\n");
    }
    let (name, inputs, outputs) = (entry.spec.name, entry.ports.len(), entry.outputs.len());
    let arguments = arguments.join(",\n    ");
    format!(
        "static inline opendr_status opendr_infer_{name}({arguments}) {{\n    \
         opendr_input inputs_[{inputs}];\n    opendr_output outputs_[{outputs}];\n    opendr_status status_;\n\
         {fill}    status_ = opendr_infer(learner, inputs_, {inputs}, outputs_, {outputs});\n\
         {take}    return status_;\n}}\n"
    )
}

fn argument_name(name: &str) -> String {
    if KEYWORDS.contains(&name) { format!("{name}_") } else { name.to_owned() }
}
