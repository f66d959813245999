//! Concatenation of tables of fields, at compile time.

use crate::params::{Field, FieldDefault, ParamKind, ParamValue};

const NO_FIELD: Field = Field {
    name: "",
    doc: "",
    kind: ParamKind::Bool,
    optional: true,
    choices: &[],
    range: None,
    unit: "",
    log_scale: false,
    live: false,
    aliases: &[],
    former: &[],
    default: FieldDefault::Value(&ParamValue::None),
};

/// Returns the number of fields in all tables.
pub const fn count(tables: &[&[Field]]) -> usize {
    let (mut count, mut table) = (0, 0);
    while table < tables.len() {
        count += tables[table].len();
        table += 1;
    }
    count
}

/// Concatenates the fields of all tables; `defaults` replaces the defaults of the fields that it names.
pub const fn joined<const N: usize>(
    tables: &[&[Field]],
    defaults: &[(&'static str, FieldDefault)],
) -> [Field; N] {
    let mut fields = [NO_FIELD; N];
    let (mut at, mut table) = (0, 0);
    while table < tables.len() {
        let mut row = 0;
        while row < tables[table].len() {
            fields[at] = tables[table][row];
            let mut override_index = 0;
            while override_index < defaults.len() {
                if same(fields[at].name, defaults[override_index].0) {
                    fields[at].default = defaults[override_index].1;
                }
                override_index += 1;
            }
            at += 1;
            row += 1;
        }
        table += 1;
    }
    fields
}

const fn same(a: &str, b: &str) -> bool {
    let (a, b) = (a.as_bytes(), b.as_bytes());
    let mut at = 0;
    while at < a.len() && at < b.len() && a[at] == b[at] {
        at += 1;
    }
    at == a.len() && at == b.len()
}
