//! TCP connections with time limits and keep-alive.

use std::io::{self, Read};
use std::net::{TcpStream, ToSocketAddrs};
use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};

/// Time limit of opening a connection, and of the handshake.
pub(crate) const HANDSHAKE_TIME: Duration = Duration::from_secs(5);

/// Connects to `host` within `time` for each of its addresses.
///
/// # Errors
/// `Network` when no address responds.
pub(crate) fn connect(host: &str, port: u16, time: Duration) -> Result<TcpStream> {
    let failed = |error: io::Error| {
        Error::network(format!(
            "cannot connect to {host}:{port}; check that the peer runs and that its name resolves here (ROS_IP, \
             ROS_HOSTNAME)"
        ))
        .with_source(error)
    };
    let mut last = io::Error::new(io::ErrorKind::NotFound, "the name has no address");
    for address in (host, port).to_socket_addrs().map_err(failed)? {
        match TcpStream::connect_timeout(&address, time) {
            Ok(stream) => {
                // Messages are written whole, so Nagle's algorithm only adds latency.
                stream.set_nodelay(true).ok();
                keep_alive(&stream);
                return Ok(stream);
            }
            Err(error) => last = error,
        }
    }
    Err(failed(last))
}

/// Enables TCP keep-alive: the first probe after a minute, then every ten seconds, as in roscpp.
#[cfg(unix)]
pub(crate) fn keep_alive(stream: &TcpStream) {
    use std::os::fd::AsRawFd;

    let set = |level: i32, name: i32, value: i32| {
        let size = size_of::<i32>() as libc::socklen_t;
        // SAFETY: the descriptor is open for as long as `stream` is borrowed; the option is an int of `size`
        // bytes.
        unsafe { libc::setsockopt(stream.as_raw_fd(), level, name, (&raw const value).cast(), size) };
    };
    set(libc::SOL_SOCKET, libc::SO_KEEPALIVE, 1);
    #[cfg(target_os = "linux")]
    for (name, value) in [(libc::TCP_KEEPIDLE, 60), (libc::TCP_KEEPINTVL, 10), (libc::TCP_KEEPCNT, 9)] {
        set(libc::IPPROTO_TCP, name, value);
    }
}

/// Keeps the system's default on other systems.
#[cfg(not(unix))]
pub(crate) fn keep_alive(_: &TcpStream) {}

/// A connection whose reads fail after a total time limit.
#[derive(Debug)]
pub(crate) struct Timed<'a> {
    stream: &'a TcpStream,
    until: Instant,
}

impl<'a> Timed<'a> {
    pub fn new(stream: &'a TcpStream, time: Duration) -> Self {
        Self { stream, until: Instant::now() + time }
    }

    /// Sets the limit to `time` from now.
    pub fn extend(&mut self, time: Duration) {
        self.until = Instant::now() + time;
    }
}

impl Read for Timed<'_> {
    fn read(&mut self, buffer: &mut [u8]) -> io::Result<usize> {
        let left = self.until.saturating_duration_since(Instant::now());
        if left.is_zero() {
            return Err(io::Error::new(io::ErrorKind::TimedOut, "the peer is too slow"));
        }
        self.stream.set_read_timeout(Some(left))?;
        (&mut &*self.stream).read(buffer)
    }
}
