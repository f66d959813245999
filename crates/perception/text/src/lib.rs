//! Detection and recognition of text in images.
//!
//! [`text_recognition`] has the learner [`PpOcr`](text_recognition::PpOcr), which detects lines of text in an image and reads them.
//! Transcription of speech is in the crate `opendr-speech`. Begin with `PpOcr`.
//!
//! ```no_run
//! use opendr_engine::learner::Handle;
//! use opendr_engine::{Device, Model};
//! use opendr_text::text_recognition::{PpOcr, PpOcrParams};
//!
//! # fn main() -> opendr_engine::Result<()> {
//! let mut reader = Handle::<PpOcr>::new(PpOcrParams::default(), Device::Auto)?;
//! reader.load(Model::open("models/pp_ocr/en")?.path())?;
//! for region in &reader.infer(&opendr_vision::open("sign.jpg")?)?.regions {
//!     println!("{} {:.2}", region.text, region.confidence);
//! }
//! # Ok(())
//! # }
//! ```

pub mod text_recognition;
