//! Doc comments and named fields.

use syn::punctuated::Punctuated;
use syn::{Attribute, Data, DeriveInput, Error, Expr, ExprLit, Field, Fields, Lit, Meta, Result, Token};

/// The text of a field's doc comment; a field without one is refused.
pub fn doc_of(field: &Field) -> Result<String> {
    let lines: Vec<String> = field.attrs.iter().filter_map(doc_line).collect();
    let text = lines.iter().map(|line| line.strip_prefix(' ').unwrap_or(line)).collect::<Vec<_>>().join("\n");
    match text.trim() {
        "" => Err(Error::new_spanned(field, "a doc comment is wanted: surfaces show it")),
        text => Ok(text.to_owned()),
    }
}

fn doc_line(attribute: &Attribute) -> Option<String> {
    let Meta::NameValue(pair) = &attribute.meta else { return None };
    let Expr::Lit(ExprLit { lit: Lit::Str(text), .. }) = &pair.value else { return None };
    pair.path.is_ident("doc").then(|| text.value())
}

/// The fields of a struct with names.
pub fn named_fields(input: &DeriveInput) -> Result<&Punctuated<Field, Token![,]>> {
    match &input.data {
        Data::Struct(data) => match &data.fields {
            Fields::Named(fields) => Ok(&fields.named),
            _ => Err(Error::new_spanned(input, "a struct with named fields is wanted")),
        },
        _ => Err(Error::new_spanned(input, "a struct is wanted")),
    }
}
