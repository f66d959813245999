//! `#[derive(Targets)]`.

use proc_macro2::TokenStream;
use quote::quote;
use syn::{DeriveInput, Result};

use crate::doc::{doc_of, named_fields};

pub fn expand(input: &DeriveInput) -> Result<TokenStream> {
    let name = &input.ident;
    let (mut outputs, mut visits, mut headers) = (Vec::new(), Vec::new(), Vec::new());
    for field in named_fields(input)? {
        let (ident, kind, doc) = (&field.ident, &field.ty, doc_of(field)?);
        outputs.push(quote! {
            ::opendr_engine::learner::Output {
                name: ::core::stringify!(#ident),
                doc: #doc,
                value_type: <#kind as ::opendr_engine::Datum>::TYPE,
            }
        });
        visits.push(
            quote!(visit(::core::stringify!(#ident), ::opendr_engine::Datum::as_value_ref(&self.#ident));),
        );
        headers.push(quote!(::opendr_engine::Datum::header_mut(&mut self.#ident).clone_from(header);));
    }
    Ok(quote! {
        #[automatically_derived]
        impl ::opendr_engine::learner::Targets for #name {
            const OUTPUTS: &'static [::opendr_engine::learner::Output] = &[#(#outputs),*];

            fn visit<'a>(&'a self, visit: &mut dyn FnMut(&'static str, ::opendr_engine::ValueRef<'a>)) {
                #(#visits)*
            }

            fn set_header(&mut self, header: &::opendr_engine::Header) {
                #(#headers)*
            }
        }
    })
}
