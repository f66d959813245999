//! The error type of OpenDR.
//!
//! There is one type, because finer ones compose badly across crates. Its [`ErrorKind`] is what callers act on; it has
//! the same names and numbers on every surface (Python exception, C status, exit code).

use std::error::Error as StdError;
use std::fmt;

/// `Result` with the toolkit's [`Error`].
pub type Result<T, E = Error> = std::result::Result<T, E>;

/// Category of an error, for callers to act on. C's `opendr_status` and the exit codes of the command line are 10 more.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[non_exhaustive]
#[repr(i32)]
pub enum ErrorKind {
    /// A datum, target or file passed in does not fit: wrong shape, empty, NaN, undecodable image.
    InvalidInput = 1,
    /// A parameter is unknown, of the wrong type or out of range.
    InvalidParam = 2,
    /// A file, model, learner, device node or class name does not exist.
    NotFound = 3,
    /// The operating system refused to read or write.
    Io = 4,
    /// A server or package client is unreachable or closed the connection.
    Network = 5,
    /// Bytes differ from their checksum or stated size, or an archive member leaves its folder.
    Integrity = 6,
    /// A file or message does not follow its format.
    Format = 7,
    /// This learner, runtime or build does not support the request.
    Unsupported = 8,
    /// The requested device does not exist or failed.
    Device = 9,
    /// A bug of OpenDR: please report it.
    Internal = 10,
}

impl ErrorKind {
    /// Returns the name, the same on every surface, e.g. `"InvalidInput"`.
    pub const fn name(self) -> &'static str {
        match self {
            Self::InvalidInput => "InvalidInput",
            Self::InvalidParam => "InvalidParam",
            Self::NotFound => "NotFound",
            Self::Io => "Io",
            Self::Network => "Network",
            Self::Integrity => "Integrity",
            Self::Format => "Format",
            Self::Unsupported => "Unsupported",
            Self::Device => "Device",
            Self::Internal => "Internal",
        }
    }
}

impl fmt::Display for ErrorKind {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(self.name())
    }
}

/// An error: a kind, a message (what, the values, what to do), context added by callers, and a source.
///
/// It has the size of a pointer, so that `Result<T>` stays small.
pub struct Error(Box<Inner>);

struct Inner {
    kind: ErrorKind,
    message: String,
    context: Vec<String>,
    source: Option<Box<dyn StdError + Send + Sync>>,
}

macro_rules! constructors {
    ($($(#[$doc:meta])* $name:ident => $kind:ident;)*) => {$(
        $(#[$doc])*
        #[cold]
        pub fn $name(message: impl Into<String>) -> Self { Self::new(ErrorKind::$kind, message) }
    )*};
}

impl Error {
    /// Creates an error of `kind`. The message is lower case, has no full stop, and says what to do.
    #[cold]
    pub fn new(kind: ErrorKind, message: impl Into<String>) -> Self {
        Self(Box::new(Inner { kind, message: message.into(), context: Vec::new(), source: None }))
    }

    constructors! {
        /// Creates an error of kind [`ErrorKind::InvalidInput`].
        invalid_input => InvalidInput;
        /// Creates an error of kind [`ErrorKind::InvalidParam`].
        invalid_param => InvalidParam;
        /// Creates an error of kind [`ErrorKind::NotFound`].
        not_found => NotFound;
        /// Creates an error of kind [`ErrorKind::Io`].
        io => Io;
        /// Creates an error of kind [`ErrorKind::Network`].
        network => Network;
        /// Creates an error of kind [`ErrorKind::Integrity`].
        integrity => Integrity;
        /// Creates an error of kind [`ErrorKind::Format`].
        format => Format;
        /// Creates an error of kind [`ErrorKind::Unsupported`].
        unsupported => Unsupported;
        /// Creates an error of kind [`ErrorKind::Device`].
        device => Device;
        /// Creates an error of kind [`ErrorKind::Internal`].
        internal => Internal;
    }

    /// Returns the kind of the error.
    pub fn kind(&self) -> ErrorKind {
        self.0.kind
    }

    /// Returns the message without context and source.
    pub fn message(&self) -> &str {
        &self.0.message
    }

    /// Adds the operation that failed. The text puts the last one added first: `reading model.json: ...`.
    #[cold]
    #[must_use]
    pub fn context(mut self, what: impl Into<String>) -> Self {
        self.0.context.push(what.into());
        self
    }

    /// Attaches the error that caused this one.
    #[cold]
    #[must_use]
    pub fn with_source(mut self, source: impl Into<Box<dyn StdError + Send + Sync>>) -> Self {
        self.0.source = Some(source.into());
        self
    }
}

impl fmt::Display for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for context in self.0.context.iter().rev() {
            write!(f, "{context}: ")?;
        }
        f.write_str(&self.0.message)?;
        let source = self.0.source.as_ref().map(ToString::to_string).unwrap_or_default();
        // Some libraries end their messages with a line break; some messages quote their source.
        match source.trim_end() {
            source if self.0.message.contains(source) => Ok(()),
            source => write!(f, " ({source})"),
        }
    }
}

impl fmt::Debug for Error {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{}: {self}", self.0.kind)
    }
}

impl StdError for Error {
    fn source(&self) -> Option<&(dyn StdError + 'static)> {
        self.0.source.as_deref().map(|source| source as _)
    }
}

/// Maps a missing file to [`ErrorKind::NotFound`], everything else to [`ErrorKind::Io`].
impl From<std::io::Error> for Error {
    fn from(error: std::io::Error) -> Self {
        let kind = match error.kind() {
            std::io::ErrorKind::NotFound => ErrorKind::NotFound,
            _ => ErrorKind::Io,
        };
        Self::new(kind, error.to_string())
    }
}

/// Extension of `Result` that adds context to an error.
pub trait ResultExt<T> {
    /// Adds the operation that failed; `what` is called only for an error.
    fn context<S: Into<String>>(self, what: impl FnOnce() -> S) -> Result<T>;
}

impl<T, E: Into<Error>> ResultExt<T> for Result<T, E> {
    fn context<S: Into<String>>(self, what: impl FnOnce() -> S) -> Result<T> {
        self.map_err(|error| error.into().context(what()))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn context_added_last_comes_first() {
        let error =
            Error::format("no key \"files\"").context("reading model.json").context("loading nanodet");
        assert_eq!(error.to_string(), "loading nanodet: reading model.json: no key \"files\"");
        assert_eq!(error.kind(), ErrorKind::Format);
        assert_eq!(size_of::<Error>(), size_of::<usize>());
    }

    #[test]
    fn a_source_is_written_once() {
        let of = |source: &str| Error::io("disk full: 3 bytes").with_source(source).to_string();
        assert_eq!(of("errno 28\n"), "disk full: 3 bytes (errno 28)");
        assert_eq!(of("disk full"), "disk full: 3 bytes");
    }

    #[test]
    fn missing_file_is_not_found() {
        let error: Error = std::fs::read("/no/such/file").unwrap_err().into();
        assert_eq!(error.kind(), ErrorKind::NotFound);
    }
}
