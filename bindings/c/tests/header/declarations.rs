//! Declarations of the exported functions and types, which cbindgen reads from the sources.

use std::path::Path;

use cbindgen::{Builder, Config, DocumentationLength, DocumentationStyle, Language, Style};
use opendr::ValueType;

use crate::value_functions::c_name;

/// Names from before 0.1. Programs that use them compile until 1.0.
const FORMER_NAMES: [(&str, &str); 3] = [
    ("opendr_fit_in", "opendr_fit_policy"),
    ("opendr_network_of", "opendr_learner_network"),
    ("opendr_samples", "opendr_sample_type"),
];

const RULES: &str = "\
/*
 * OpenDR in Rust: the C API. Generated from the library; docs/c.md explains it.
 *
 * Rules:
 *   - A function with the result opendr_status returns OPENDR_OK (0) or the kind of the error; opendr_last_error() returns its
 *     message.
 *   - A function writes a new handle to an opendr_X **, or NULL if the call fails. Free it with opendr_X_free(), which takes
 *     the address of the variable and sets it to NULL; freeing NULL does nothing.
 *   - Pointers that a function returns (texts, numbers, pixels) belong to the handle and are valid as long as the handle.
 *   - Arguments are copied, or only read during the call; the caller keeps them.
 *   - Texts are UTF-8. Paths are the bytes of the system's file names.
 *   - Learners, networks and sources can be used by several threads at once; values as long as no thread changes or frees them.
 *   - NULL, handles of another type and impossible lengths are errors. The caller guarantees that a pointer points to as much
 *     memory as its length states, and that a handle is not used after it was freed.
 */
";

/// Returns all declarations of the sources.
pub fn render(sources: &Path) -> String {
    let handles: Vec<_> = ValueType::ALL.iter().map(|kind| c_name(*kind)).collect();
    let typedefs = handles.iter().map(|name| format!("typedef struct {name} {name};"));
    let after_includes = format!(
        "\n/* Handles of data and targets, one type each. */\n{}",
        typedefs.collect::<Vec<_>>().join("\n")
    );
    let mut config = Config {
        language: Language::C,
        style: Style::Both,
        cpp_compat: true,
        usize_is_size_t: true,
        no_includes: true,
        sys_includes: ["stdbool.h", "stddef.h", "stdint.h"].map(str::to_owned).to_vec(),
        after_includes: Some(after_includes),
        documentation_style: DocumentationStyle::C99,
        documentation_length: DocumentationLength::Full,
        line_length: 120,
        tab_width: 4,
        ..Config::default()
    };
    config.export.include = ["opendr_sample_type", "opendr_pixel_format", "opendr_layout", "opendr_skeleton"]
        .map(str::to_owned)
        .to_vec();
    // cbindgen follows the modules itself; a source given twice would be declared twice.
    let builder = Builder::new().with_config(config).with_src(sources.join("lib.rs"));
    let mut header = Vec::new();
    builder.generate().unwrap().write(&mut header);
    let former = FORMER_NAMES.map(|(former, name)| format!("#define {former} {name}\n")).concat();
    format!(
        "{RULES}{}\n/* Names from before 0.1, deprecated; they compile until 1.0. */\n{former}",
        String::from_utf8(header).unwrap()
    )
}
