//! The server: a thread that accepts connections, and one for each of them.

use std::net::{Shutdown, SocketAddr, TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::thread::{self, JoinHandle};
use std::time::Duration;

use opendr_engine::params::ParamValue;
use opendr_engine::{Error, ErrorKind, Result, ResultExt};

use crate::access::Access;
use crate::feed::Feed;
use crate::request::{Failure, Request};
use crate::response::Response;
use crate::routes::Shared;
use crate::settings::Settings;
use crate::{Shown, ViewerOptions};

/// Maximum number of connections; a browser opens up to six.
const MAX_CONNECTIONS: usize = 32;
/// Time after which an idle connection ends.
const IDLE: Duration = Duration::from_secs(30);
/// Time after which a connection that takes no bytes ends.
const BLOCKED: Duration = Duration::from_secs(10);

/// A web page of inputs, predictions and curves.
#[derive(Debug)]
pub struct Viewer {
    pub(crate) shared: Arc<Shared>,
    address: SocketAddr,
    acceptor: Option<JoinHandle<()>>,
}

impl Viewer {
    /// Serves the page at `address`; port 0 selects a free one.
    ///
    /// # Errors
    /// `Io` when the port is in use.
    pub fn bind(address: SocketAddr, options: ViewerOptions) -> Result<Self> {
        let listener = TcpListener::bind(address).context(|| {
            format!("serving the viewer at {address}; choose another port with --view=ADDRESS:PORT")
        })?;
        let address = listener.local_addr().context(|| "the viewer's address")?;
        let ViewerOptions { title, params, values, is_writable, curves } = options;
        let shared = Arc::new(Shared {
            title,
            access: Access::new(address)?,
            feed: Feed::default(),
            settings: Settings::new(params, values),
            is_writable,
            curves,
        });
        let accepting = shared.clone();
        let acceptor = thread::Builder::new()
            .name("viewer".to_owned())
            .spawn(move || accept(&listener, &accepting))
            .map_err(|error| Error::new(ErrorKind::Io, format!("starting the viewer: {error}")))?;
        Ok(Self { shared, address, acceptor: Some(acceptor) })
    }

    /// Returns the address to open in a browser.
    pub fn url(&self) -> String {
        match &self.shared.access.token {
            Some(token) => format!("http://{}/?token={token}", self.address),
            None => format!("http://{}/", self.address),
        }
    }

    /// Displays an item in place of the one before.
    pub fn show(&self, item: Shown) {
        self.shared.feed.put(item);
    }

    /// Returns the parameters that pages changed after change number `last`, and updates it.
    pub fn changes(&self, last: &mut u64) -> Vec<(String, ParamValue)> {
        self.shared.settings.changes(last)
    }

    /// Displays why a parameter was not changed.
    pub fn fail(&self, error: &Error) {
        self.shared.settings.fail(error.to_string());
    }
}

impl Drop for Viewer {
    fn drop(&mut self) {
        self.shared.feed.close();
        // Wakes the thread that accepts. An address of all interfaces is reached through the loopback interface.
        let mut own = self.address;
        if own.ip().is_unspecified() {
            own.set_ip(if own.is_ipv4() {
                [127, 0, 0, 1].into()
            } else {
                [0, 0, 0, 0, 0, 0, 0, 1_u16].into()
            });
        }
        if TcpStream::connect_timeout(&own, BLOCKED).is_ok()
            && let Some(acceptor) = self.acceptor.take()
        {
            acceptor.join().ok();
        }
    }
}

fn accept(listener: &TcpListener, shared: &Arc<Shared>) {
    let open = Arc::new(AtomicUsize::new(0));
    for stream in listener.incoming() {
        if shared.feed.is_closed() {
            return;
        }
        let Ok(stream) = stream else {
            // Too many open files: connections that end make room.
            thread::sleep(Duration::from_millis(50));
            continue;
        };
        if open.fetch_add(1, Ordering::Relaxed) >= MAX_CONNECTIONS {
            open.fetch_sub(1, Ordering::Relaxed);
            refuse(stream);
            continue;
        }
        let (serving, counter) = (shared.clone(), open.clone());
        let started = thread::Builder::new().name("viewer connection".to_owned()).spawn(move || {
            serve(stream, &serving);
            counter.fetch_sub(1, Ordering::Relaxed);
        });
        if started.is_err() {
            open.fetch_sub(1, Ordering::Relaxed);
        }
    }
}

fn refuse(mut stream: TcpStream) {
    stream.set_write_timeout(Some(Duration::from_millis(100))).ok();
    Response::refusal(503, "the viewer has too many connections").write(&mut stream, true, true).ok();
}

/// Serves the requests of a connection until it ends.
fn serve(mut stream: TcpStream, shared: &Shared) {
    stream.set_read_timeout(Some(IDLE)).ok();
    stream.set_write_timeout(Some(BLOCKED)).ok();
    stream.set_nodelay(true).ok();
    let mut rest = Vec::new();
    while !shared.feed.is_closed() {
        let (response, with_body, is_last) = match Request::read(&mut stream, &mut rest) {
            Ok(request) => {
                let is_last =
                    request.header("connection").is_some_and(|value| value.eq_ignore_ascii_case("close"));
                (shared.response(&request), request.method != "HEAD", is_last)
            }
            Err(Failure::Refused(status, text)) => (Response::refusal(status, text), true, true),
            Err(Failure::Closed) => return,
        };
        if response.write(&mut stream, with_body, is_last).is_err() || is_last {
            break;
        }
    }
    stream.shutdown(Shutdown::Write).ok();
}
