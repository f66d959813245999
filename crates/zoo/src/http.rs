//! HTTP client with time limits and retries.

use std::io;
use std::time::Duration;

use opendr_engine::{Error, Progress, Result, ResultExt};
use ureq::http::{Response, StatusCode};
use ureq::tls::{RootCerts, TlsConfig};
use ureq::{Agent, Body};

use crate::stop::unless_stopped;
use crate::stopped;

/// Maximum number of successive attempts without progress.
const TRIES: u32 = 3;
/// Maximum number of attempts in all, for a server that sends a little each time.
const MOST_TRIES: u32 = 50;

/// Client with the certificates of the system, so that company proxies work.
#[derive(Debug, Clone)]
pub(crate) struct Http {
    agent: Agent,
    pause: Duration,
}

/// Failure of an attempt.
#[derive(Debug)]
pub(crate) enum Failure {
    /// A retry may succeed; `gained` is whether this attempt received data.
    Passing { error: Error, gained: bool },
    /// A retry would fail too.
    Final(Error),
}

impl Http {
    /// `timeout` limits each wait for the server. `pause` is the wait before a retry; it doubles with each attempt without progress.
    pub(crate) fn new(timeout: Duration, pause: Duration) -> Self {
        let config = Agent::config_builder()
            .user_agent(concat!("opendr/", env!("CARGO_PKG_VERSION")))
            .http_status_as_error(false)
            .timeout_resolve(Some(timeout))
            .timeout_connect(Some(timeout))
            .timeout_recv_response(Some(timeout))
            .timeout_per_read(Some(timeout))
            .tls_config(TlsConfig::builder().root_certs(RootCerts::PlatformVerifier).build());
        Self { agent: config.build().into(), pause }
    }

    /// Returns the successful response to a GET request with these headers.
    pub(crate) fn get(
        &self,
        address: &str,
        headers: &[(&str, String)],
        progress: &dyn Progress,
    ) -> Result<Response<Body>, Failure> {
        let mut request = self.agent.get(address);
        for (name, value) in headers {
            request = request.header(*name, value);
        }
        let response =
            unless_stopped(progress, || request.call()).map_err(Failure::Final)?.map_err(from_ureq)?;
        let status = response.status();
        if status.is_success() || status == StatusCode::RANGE_NOT_SATISFIABLE {
            return Ok(response);
        }
        let text = format!("the server returned {status}");
        Err(match status {
            StatusCode::NOT_FOUND | StatusCode::GONE => Failure::Final(Error::not_found(text)),
            StatusCode::REQUEST_TIMEOUT | StatusCode::TOO_MANY_REQUESTS => passing(text),
            _ if status.is_server_error() => passing(text),
            _ => Failure::Final(Error::network(text)),
        })
    }

    /// Repeats an attempt until it succeeds, fails finally, or makes no more progress.
    pub(crate) fn retry<T>(
        &self,
        address: &str,
        progress: &dyn Progress,
        mut attempt: impl FnMut() -> Result<T, Failure>,
    ) -> Result<T> {
        let (mut tries, mut fruitless) = (0, 0);
        loop {
            tries += 1;
            let error = match attempt() {
                Ok(done) => return Ok(done),
                Err(Failure::Final(error)) => return Err(error.context(address)),
                Err(Failure::Passing { error, gained }) => {
                    fruitless = if gained { 0 } else { fruitless + 1 };
                    error
                }
            };
            if progress.stopped() {
                return Err(stopped());
            }
            if fruitless >= TRIES || tries >= MOST_TRIES {
                return Err(error.context(format!("{address}: gave up after {tries} tries")));
            }
            progress.note(&format!("{error}: trying again"));
            std::thread::sleep(self.pause * 2u32.pow(fruitless));
        }
    }

    /// Returns a small file, or `None` when the server does not have it.
    pub(crate) fn small(
        &self,
        address: &str,
        limit: u64,
        progress: &dyn Progress,
    ) -> Result<Option<Vec<u8>>> {
        let read = || {
            let mut response = self.get(address, &[], progress)?;
            let read = move || response.body_mut().with_config().limit(limit).read_to_vec();
            unless_stopped(progress, read).map_err(Failure::Final)?.map_err(from_ureq)
        };
        match self.retry(address, progress, read) {
            Ok(bytes) => Ok(Some(bytes)),
            Err(error) if error.kind() == opendr_engine::ErrorKind::NotFound => Ok(None),
            Err(error) => Err(error).context(|| "reading from the repository"),
        }
    }
}

pub(crate) fn passing(text: impl Into<String>) -> Failure {
    Failure::Passing { error: Error::network(text), gained: false }
}

/// Converts an error of reading a body.
pub(crate) fn from_io(error: io::Error) -> Failure {
    Failure::Passing {
        error: Error::network("the connection was interrupted").with_source(error),
        gained: false,
    }
}

fn from_ureq(error: ureq::Error) -> Failure {
    use ureq::Error::{
        BadUri, BodyExceedsLimit, ConnectionFailed, HostNotFound, Io, Protocol, Timeout, TooManyRedirects,
    };
    match error {
        Io(_) | Timeout(_) | HostNotFound | ConnectionFailed | Protocol(_) => Failure::Passing {
            error: Error::network("the server could not be reached").with_source(error),
            gained: false,
        },
        BadUri(_) | TooManyRedirects | BodyExceedsLimit(_) => {
            Failure::Final(Error::network("the server's response is invalid").with_source(error))
        }
        error => Failure::Final(Error::network("the connection failed").with_source(error)),
    }
}
