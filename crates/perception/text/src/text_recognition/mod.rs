//! Recognition of text.

mod pp_ocr;

pub use pp_ocr::{PpOcr, PpOcrParams};
