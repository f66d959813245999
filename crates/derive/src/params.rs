//! `#[derive(Params)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Expr, ExprRange, Field, LitStr, Result};

use crate::doc::{doc_of, named_fields};

#[derive(Default)]
struct Attributes {
    default: Option<Expr>,
    range: Option<ExprRange>,
    unit: Option<LitStr>,
    log: bool,
    live: bool,
    aliases: Vec<LitStr>,
}

fn attributes_of(field: &Field) -> Result<Attributes> {
    let mut found = Attributes::default();
    for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("param")) {
        attribute.parse_nested_meta(|meta| {
            if meta.path.is_ident("default") {
                found.default = Some(meta.value()?.parse()?);
            } else if meta.path.is_ident("range") {
                found.range = Some(meta.value()?.parse()?);
            } else if meta.path.is_ident("unit") {
                found.unit = Some(meta.value()?.parse()?);
            } else if meta.path.is_ident("log") {
                found.log = true;
            } else if meta.path.is_ident("live") {
                found.live = true;
            } else if meta.path.is_ident("alias") {
                found.aliases.push(meta.value()?.parse()?);
            } else {
                return Err(meta.error("default, range, unit, log, live or alias is wanted"));
            }
            Ok(())
        })?;
    }
    Ok(found)
}

pub fn expand(input: &DeriveInput) -> Result<TokenStream> {
    let name = &input.ident;
    let (mut rows, mut defaults, mut gets, mut sets) = (Vec::new(), Vec::new(), Vec::new(), Vec::new());
    for (index, field) in named_fields(input)?.iter().enumerate() {
        let (ident, kind, doc) = (&field.ident, &field.ty, doc_of(field)?);
        let Attributes { default, range, unit, log, live, aliases } = attributes_of(field)?;
        let default = match default {
            Some(Expr::Lit(literal)) if matches!(literal.lit, syn::Lit::Str(_)) => {
                quote!(::core::convert::From::from(#literal))
            }
            Some(default) => quote!(#default),
            None => quote!(::core::default::Default::default()),
        };
        let range = match range {
            Some(ExprRange { start: Some(low), end: Some(high), .. }) => quote! {
                ::core::option::Option::Some(::opendr_engine::params::ParamRange { low: #low as f64, high: #high as f64 })
            },
            Some(range) => return Err(syn::Error::new_spanned(range, "LOW..=HIGH is wanted")),
            None => quote!(::core::option::Option::None),
        };
        let unit = unit.map_or_else(String::new, |unit| unit.value());
        let param = quote!(<#kind as ::opendr_engine::params::Param>);
        rows.push(quote! {
            ::opendr_engine::params::Field {
                name: ::core::stringify!(#ident),
                doc: #doc,
                kind: #param::KIND,
                optional: #param::OPTIONAL,
                choices: #param::CHOICES,
                range: #range,
                unit: #unit,
                log_scale: #log,
                live: #live,
                aliases: &[#(#aliases),*],
                default: ::opendr_engine::params::FieldDefault::Made(|| {
                    let default: #kind = #default;
                    #param::to_value(&default)
                }),
            }
        });
        defaults.push(quote!(#ident: #default));
        gets.push(quote!(#index => #param::to_value(&self.#ident)));
        sets.push(quote!(#index => match #param::from_value(value) {
            ::core::option::Option::Some(value) => { self.#ident = value; true }
            ::core::option::Option::None => false,
        }));
    }
    Ok(quote! {
        #[automatically_derived]
        impl ::core::default::Default for #name {
            fn default() -> Self { Self { #(#defaults),* } }
        }

        #[automatically_derived]
        impl ::opendr_engine::params::Params for #name {
            const FIELDS: &'static [::opendr_engine::params::Field] = &[#(#rows),*];

            fn get_at(&self, index: usize) -> ::opendr_engine::params::ParamValue {
                match index { #(#gets,)* _ => ::opendr_engine::params::ParamValue::None }
            }

            fn set_at(&mut self, index: usize, value: &::opendr_engine::params::ParamValue) -> bool {
                match index { #(#sets,)* _ => false }
            }
        }
    })
}
