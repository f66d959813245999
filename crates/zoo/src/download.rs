//! Download of one file from one address, with resumption and verification.

use std::fs::{self, File};
use std::io::{self, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use opendr_engine::{Error, Progress, Result, ResultExt, Unit};
use serde::{Deserialize, Serialize};
use ureq::Body;
use ureq::http::{HeaderMap, Response, StatusCode, header};

use crate::cache::Cache;
use crate::card::CardFile;
use crate::http::{Failure, Http, from_io, passing};
use crate::stop::unless_stopped;
use crate::stopped;

/// Downloads the file from `address` into the cache, unless it is there.
pub(crate) fn download(
    http: &Http,
    cache: &Cache,
    address: &str,
    file: &CardFile,
    progress: &dyn Progress,
) -> Result<()> {
    let _turn = cache.lock(&file.sha256.to_string(), &file.name, progress)?;
    if cache.has(file) {
        return Ok(());
    }
    let part = Part { path: cache.part(&file.sha256), address, size: file.size };
    loop {
        let resumed = part.length() > 0;
        let position = Position::new(progress);
        progress.begin(&file.name, Some(file.size), Unit::Bytes);
        let fetched = http.retry(address, progress, || part.fetch_rest(http, &position));
        progress.end();
        fetched?;
        let adopted = cache.adopt_part(file).context(|| address);
        part.forget();
        // A part of an older version of the file corrupts the download; one restart without it decides.
        if adopted.is_ok() || !resumed {
            return adopted;
        }
        progress.note("the resumed download has a wrong checksum: starting over");
    }
}

/// Incomplete download of a file.
struct Part<'a> {
    path: PathBuf,
    address: &'a str,
    size: u64,
}

/// Conditions under which an incomplete download resumes.
#[derive(Default, Serialize, Deserialize)]
struct Origin {
    address: String,
    validator: Option<String>,
}

impl Part<'_> {
    fn length(&self) -> u64 {
        fs::metadata(&self.path).map_or(0, |found| found.len())
    }

    fn origin_path(&self) -> PathBuf {
        self.path.with_extension("json")
    }

    fn forget(&self) {
        // The files may be absent already.
        let _ = fs::remove_file(&self.path);
        let _ = fs::remove_file(self.origin_path());
    }

    fn fetch_rest(&self, http: &Http, position: &Position<'_>) -> Result<(), Failure> {
        let have = self.length();
        if have == self.size {
            position.at(have);
            return Ok(());
        }
        let response = http.get(self.address, &self.resume_headers(have), position.progress)?;
        if response.status() == StatusCode::RANGE_NOT_SATISFIABLE {
            self.forget();
            return Err(passing("the server does not have the requested range of the file"));
        }
        let start = start_of(&response, have)?;
        let announced = response.body().content_length().map(|length| length.saturating_add(start));
        if let Some(announced) = announced.filter(|announced| *announced != self.size) {
            return Err(Failure::Final(Error::integrity(format!(
                "the server has a file of {announced} bytes instead of {}: not downloaded",
                self.size
            ))));
        }
        let mut file = self.open(start, response.headers()).map_err(|error| Failure::Final(error.into()))?;
        let limit = self.size - start + 1;
        let reader = response.into_body().into_with_config().limit(u64::MAX).reader().take(limit);
        let end = copy(reader, &mut file, start, position)?;
        if end == self.size {
            return file.sync_all().map_err(|error| Failure::Final(error.into()));
        }
        if end > self.size {
            self.forget();
            return Err(Failure::Final(Error::integrity(format!(
                "the server sends more than {} bytes",
                self.size
            ))));
        }
        let error = Error::network(format!("the download was interrupted at {end} of {} bytes", self.size));
        Err(Failure::Passing { error, gained: end > have })
    }

    /// Returns the request headers for the rest, valid only if the server still has the same file.
    fn resume_headers(&self, have: u64) -> Vec<(&'static str, String)> {
        let origin = fs::read(self.origin_path()).ok();
        let origin: Origin = origin.and_then(|json| serde_json::from_slice(&json).ok()).unwrap_or_default();
        if have == 0 || have > self.size || origin.address != self.address {
            return Vec::new();
        }
        let range = ("range", format!("bytes={have}-"));
        std::iter::once(range).chain(origin.validator.map(|validator| ("if-range", validator))).collect()
    }

    fn open(&self, start: u64, headers: &HeaderMap) -> io::Result<File> {
        if let Some(folder) = self.path.parent() {
            fs::create_dir_all(folder)?;
        }
        let mut file = File::options().create(true).truncate(false).write(true).open(&self.path)?;
        if start == 0 {
            file.set_len(0)?;
            let origin = Origin { address: self.address.to_owned(), validator: validator(headers) };
            fs::write(self.origin_path(), serde_json::to_vec(&origin)?)?;
        }
        file.seek(SeekFrom::Start(start))?;
        Ok(file)
    }
}

