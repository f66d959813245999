//! Talking http and https: time limits, retries, one kind of error.

use std::io;
use std::time::Duration;

use opendr_engine::{Error, Progress, Result, ResultExt};
use ureq::http::{Response, StatusCode};
use ureq::tls::{RootCerts, TlsConfig};
use ureq::{Agent, Body};

use crate::stop::unless_stopped;
use crate::stopped;

/// So many tries in a row may bring nothing.
const TRIES: u32 = 3;
/// So many tries in all, for a server that gives a little each time.
const MOST_TRIES: u32 = 50;

/// A client that trusts the certificates that the system trusts, so that company proxies work.
#[derive(Debug, Clone)]
pub(crate) struct Http {
    agent: Agent,
    pause: Duration,
}

/// Why a try did not end well.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Another try may help; `gained` tells whether this one brought something.
    Passing { error: Error, gained: bool },
    /// It would fail again.
    Final(Error),
}

impl Http {
    /// `timeout` limits each wait for the server, `pause` is that after a try that brought something, and doubles with each that does not.
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

    /// The answer to a GET with these headers, when its status is one of success.
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
        let text = format!("the server answers {status}");
        Err(match status {
            StatusCode::NOT_FOUND | StatusCode::GONE => Failure::Final(Error::not_found(text)),
            StatusCode::REQUEST_TIMEOUT | StatusCode::TOO_MANY_REQUESTS => passing(text),
            _ if status.is_server_error() => passing(text),
            _ => Failure::Final(Error::network(text)),
        })
    }

    /// Tries until it works, it cannot work, or nothing comes any more.
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

    /// A small file, or `None` when the server has no such file.
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
            Err(error) => Err(error).context(|| "asking the repository"),
        }
    }
}

pub(crate) fn passing(text: impl Into<String>) -> Failure {
    Failure::Passing { error: Error::network(text), gained: false }
}

/// What went wrong while a body was read.
pub(crate) fn from_io(error: io::Error) -> Failure {
    Failure::Passing { error: Error::network("the connection broke").with_source(error), gained: false }
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
            Failure::Final(Error::network("the server's answer is of no use").with_source(error))
        }
        error => Failure::Final(Error::network("the connection failed").with_source(error)),
    }
}
