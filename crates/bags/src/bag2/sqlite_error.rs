//! Errors of SQLite.

use opendr_engine::Error;
use rusqlite::ErrorCode::{CannotOpen, DatabaseBusy, DatabaseLocked, DiskFull, ReadOnly, SystemIoFailure};

/// Converts an error of SQLite: a damaged file or one that is not a database is an error of format, the rest of the system.
pub(super) fn sqlite_error(error: rusqlite::Error) -> Error {
    match error.sqlite_error_code() {
        Some(ReadOnly) => Error::io(
            "the recording was interrupted while it was written: open it once with `sqlite3 FILE .tables` to repair it",
        ),
        Some(CannotOpen | DatabaseBusy | DatabaseLocked | DiskFull | SystemIoFailure) => {
            Error::io("SQLite failed").with_source(error)
        }
        _ => Error::format("SQLite cannot read the recording").with_source(error),
    }
}
