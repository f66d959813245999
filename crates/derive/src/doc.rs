//! Doc comments and named fields.

use syn::punctuated::Punctuated;
use syn::{Attribute, Data, DeriveInput, Error, Expr, ExprLit, Field, Fields, Lit, Meta, Result, Token};

/// Returns the text of a field's doc comment; a field without one is an error.
pub fn doc_of(field: &Field) -> Result<String> {
    let lines: Vec<String> = field.attrs.iter().filter_map(doc_line).collect();
    let text = lines.iter().map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n");
    match text.trim() {
        "" => Err(Error::new_spanned(field, "missing doc comment; it is the documentation on every surface")),
        text => Ok(text.to_owned()),
    }
}

fn doc_line(attribute: &Attribute) -> Option<String> {
    let Meta::NameValue(pair) = &attribute.meta else { return None };
    let Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) = &pair.value else { return None };
    pair.path.is_ident("doc").then(|| text.value())
}

/// Returns the fields of a struct with named fields.
pub fn named_fields(input: &DeriveInput) -> Result<&Punctuated<Field, Token![,]>> {
    match &input.data {
        Data::Struct(data) => match &data.fields {
            Fields::Named(fields) => Ok(&fields.named),
            _ => Err(Error::new_spanned(input, "expected a struct with named fields")),
        },
        _ => Err(Error::new_spanned(input, "expected a struct")),
    }
}
