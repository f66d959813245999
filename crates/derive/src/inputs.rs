//! `#[derive(Inputs)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Error, Field, GenericArgument, PathArguments, Result, Type};

use crate::doc::{doc_of, named_fields};

/// Returns the `T` of `&'a T` or `Option<&'a T>`, and whether the type is an `Option`.
fn datum_of(kind: &Type) -> Option<(&Type, bool)> {
    match kind {
        Type::Reference(reference) => Some((&reference.elem, false)),
        Type::Path(path) => {
            let last = path.path.segments.last()?;
            let PathArguments::AngleBracketed(arguments) = &last.arguments else { return None };
            match arguments.args.first()? {
                GenericArgument::Type(Type::Reference(reference)) if last.ident == "Option" => {
                    Some((&reference.elem, true))
                }
                _ => None,
            }
        }
        _ => None,
    }
}

fn is_init(field: &Field) -> Result<bool> {
    let mut init = false;
    for attribute in field.attrs.iter().filter(|attribute| attribute.path().is_ident("port")) {
        attribute.parse_nested_meta(|meta| {
            init = meta.path.is_ident("init");
            if init { Ok(()) } else { Err(meta.error("expected init")) }
        })?;
    }
    Ok(init)
}

pub fn expand(input: &DeriveInput) -> Result<TokenStream> {
    let name = &input.ident;
    let Some(lifetime) = input.generics.lifetimes().next().map(|parameter| &parameter.lifetime) else {
        return Err(Error::new_spanned(input, "expected a struct with one lifetime; ports are references"));
    };
    let (mut ports, mut reads, mut header) = (Vec::new(), Vec::new(), None);
    for field in named_fields(input)? {
        let (ident, doc, init) = (&field.ident, doc_of(field)?, is_init(field)?);
        let Some((datum, optional)) = datum_of(&field.ty) else {
            return Err(Error::new_spanned(&field.ty, "expected &'a T or Option<&'a T>"));
        };
        if init && !optional {
            return Err(Error::new_spanned(
                &field.ty,
                "an init port must be an Option; it is passed once per stream",
            ));
        }
        if header.is_none() {
            if optional {
                return Err(Error::new_spanned(
                    &field.ty,
                    "the first port must not be an Option; it has the time stamp",
                ));
            }
            header = Some(quote!(::opendr_engine::Datum::header(self.#ident)));
        }
        ports.push(quote! {
            ::opendr_engine::learner::Port {
                name: ::core::stringify!(#ident),
                doc: #doc,
                value_type: <#datum as ::opendr_engine::Datum>::TYPE,
                optional: #optional,
                init: #init,
            }
        });
        let read = if optional { quote!(optional) } else { quote!(required) };
        reads.push(quote!(#ident: ports.#read(::core::stringify!(#ident))?));
    }
    Ok(quote! {
        #[automatically_derived]
        impl<#lifetime> ::opendr_engine::learner::Inputs<#lifetime> for #name<#lifetime> {
            const PORTS: &'static [::opendr_engine::learner::Port] = &[#(#ports),*];

            fn from_ports(ports: &::opendr_engine::learner::Ports<#lifetime>) -> ::opendr_engine::Result<Self> {
                ::core::result::Result::Ok(Self { #(#reads),* })
            }

            fn header(&self) -> &::opendr_engine::Header { #header }
        }
    })
}
