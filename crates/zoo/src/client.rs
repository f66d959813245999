//! Execution of the installed clients of package registries, with progress.

use std::fs::{self, File};
use std::io::{self, Read};
use std::path::{Path, PathBuf};
use std::process::{Child, Command, ExitStatus, Stdio};
use std::time::Duration;

use opendr_engine::{Error, ErrorKind, Progress, Result, ResultExt, Unit};

use crate::stopped;
use crate::work_folder::WorkFolder;

/// One call of a client that downloads one file into a folder.
pub(crate) struct Call<'a> {
    /// Program with its arguments.
    pub(crate) command: Command,
    /// Description of the download, for messages.
    pub(crate) what: String,
    /// Size of the download in bytes, if known.
    pub(crate) size: Option<u64>,
    /// Folder of the downloaded file.
    pub(crate) output: PathBuf,
    /// Temporary folder of the client, whose growth is the progress.
    pub(crate) work: &'a WorkFolder,
}

impl Call<'_> {
    /// Runs the client and returns the one file that it writes into the output folder.
    ///
    /// # Errors
    /// `Unsupported` when the program is not installed, `NotFound` when the registry has no such package, `Network` with the
    /// client's output for other failures.
    pub(crate) fn run(mut self, progress: &dyn Progress) -> Result<PathBuf> {
        let log = self.work.path().join("stderr.log");
        let program = self.command.get_program().to_string_lossy().into_owned();
        let child = self
            .command
            .current_dir(self.work.path())
            .env("NO_COLOR", "1")
            .stdin(Stdio::null())
            .stdout(Stdio::null())
            .stderr(File::create(&log).context(|| log.display().to_string())?)
            .spawn();
        let child = child.map_err(|error| match error.kind() {
            io::ErrorKind::NotFound => Error::unsupported(format!("{program} is not installed")),
            _ => Error::io(format!("{program} cannot be started")).with_source(error),
        })?;
        progress.begin(&self.what, self.size, Unit::Bytes);
        let status = self.watch(child, progress);
        progress.end();
        if !status?.success() {
            let text = read_log(&log);
            return Err(Error::new(kind_of(&text), format!("{program} failed: {}", quoted(&text))));
        }
        one_file(&self.output)
    }

    fn watch(&self, mut child: Child, progress: &dyn Progress) -> Result<ExitStatus> {
        let mut reported = 0;
        loop {
            if let Some(status) = child.try_wait()? {
                progress.advance(self.size.unwrap_or(reported).saturating_sub(reported));
                return Ok(status);
            }
            if progress.stopped() {
                child.kill()?;
                child.wait()?;
                return Err(stopped());
            }
            // Clients keep a second copy at the end, so the folder can be larger than the download.
            let there = size_below(self.work.path(), 12).min(self.size.unwrap_or(u64::MAX));
            progress.advance(there.saturating_sub(reported));
            reported = reported.max(there);
            std::thread::sleep(Duration::from_millis(100));
        }
    }
}

fn size_below(folder: &Path, depth: u32) -> u64 {
    let Ok(entries) = fs::read_dir(folder) else { return 0 };
    let size = |entry: fs::DirEntry| match entry.metadata() {
        Ok(found) if found.is_dir() && depth > 0 => size_below(&entry.path(), depth - 1),
        Ok(found) if found.is_file() => found.len(),
        _ => 0,
    };
    entries.filter_map(io::Result::ok).map(size).sum()
}

fn one_file(folder: &Path) -> Result<PathBuf> {
    let entries = fs::read_dir(folder).context(|| folder.display().to_string())?;
    let mut paths = entries.filter_map(|entry| Some(entry.ok()?.path())).filter(|path| path.is_file());
    match (paths.next(), paths.next()) {
        (Some(path), None) => Ok(path),
        _ => Err(Error::network("the client succeeded but did not download exactly one file")),
    }
}

/// Returns the client's output, of at most 1 MiB.
fn read_log(log: &Path) -> String {
    let mut bytes = Vec::new();
    // An unreadable log is not quoted.
    let _ = File::open(log).and_then(|file| file.take(1 << 20).read_to_end(&mut bytes));
    String::from_utf8_lossy(&bytes).into_owned()
}