/// Returns the value of `If-Range`: a strong ETag, else the date of the last modification.
fn validator(headers: &HeaderMap) -> Option<String> {
    let text = |name| headers.get(name)?.to_str().ok().map(str::to_owned);
    text(header::ETAG).filter(|tag| !tag.starts_with("W/")).or_else(|| text(header::LAST_MODIFIED))
}

/// Returns the byte at which the response begins.
fn start_of(response: &Response<Body>, have: u64) -> Result<u64, Failure> {
    if response.status() != StatusCode::PARTIAL_CONTENT {
        return Ok(0);
    }
    let range = response.headers().get(header::CONTENT_RANGE).and_then(|range| range.to_str().ok());
    let start = range.and_then(|range| range.strip_prefix("bytes ")?.split('-').next()?.parse().ok());
    match start {
        Some(start) if start == have => Ok(start),
        _ => Err(Failure::Final(Error::network(format!(
            "the server sends the range {range:?}, but bytes from {have} were requested"
        )))),
    }
}

fn copy(
    mut reader: impl Read + Send + 'static,
    file: &mut File,
    start: u64,
    position: &Position<'_>,
) -> Result<u64, Failure> {
    let mut buffer = vec![0; 1 << 16];
    let mut at = start;
    position.at(at);
    loop {
        let read;
        (reader, buffer, read) = unless_stopped(position.progress, move || {
            let read = reader.read(&mut buffer);
            (reader, buffer, read)
        })
        .map_err(Failure::Final)?;
        let count = match read {
            Ok(0) => return Ok(at),
            Ok(count) => count,
            // The received bytes count, and the next attempt resumes there.
            Err(_) if at > start => return Ok(at),
            Err(error) => return Err(from_io(error)),
        };
        file.write_all(&buffer[..count]).map_err(|error| Failure::Final(error.into()))?;
        at += count as u64;
        position.at(at);
        if position.progress.stopped() {
            return Err(Failure::Final(stopped()));
        }
    }
}

/// Reports the position of a download, also when an attempt begins before the end of the last one.
struct Position<'a> {
    progress: &'a dyn Progress,
    reported: std::cell::Cell<u64>,
}

impl<'a> Position<'a> {
    fn new(progress: &'a dyn Progress) -> Self {
        Self { progress, reported: std::cell::Cell::new(0) }
    }

    fn at(&self, bytes: u64) {
        let more = bytes.saturating_sub(self.reported.get());
        if more > 0 {
            self.reported.set(bytes);
            self.progress.advance(more);
        }
    }
}

/// Returns the address of `place` below `base`.
pub(crate) fn address_below(base: &str, place: &str) -> String {
    let mut address = base.trim_end_matches('/').to_owned();
    for part in Path::new(place) {
        address.push('/');
        for byte in part.to_string_lossy().bytes() {
            if byte.is_ascii_alphanumeric() || b"-._~@+".contains(&byte) {
                address.push(char::from(byte));
            } else {
                address.push_str(&format!("%{byte:02X}"));
            }
        }
    }
    address
}
