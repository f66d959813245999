//! Parsing of untrusted XML-RPC.

use std::collections::BTreeMap;

use opendr_engine::{Error, Result};
use roxmltree::{Document, Node, ParsingOptions};

use super::base64::bytes_from_base64;
use super::{MOST_NESTED, ParameterValue};

/// Maximum number of XML nodes of one call, far more than in any real one.
const MOST_NODES: u32 = 1 << 20;

/// A received call.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct MethodCall {
    pub method: String,
    pub params: Vec<ParameterValue>,
}

/// Fault response of a peer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Fault {
    pub code: i32,
    pub text: String,
}

/// Parses the call in `body`.
///
/// # Errors
/// `Format` for anything but an XML-RPC call in UTF-8.
pub(crate) fn call_from_xml(body: &[u8]) -> Result<MethodCall> {
    with_root(body, "methodCall", |root| {
        let method = text(child(root, "methodName")?).trim().to_owned();
        let params = match elements(root).find(|node| node.has_tag_name("params")) {
            Some(params) => {
                let each = elements(params).filter(|node| node.has_tag_name("param"));
                each.map(|param| value(child(param, "value")?, 0)).collect::<Result<_>>()?
            }
            None => Vec::new(),
        };
        Ok(MethodCall { method, params })
    })
}

/// Parses the response in `body`, which is a value or a fault.
///
/// # Errors
/// `Format` for anything but an XML-RPC response in UTF-8.
pub(crate) fn response_from_xml(body: &[u8]) -> Result<Result<ParameterValue, Fault>> {
    with_root(body, "methodResponse", |root| {
        let Some(fault) = elements(root).find(|node| node.has_tag_name("fault")) else {
            let param = child(child(root, "params")?, "param")?;
            return value(child(param, "value")?, 0).map(Ok);
        };
        let fault_value = value(child(fault, "value")?, 0)?;
        let member = |name| fault_value.as_struct().and_then(|members| members.get(name));
        let code = member("faultCode").and_then(ParameterValue::as_int).unwrap_or(-1);
        let text = member("faultString").and_then(ParameterValue::as_str).unwrap_or("no reason given");
        Ok(Err(Fault { code, text: text.to_owned() }))
    })
}

fn with_root<T>(body: &[u8], root: &str, read: impl FnOnce(Node<'_, '_>) -> Result<T>) -> Result<T> {
    let text = str::from_utf8(body).map_err(|error| {
        Error::format(format!("the XML-RPC message is not UTF-8 after {} bytes", error.valid_up_to()))
    })?;
    let options = ParsingOptions { allow_dtd: false, nodes_limit: MOST_NODES, ..ParsingOptions::default() };
    let document = Document::parse_with_options(text.trim_start(), options)
        .map_err(|error| Error::format(format!("invalid XML: {error}")))?;
    let found = document.root_element();
    if !found.has_tag_name(root) {
        return Err(Error::format(format!("found <{:.40}> instead of <{root}>", found.tag_name().name())));
    }
    read(found)
}

fn value(node: Node<'_, '_>, depth: usize) -> Result<ParameterValue> {
    if depth > MOST_NESTED {
        return Err(Error::format(format!("values nested more than {MOST_NESTED} deep")));
    }
    let Some(typed) = elements(node).next() else { return Ok(ParameterValue::String(text(node))) };
    let text = || text(typed);
    let wrong = |what: &str| Error::format(format!("{:.40?} is not a {what} of XML-RPC", text()));
    Ok(match typed.tag_name().name() {
        "string" => ParameterValue::String(text()),
        // Python may write i8; values that fit 32 bits are accepted.
        "int" | "i4" | "i8" | "i2" | "i1" => {
            ParameterValue::Int(text().trim().parse().map_err(|_| wrong("32-bit integer"))?)
        }
        "boolean" => match text().trim() {
            "1" | "true" => ParameterValue::Bool(true),
            "0" | "false" => ParameterValue::Bool(false),
            _ => return Err(wrong("Boolean")),
        },
        "double" => ParameterValue::Double(text().trim().parse().map_err(|_| wrong("number"))?),
        "dateTime.iso8601" => ParameterValue::DateTime(text().trim().to_owned()),
        "base64" => ParameterValue::Base64(bytes_from_base64(&text()).ok_or_else(|| wrong("base64"))?),
        "array" => {
            let values = elements(child(typed, "data")?).filter(|node| node.has_tag_name("value"));
            ParameterValue::List(values.map(|node| value(node, depth + 1)).collect::<Result<_>>()?)
        }
        "struct" => {
            let mut members = BTreeMap::new();
            for member in elements(typed).filter(|node| node.has_tag_name("member")) {
                let name = self::text(child(member, "name")?);
                members.insert(name, value(child(member, "value")?, depth + 1)?);
            }
            ParameterValue::Struct(members)
        }
        other => return Err(Error::format(format!("XML-RPC has no type <{other:.40}>"))),
    })
}

fn elements<'a>(node: Node<'a, 'a>) -> impl Iterator<Item = Node<'a, 'a>> {
    node.children().filter(Node::is_element)
}

fn child<'a>(node: Node<'a, 'a>, tag: &str) -> Result<Node<'a, 'a>> {
    elements(node).find(|child| child.has_tag_name(tag)).ok_or_else(|| {
        Error::format(format!("<{:.40}> has no <{tag}>, which XML-RPC requires", node.tag_name().name()))
    })
}

/// Returns the text of a node, with comments removed.
fn text(node: Node<'_, '_>) -> String {
    node.children().filter(Node::is_text).filter_map(|part| part.text()).collect()
}
