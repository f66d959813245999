//! Attributes of nodes.

use opendr_engine::{Error, Result};
use opendr_onnx::proto::NodeProto;

/// Largest size, stride or padding of an attribute.
const MAX_SIZE: i64 = 1 << 24;

/// Reads attributes of a node.
pub(crate) trait Attributes {
    fn float(&self, key: &str, default: f32) -> f32;
    fn text(&self, key: &str, default: &'static str) -> String;
    fn sizes(&self, key: &str, count: usize, default: usize) -> Result<Vec<usize>>;
    fn damaged(&self, what: &str) -> Error;
    fn refused(&self, what: &str) -> Error;
}

impl Attributes for NodeProto {
    fn float(&self, key: &str, default: f32) -> f32 {
        self.find(key).map_or(default, |attribute| attribute.f)
    }

    fn text(&self, key: &str, default: &'static str) -> String {
        let bytes = self.find(key).map_or(default.as_bytes(), |attribute| &attribute.s);
        String::from_utf8_lossy(bytes).into_owned()
    }

    /// Returns a list of sizes, `default` each where it is absent.
    fn sizes(&self, key: &str, count: usize, default: usize) -> Result<Vec<usize>> {
        let Some(values) = self.ints(key).filter(|values| !values.is_empty()) else {
            return Ok(vec![default; count]);
        };
        let sizes: Option<Vec<usize>> =
            values.iter().map(|&value| usize::try_from(value).ok().filter(|_| value <= MAX_SIZE)).collect();
        sizes
            .filter(|sizes| sizes.len() == count)
            .ok_or_else(|| self.damaged(&format!("attribute {key:?} is {values:?}")))
    }

    fn damaged(&self, what: &str) -> Error {
        Error::format(format!("damaged ONNX model: operator {} {:?}: {what}", self.op_type, self.name))
    }

    fn refused(&self, what: &str) -> Error {
        Error::unsupported(format!(
            "the executor does not support operator {} {:?}: {what}",
            self.op_type, self.name
        ))
    }
}
