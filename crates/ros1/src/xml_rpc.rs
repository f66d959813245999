//! XML-RPC: values, calls and responses. Source: <http://xmlrpc.com/spec.md>.

mod base64;
mod reader;
mod value;
mod writer;

pub(crate) use reader::{Fault, call_from_xml, response_from_xml};
pub use value::ParameterValue;
pub(crate) use writer::{xml_from_call, xml_from_fault, xml_from_response};

/// Maximum nesting of lists and structs, far more than in any parameter.
const MOST_NESTED: usize = 64;

#[cfg(test)]
mod tests;
