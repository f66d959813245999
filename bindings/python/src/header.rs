//! Headers of Python data and targets.

use opendr::Header;
use pyo3::prelude::*;

/// Reads the time stamp and the frame id of a Python datum or target.
pub fn header_from_python(object: &Bound<'_, PyAny>) -> PyResult<Header> {
    let stamp_ns = object.getattr("timestamp")?.extract()?;
    let frame_id: Option<String> = object.getattr("frame_id")?.extract()?;
    Ok(Header { stamp_ns, frame_id: frame_id.filter(|id| !id.is_empty()).map(Into::into) })
}
