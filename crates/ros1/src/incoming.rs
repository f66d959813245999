//! Incoming connections.

use std::net::{TcpListener, TcpStream};
use std::sync::Arc;
use std::sync::atomic::{AtomicUsize, Ordering};
use std::time::Duration;

use opendr_engine::{Error, ErrorKind, Result};

use crate::connection::{HANDSHAKE_TIME, Timed, keep_alive};
use crate::graph::Graph;
use crate::http::serve_connection;
use crate::lock::lock;
use crate::slave;
use crate::tasks::Cancel;
use crate::tcpros::Header;

/// Maximum number of simultaneous connections of each kind; further ones are closed at once.
const MOST_CONNECTIONS: usize = 128;

/// Handler of a connection, on a thread of its own.
type Serve = fn(&Arc<Graph>, &TcpStream, &Cancel) -> Result<()>;

/// Serves every connection to `listener`.
pub(crate) fn start(graph: &Arc<Graph>, listener: TcpListener, serve: Serve) -> Result<()> {
    let mut address = listener.local_addr()?;
    if address.ip().is_unspecified() {
        // The address by which this process itself can connect.
        address.set_ip(if address.is_ipv4() {
            [127, 0, 0, 1].into()
        } else {
            std::net::Ipv6Addr::LOCALHOST.into()
        });
    }
    graph.context.tasks.listens(address);
    let graph = Arc::clone(graph);
    let tasks = Arc::clone(&graph.context.tasks);
    tasks.spawn("accept", move |cancel| accept(&graph, &listener, serve, cancel))?;
    Ok(())
}

fn accept(graph: &Arc<Graph>, listener: &TcpListener, serve: Serve, cancel: &Cancel) {
    let open = Arc::new(AtomicUsize::new(0));
    while !cancel.is_cancelled() {
        let Ok((stream, _)) = listener.accept() else {
            // Most likely out of file descriptors, which may become free.
            cancel.wait(Duration::from_millis(100));
            continue;
        };
        if cancel.is_cancelled() {
            return;
        }
        if open.fetch_add(1, Ordering::AcqRel) >= MOST_CONNECTIONS {
            open.fetch_sub(1, Ordering::AcqRel);
            graph.context.problem(Error::unsupported(format!(
                "more than {MOST_CONNECTIONS} simultaneous connections; one was closed"
            )));
            continue;
        }
        let (served, count) = (Arc::clone(graph), Counted(Arc::clone(&open)));
        let started = graph.context.tasks.spawn("connection", move |cancel| {
            let _count = count;
            stream.set_nodelay(true).ok();
            keep_alive(&stream);
            let ended = cancel.hold(&stream).and_then(|()| serve(&served, &stream, cancel));
            report(&served, &stream, cancel, ended);
        });
        if let Err(error) = started
            && !cancel.is_cancelled()
        {
            graph.context.problem(error);
        }
    }
}

/// Counter of an open connection.
struct Counted(Arc<AtomicUsize>);

impl Drop for Counted {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

/// Reports the errors of a peer that sends invalid data, but not disconnections.
fn report(graph: &Graph, stream: &TcpStream, cancel: &Cancel, ended: Result<()>) {
    if let Err(error) = ended
        && !matches!(error.kind(), ErrorKind::Network | ErrorKind::Io)
        && !cancel.is_cancelled()
    {
        let peer = stream.peer_addr().map(|address| address.to_string());
        graph.context.problem(error.context(format!("serving {}", peer.as_deref().unwrap_or("a peer"))));
    }
}

/// Serves XML-RPC.
pub(crate) fn serve_api(graph: &Arc<Graph>, stream: &TcpStream, _: &Cancel) -> Result<()> {
    serve_connection(stream, |method, params| slave::answer(graph, method, &params))
}

/// Serves TCPROS: a subscriber, or a client of a service.
pub(crate) fn serve_tcpros(graph: &Arc<Graph>, stream: &TcpStream, cancel: &Cancel) -> Result<()> {
    // A peer that never reads must not block the handshake.
    stream.set_write_timeout(Some(HANDSHAKE_TIME))?;
    let header = Header::read(&mut Timed::new(stream, HANDSHAKE_TIME))?;
    let unknown = |text: String| {
        Header::error(&text).write(stream)?;
        // Peers may request topics that a restarted node does not have yet; this is not reported.
        Err(Error::network(text))
    };
    if let Some(name) = header.get("service") {
        let service = lock(&graph.services).get(name).cloned();
        match service {
            Some(service) => service.serve(&graph.context, &header, stream),
            None => unknown(format!("{} offers no service {name:.200}", graph.context.names.node())),
        }
    } else if let Some(topic) = header.get("topic") {
        let publication = lock(&graph.publications).get(topic).cloned();
        match publication {
            Some(publication) => publication.serve(&graph.context, &header, stream, cancel),
            None => unknown(format!("{} does not publish {topic:.200}", graph.context.names.node())),
        }
    } else {
        Header::error("the header names neither a topic nor a service").write(stream)?;
        Err(Error::format("the TCPROS header names neither a topic nor a service"))
    }
}
