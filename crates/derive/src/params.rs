//! `#[derive(Params)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Expr, ExprRange, Field, Ident, LitStr, Result};

use crate::doc::{doc_of, named_fields};

#[derive(Default)]
struct Attributes {
    default: Option<Expr>,
    range: Option<ExprRange>,
    unit: Option<LitStr>,
    log: bool,
    live: bool,
    aliases: Vec<LitStr>,
    former: Vec<LitStr>,
    flatten: bool,
    defaults: Vec<(Ident, Expr)>,
}

fn attributes_of(field: &Field) -> Result<Attributes> {
    let mut attributes = Attributes::default();
    for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("param")) {
        attribute.parse_nested_meta(|meta| {
            if meta.path.is_ident("default") {
                attributes.default = Some(meta.value()?.parse()?);
            } else if meta.path.is_ident("range") {
                attributes.range = Some(meta.value()?.parse()?);
            } else if meta.path.is_ident("unit") {
                attributes.unit = Some(meta.value()?.parse()?);
            } else if meta.path.is_ident("log") {
                attributes.log = true;
            } else if meta.path.is_ident("live") {
                attributes.live = true;
            } else if meta.path.is_ident("alias") {
                attributes.aliases.push(meta.value()?.parse()?);
            } else if meta.path.is_ident("former") {
                attributes.former.push(meta.value()?.parse()?);
            } else if meta.path.is_ident("flatten") {
                attributes.flatten = true;
            } else if let (true, Some(name)) = (attributes.flatten, meta.path.get_ident()) {
                attributes.defaults.push((name.clone(), meta.value()?.parse()?));
            } else {
                return Err(meta.error("expected default, range, unit, log, live, alias, former or flatten"));
            }
            Ok(())
        })?;
    }
    Ok(attributes)
}

/// Parts of the generated code, for a sequence of fields.
#[derive(Default)]
struct Parts {
    /// Tables, each an expression of type `&[Field]`.
    tables: Vec<TokenStream>,
    /// Initialisers `field: default`.
    defaults: Vec<TokenStream>,
    /// Defaults of this struct for fields of an inner struct.
    changes: Vec<((Option<Ident>, Ident), TokenStream)>,
    gets: Vec<TokenStream>,
    sets: Vec<TokenStream>,
}

impl Parts {
    fn add(&mut self, field: &Field) -> Result<()> {
        let attributes = attributes_of(field)?;
        match attributes.flatten {
            true => self.add_struct(field, &attributes.defaults),
            false => self.add_field(field, attributes),
        }
    }

    /// Adds a struct of parameters, whose fields are flattened into the outer one.
    fn add_struct(&mut self, field: &Field, defaults: &[(Ident, Expr)]) -> Result<()> {
        let (ident, kind) = (&field.ident, &field.ty);
        let inner = quote!(<#kind as ::opendr_engine::params::Params>);
        self.tables.push(quote!(#inner::FIELDS));
        self.defaults.push(quote!(#ident: <#kind as ::core::default::Default>::default()));
        for (name, default) in defaults {
            self.changes.push(((ident.clone(), name.clone()), converted(default)));
        }
        self.gets.push(quote! {
            if index < #inner::FIELDS.len() { return #inner::get_at(&self.#ident, index); }
            let index = index - #inner::FIELDS.len();
        });
        self.sets.push(quote! {
            if index < #inner::FIELDS.len() { return #inner::set_at(&mut self.#ident, index, value); }
            let index = index - #inner::FIELDS.len();
        });
        Ok(())
    }

    fn add_field(&mut self, field: &Field, attributes: Attributes) -> Result<()> {
        let (ident, kind, doc) = (&field.ident, &field.ty, doc_of(field)?);
        let Attributes { default, range, unit, log, live, aliases, former, .. } = attributes;
        let default = match &default {
            Some(default) => converted(default),
            None => quote!(::core::default::Default::default()),
        };
        let range = match range {
            Some(ExprRange { start: Some(low), end: Some(high), .. }) => quote! {
                ::core::option::Option::Some(::opendr_engine::params::ParamRange { low: #low as f64, high: #high as f64 })
            },
            Some(range) => return Err(syn::Error::new_spanned(range, "expected LOW..=HIGH")),
            None => quote!(::core::option::Option::None),
        };
        let unit = unit.map_or_else(String::new, |unit| unit.value());
        let param = quote!(<#kind as ::opendr_engine::params::Param>);
        self.tables.push(quote! {
            &[::opendr_engine::params::Field {
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
                former: &[#(#former),*],
                default: ::opendr_engine::params::FieldDefault::Function(|| {
                    let default: #kind = #default;
                    #param::to_value(&default)
                }),
            }]
        });
        self.defaults.push(quote!(#ident: #default));
        self.gets.push(quote! {
            if index == 0 { return #param::to_value(&self.#ident); }
            let index = index - 1;
        });
        self.sets.push(quote! {
            if index == 0 {
                return match #param::from_value(value) {
                    ::core::option::Option::Some(value) => { self.#ident = value; true }
                    ::core::option::Option::None => false,
                };
            }
            let index = index - 1;
        });
        Ok(())
    }
}
/// Returns a default expression; text is converted to the type of the field.
fn converted(default: &Expr) -> TokenStream {
    match default {
        Expr::Lit(literal) if matches!(literal.lit, syn::Lit::Str(_)) => {
            quote!(::core::convert::From::from(#literal))
        }
        default => quote!(#default),
    }
}

pub fn expand(input: &DeriveInput) -> Result<TokenStream> {
    let name = &input.ident;
    let mut parts = Parts::default();
    named_fields(input)?.iter().try_for_each(|field| parts.add(field))?;
    let Parts { tables, defaults, changes, gets, sets } = parts;
    let changed = changes.iter().map(|((outer, field), _)| {
        quote! {
            (::core::stringify!(#field), ::opendr_engine::params::FieldDefault::Function(|| {
                ::opendr_engine::params::Param::to_value(&<#name as ::core::default::Default>::default().#outer.#field)
            }))
        }
    });
    let assigned = changes.iter().map(|((outer, field), value)| quote!(default.#outer.#field = #value;));
    let default = match changes.is_empty() {
        true => quote!(Self { #(#defaults),* }),
        false => quote!({
            let mut default = Self { #(#defaults),* };
            #(#assigned)*
            default
        }),
    };
    Ok(quote! {
        #[automatically_derived]
        impl ::core::default::Default for #name {
            fn default() -> Self { #default }
        }

        #[automatically_derived]
        impl ::opendr_engine::params::Params for #name {
            const FIELDS: &'static [::opendr_engine::params::Field] = {
                const TABLES: &[&[::opendr_engine::params::Field]] = &[#(#tables),*];
                const TABLE: [::opendr_engine::params::Field; ::opendr_engine::params::count(TABLES)] =
                    ::opendr_engine::params::joined(TABLES, &[#(#changed),*]);
                &TABLE
            };

            #[allow(unused_variables)]
            fn get_at(&self, index: usize) -> ::opendr_engine::params::ParamValue {
                #(#gets)*
                ::opendr_engine::params::ParamValue::None
            }

            #[allow(unused_variables)]
            fn set_at(&mut self, index: usize, value: &::opendr_engine::params::ParamValue) -> bool {
                #(#sets)*
                false
            }
        }
    })
}
