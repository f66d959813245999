//! Derive macros of OpenDR learners: parameters, inputs and outputs.
//!
//! * `#[derive(Params)]` makes a struct a set of parameters, with a table of fields, defaults and access by name.
//! * `#[derive(Inputs)]` makes a struct of references the input of a learner, with named ports.
//! * `#[derive(Targets)]` makes a struct of targets the output of a learner, with named outputs.
//!
//! The macros generate static tables and thin code only. The traits, the types in the tables and all behaviour are in
//! `opendr-engine`, which re-exports the macros as `opendr_engine::params::Params`, `opendr_engine::learner::Inputs` and
//! `opendr_engine::learner::Targets`. Learners import them from there; the examples of these traits run as tests.

mod doc;
mod inputs;

mod params;
mod targets;

use proc_macro::TokenStream;
use syn::{DeriveInput, parse_macro_input};

/// Implements `Params` for a struct of parameters: table of fields, defaults, access by name.
///
/// Attribute of a field: `#[param(default = EXPR, range = LOW..=HIGH, unit = "px", log, live, alias = "name_of_opendr", former = "old_name")]`.
/// Without a default, that of the field's type is used. `#[param(flatten, name = EXPR)]` includes the fields of another
/// struct of parameters, with other defaults. The doc comment of a field is required; it is the documentation on every
/// surface.
#[proc_macro_derive(Params, attributes(param))]
pub fn params(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    params::expand(&input).unwrap_or_else(syn::Error::into_compile_error).into()
}

/// Implements `Inputs` for a struct of references, the input of a learner with a named port per field.
///
/// Fields are `&'a T` or `Option<&'a T>`, where `T` is a data or target type. `#[port(init)]` marks an `Option` that is
/// passed once per stream. The targets get the time stamp of the first field.
#[proc_macro_derive(Inputs, attributes(port))]
pub fn inputs(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    inputs::expand(&input).unwrap_or_else(syn::Error::into_compile_error).into()
}

/// Implements `Targets` for a struct of targets, the output of a learner with a named output per field.
#[proc_macro_derive(Targets)]
pub fn targets(input: TokenStream) -> TokenStream {
    let input = parse_macro_input!(input as DeriveInput);
    targets::expand(&input).unwrap_or_else(syn::Error::into_compile_error).into()
}
