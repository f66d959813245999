//! Archiving of the log of an earlier run.

use std::fs;
use std::io;
use std::path::Path;

use opendr_engine::Result;

use crate::atomic_file::write_error;
use crate::event_file::is_event_file;
use crate::file_names::{CURVES, TABLE};

/// Moves the log of an earlier run in `folder` into a subfolder `earlier-1`, `earlier-2`, ..., which
/// TensorBoard shows as another run.
pub fn set_aside(folder: &Path) -> Result<()> {
    move_log(folder).map_err(|error| write_error(folder, error))
}

fn move_log(folder: &Path) -> io::Result<()> {
    let mut names = Vec::new();
    for entry in fs::read_dir(folder)? {
        let name = entry?.file_name();
        if name.to_str().is_some_and(|name| name == TABLE || name == CURVES || is_event_file(name)) {
            names.push(name);
        }
    }
    if names.is_empty() {
        return Ok(());
    }
    for number in 1_u64.. {
        let earlier = folder.join(format!("earlier-{number}"));
        match fs::create_dir(&earlier) {
            Err(error) if error.kind() == io::ErrorKind::AlreadyExists => {}
            Err(error) => return Err(error),
            Ok(()) => {
                return names.iter().try_for_each(|name| fs::rename(folder.join(name), earlier.join(name)));
            }
        }
    }
    Ok(())
}
