//! `#[derive(Params)]`, `#[derive(Inputs)]` and `#[derive(Targets)]`: static tables and thin glue, no behaviour.

mod doc;
mod inputs;

mod params;
mod targets;

use proc_macro::TokenStream;
use syn::{DeriveInput, parse_macro_input};

/// Makes a struct a set of parameters: table of fields, defaults, access by name.
///
/// Attribute of a field: `#[param(default = EXPR, range = LOW..=HIGH, unit = "px", log, live, alias = "old_name")]`.
/// Without a default the field's type's is taken. The doc comment is the documentation on every surface and must be
/// there.
#[proc_macro_derive(Params, attributes(param))]
pub fn params(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    params::expand(&input).unwrap_or_else(syn::Error::into_compile_error).into()
}

/// Makes a struct of references the input of a learner, one named port a field.
///
/// Fields are `&'a T` or `Option<&'a T>` with `T` a data or target type; `#[port(init)]` marks one that is given once
/// per stream (it must be an `Option`). The first field is the one whose time stamp the targets carry.
#[proc_macro_derive(Inputs, attributes(port))]
pub fn inputs(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    inputs::expand(&input).unwrap_or_else(syn::Error::into_compile_error).into()
}

/// Makes a struct of targets the output of a learner, one named output a field.
#[proc_macro_derive(Targets)]
pub fn targets(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    targets::expand(&input).unwrap_or_else(syn::Error::into_compile_error).into()
}
