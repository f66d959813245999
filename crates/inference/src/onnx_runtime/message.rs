//! Messages of ONNX Runtime.

/// Returns the message of ONNX Runtime without its source location.
pub(super) fn message_of<R>(error: &ort::Error<R>) -> String {
    let text = error.message();
    let said = text.split_once("[ONNXRuntimeError] : ").and_then(|(_, text)| text.splitn(3, " : ").nth(2));
    said.unwrap_or(text).trim().to_owned()
}
