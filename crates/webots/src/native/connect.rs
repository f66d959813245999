//! Connecting to Webots.

use std::net::TcpStream;
#[cfg(unix)]
use std::path::PathBuf;
use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};

use super::answer::Framing;
use super::client::NativeLink;
use super::handshake::{self, Greeting};
use super::stream::Stream;
use crate::url::ControllerUrl;
#[cfg(unix)]
use crate::url::encoded;
use crate::version::Version;

/// Pause between two attempts while Webots loads a world.
const PAUSE: Duration = Duration::from_millis(200);

impl NativeLink {
    /// Connects to a robot whose controller is `<extern>`. Without a version, Webots must state its own, as it does from R2023b on. `timeout` bounds the wait for a world that is being loaded and for each
    /// answer; none waits forever, as a paused simulation needs.
    ///
    /// # Errors
    /// Returns `Network` if Webots cannot be reached, `NotFound` if it has no such robot, `Unsupported` if it states a version that
    /// this client does not know, `InvalidParam` if it states another version than `version`.
    pub fn connect(url: &ControllerUrl, version: Option<Version>, timeout: Option<Duration>) -> Result<Self> {
        let begin = Instant::now();
        let (stream, framing) = loop {
            match open(url, timeout)? {
                Some(opened) => break opened,
                None if timeout.is_some_and(|timeout| begin.elapsed() > timeout) => {
                    return Err(Error::network(format!("{url} still loads its world")));
                }
                None => std::thread::sleep(PAUSE),
            }
        };
        Self::over(stream, framing, version).map_err(|error| error.context(url.to_string()))
    }
}

/// Opens a connection; none while the world is being loaded.
fn open(url: &ControllerUrl, timeout: Option<Duration>) -> Result<Option<(Stream, Framing)>> {
    let failed = |error| Error::network(format!("cannot connect to Webots at {url}")).with_source(error);
    match url {
        ControllerUrl::Tcp { host, port, robot } => {
            let host = host.trim_start_matches('[').trim_end_matches(']');
            let stream = Stream::Tcp(TcpStream::connect((host, *port)).map_err(failed)?);
            stream.set_timeout(timeout).map_err(failed)?;
            let mut stream = stream;
            let greeting = handshake::greet(&mut stream, robot.as_deref())?;
            Ok(Some((stream, Framing::Tcp)).filter(|_| greeting == Greeting::Connected))
        }
        #[cfg(unix)]
        ControllerUrl::Ipc { port, robot } => {
            let folder = instance_folder(*port)?;
            if folder.join("loading").exists() {
                return Ok(None);
            }
            let socket = folder.join("ipc").join(encoded(robot)).join("extern");
            if !socket.exists() {
                return Err(Error::not_found(format!(
                    "{} does not exist: Webots does not run at port {port}, or has no robot {robot:?} with the controller <extern>",
                    socket.display()
                )));
            }
            let stream = Stream::Unix(std::os::unix::net::UnixStream::connect(&socket).map_err(failed)?);
            stream.set_timeout(timeout).map_err(failed)?;
            Ok(Some((stream, Framing::Ipc)))
        }
        #[cfg(not(unix))]
        ControllerUrl::Ipc { .. } => {
            Err(Error::unsupported("ipc:// needs Unix sockets; use tcp://localhost:1234/ROBOT"))
        }
    }
}

/// Returns the folder of a running Webots: `TMP/webots/USER/PORT`.
#[cfg(unix)]
fn instance_folder(port: u16) -> Result<PathBuf> {
    let set = |name: &str| std::env::var_os(name).filter(|value| !value.is_empty());
    let user = set("USER").or_else(|| set("USERNAME")).ok_or_else(|| {
        Error::not_found(
            "neither USER nor USERNAME is set, which are part of the path of Webots' sockets; set USER",
        )
    })?;
    let folder: PathBuf = set("WEBOTS_TMPDIR").map_or_else(|| "/tmp".into(), PathBuf::from);
    Ok(folder.join("webots").join(user).join(port.to_string()))
}
