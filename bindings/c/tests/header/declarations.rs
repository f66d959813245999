//! What the library exports, as cbindgen reads it from the sources.

use std::path::Path;

use cbindgen::{Builder, Config, DocumentationLength, DocumentationStyle, Language, Style};
use opendr::ValueType;

use crate::value_functions::c_name;

const RULES: &str = "\
/*
 * OpenDR in Rust: the C API. Made from the library; docs/c.md explains it.
 *
 * The rules:
 *   - A function that answers opendr_status answers OPENDR_OK (0) or why it failed; opendr_last_error() tells it in words.
 *   - What a function writes to an opendr_X ** is a new handle, NULL when the call fails. Free it with opendr_X_free(),
 *     which takes the address of the variable and makes it NULL; freeing NULL is fine.
 *   - What a function points to (texts, numbers, pixels) belongs to the handle it was asked of, and lives as long as it.
 *   - What is handed in is copied, or only read during the call; it stays the caller's.
 *   - Texts are UTF-8. Paths are bytes as the system has them.
 *   - Learners, networks and sources may be used by several threads at once; values as long as nobody changes or frees them.
 *   - NULL, handles of another type, and lengths that cannot be are refused. That a pointer leads to as much memory as its
 *     length says, and that a handle is not used after it was freed, is the caller's promise.
 */
";

/// The declarations of everything in the sources.
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
    config.export.include = ["opendr_samples", "opendr_pixel_format", "opendr_layout", "opendr_skeleton"]
        .map(str::to_owned)
        .to_vec();
    // It follows the modules itself; what it is given twice it declares twice.
    let builder = Builder::new().with_config(config).with_src(sources.join("lib.rs"));
    let mut header = Vec::new();
    builder.generate().unwrap().write(&mut header);
    format!("{RULES}{}", String::from_utf8(header).unwrap())
}
