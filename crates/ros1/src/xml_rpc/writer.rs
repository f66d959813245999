//! Writing of XML-RPC.

use std::fmt::Write;

use opendr_engine::{Error, Result};

use super::base64::base64_from_bytes;
use super::{MOST_NESTED, ParameterValue};

/// Returns the body of a call.
///
/// # Errors
/// `InvalidInput` for text that XML cannot hold (control characters), or lists nested too deeply.
pub(crate) fn xml_from_call(method: &str, params: &[ParameterValue]) -> Result<String> {
    let mut xml = "<?xml version=\"1.0\"?>\n<methodCall><methodName>".to_owned();
    write_text(&mut xml, method)?;
    xml.push_str("</methodName><params>");
    for value in params {
        xml.push_str("<param>");
        write_value(&mut xml, value, 0)?;
        xml.push_str("</param>");
    }
    xml.push_str("</params></methodCall>\n");
    Ok(xml)
}

/// Returns the body of a response. Errors as [`xml_from_call`].
pub(crate) fn xml_from_response(value: &ParameterValue) -> Result<String> {
    let mut xml = "<?xml version=\"1.0\"?>\n<methodResponse><params><param>".to_owned();
    write_value(&mut xml, value, 0)?;
    xml.push_str("</param></params></methodResponse>\n");
    Ok(xml)
}

/// Returns the body of a fault response.
pub(crate) fn xml_from_fault(code: i32, text: &str) -> String {
    let text: String = text.chars().filter(|letter| allowed(*letter)).collect();
    let fault = [("faultCode".to_owned(), code.into()), ("faultString".to_owned(), text.into())];
    let mut xml = "<?xml version=\"1.0\"?>\n<methodResponse><fault>".to_owned();
    // Cannot fail, since characters that XML does not allow were removed.
    write_value(&mut xml, &ParameterValue::Struct(fault.into()), 0).ok();
    xml.push_str("</fault></methodResponse>\n");
    xml
}

fn write_value(xml: &mut String, value: &ParameterValue, depth: usize) -> Result<()> {
    if depth > MOST_NESTED {
        return Err(Error::invalid_input(format!(
            "the value is nested more than {MOST_NESTED} deep; flatten it"
        )));
    }
    xml.push_str("<value>");
    // Writing to a String cannot fail.
    match value {
        ParameterValue::Bool(value) => drop(write!(xml, "<boolean>{}</boolean>", u8::from(*value))),
        ParameterValue::Int(value) => drop(write!(xml, "<int>{value}</int>")),
        ParameterValue::Double(value) => drop(write!(xml, "<double>{value:?}</double>")),
        ParameterValue::String(text) => tagged(xml, "string", text)?,
        ParameterValue::DateTime(text) => tagged(xml, "dateTime.iso8601", text)?,
        ParameterValue::Base64(bytes) => tagged(xml, "base64", &base64_from_bytes(bytes))?,
        ParameterValue::List(values) => {
            xml.push_str("<array><data>");
            values.iter().try_for_each(|value| write_value(xml, value, depth + 1))?;
            xml.push_str("</data></array>");
        }
        ParameterValue::Struct(members) => {
            xml.push_str("<struct>");
            for (name, value) in members {
                xml.push_str("<member>");
                tagged(xml, "name", name)?;
                write_value(xml, value, depth + 1)?;
                xml.push_str("</member>");
            }
            xml.push_str("</struct>");
        }
    }
    xml.push_str("</value>");
    Ok(())
}

fn tagged(xml: &mut String, tag: &str, text: &str) -> Result<()> {
    xml.extend(["<", tag, ">"]);
    write_text(xml, text)?;
    xml.extend(["</", tag, ">"]);
    Ok(())
}

fn write_text(xml: &mut String, text: &str) -> Result<()> {
    for letter in text.chars() {
        match letter {
            '&' => xml.push_str("&amp;"),
            '<' => xml.push_str("&lt;"),
            '>' => xml.push_str("&gt;"),
            // XML readers convert a bare carriage return into a line feed.
            '\r' => xml.push_str("&#13;"),
            _ if allowed(letter) => xml.push(letter),
            _ => {
                return Err(Error::invalid_input(format!(
                    "the text contains {letter:?}, which XML cannot hold; send it as Base64"
                )));
            }
        }
    }
    Ok(())
}

/// Returns whether XML 1.0 allows a character.
fn allowed(letter: char) -> bool {
    !matches!(letter, '\0'..='\x08' | '\x0b' | '\x0c' | '\x0e'..='\x1f' | '\u{fffe}' | '\u{ffff}')
}