/// Joins the first lines (npm's reason) and the last ones (pip's reason) into one line.
fn quoted(text: &str) -> String {
    let lines: Vec<String> = text
        .lines()
        .map(str::trim)
        .filter(|line| !line.is_empty() && !line.contains("complete log of this run"))
        .map(|line| line.chars().take(240).collect())
        .collect();
    match lines.as_slice() {
        [] => "no output".to_owned(),
        [first @ .., _, _, _] if first.len() > 3 => {
            format!("{}; ...; {}", lines[..3].join("; "), lines[lines.len() - 3..].join("; "))
        }
        all => all.join("; "),
    }
}

/// Returns `NotFound` if the registry has no such package, `Network` if it could not be reached.
fn kind_of(text: &str) -> ErrorKind {
    let unreachable =
        ["NewConnectionError", "ConnectTimeout", "NameResolutionError", "ENOTFOUND", "EAI_AGAIN"];
    let absent = ["E404", "ETARGET", "No matching distribution"];
    let says = |marks: &[&str]| marks.iter().any(|mark| text.contains(mark));
    if !says(&unreachable) && says(&absent) { ErrorKind::NotFound } else { ErrorKind::Network }
}

#[cfg(test)]
mod tests {
    use super::*;
    use opendr_engine::Silent;

    fn call<'a>(work: &'a WorkFolder, program: &str, arguments: &[&str]) -> Call<'a> {
        let mut command = Command::new(program);
        command.args(arguments);
        let output = work.folder("out").unwrap();
        Call { command, what: "a test".into(), size: Some(10), output, work }
    }

    fn work() -> WorkFolder {
        let parent = std::env::temp_dir().join(format!("opendr-client-{}", std::process::id()));
        WorkFolder::new(&parent, &Silent).unwrap()
    }

    #[test]
    fn absent_client_is_reported() {
        let error = call(&work(), "opendr-no-such-client", &[]).run(&Silent).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Unsupported);
        assert!(error.to_string().contains("opendr-no-such-client is not installed"), "{error}");
    }

    #[cfg(unix)]
    #[test]
    fn failing_client_is_quoted_and_a_file_is_found() {
        let work = work();
        let error =
            call(&work, "sh", &["-c", "echo npm error code E404 >&2; exit 3"]).run(&Silent).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::NotFound);
        assert!(error.to_string().contains("npm error code E404"), "{error}");
        let error = call(&work, "sh", &["-c", "true"]).run(&Silent).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Network);
        let path = call(&work, "sh", &["-c", "echo hello > out/a.tgz"]).run(&Silent).unwrap();
        assert_eq!(fs::read(path).unwrap(), b"hello\n");
    }

    #[cfg(unix)]
    #[test]
    fn stopping_kills_the_client() {
        struct Stop;
        impl Progress for Stop {
            fn begin(&self, _: &str, _: Option<u64>, _: Unit) {}
            fn advance(&self, _: u64) {}
            fn end(&self) {}
            fn stopped(&self) -> bool {
                true
            }
        }
        // It would take an hour if it were not killed.
        let error = call(&work(), "sleep", &["3600"]).run(&Stop).unwrap_err();
        assert!(error.to_string().contains("stopped"), "{error}");
    }

    #[test]
    fn long_complaints_keep_their_beginning_and_end() {
        assert_eq!(quoted("\n a \nb\n"), "a; b");
        assert_eq!(quoted("1\n2\n3\n4\n5\n6"), "1; 2; 3; 4; 5; 6");
        assert_eq!(quoted("1\n2\n3\n4\n5\n6\n7\n8"), "1; 2; 3; ...; 6; 7; 8");
        assert!(quoted(&"x".repeat(10_000)).len() < 300);
    }

    #[test]
    fn unreachable_registry_is_no_absent_package() {
        assert_eq!(
            kind_of("NewConnectionError ...; ERROR: No matching distribution found"),
            ErrorKind::Network
        );
        assert_eq!(kind_of("ERROR: No matching distribution found for x==9"), ErrorKind::NotFound);
        assert_eq!(kind_of("getaddrinfo ENOTFOUND"), ErrorKind::Network);
    }
}
