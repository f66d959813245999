//! Connections that others make to the node.

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

/// Connections at a time, of each kind; more are closed at once.
const MOST_CONNECTIONS: usize = 128;

/// What is done with a connection, on a thread of its own.
type Serve = fn(&Arc<Graph>, &TcpStream, &Cancel) -> Result<()>;

/// Serves every connection to `listener`.
pub(crate) fn start(graph: &Arc<Graph>, listener: TcpListener, serve: Serve) -> Result<()> {
    let mut address = listener.local_addr()?;
    if address.ip().is_unspecified() {
        // Where a connection of our own reaches it.
        address.set_ip(if address.is_ipv4() {
            [127, 0, 0, 1].into()
        } else {
            std::net::Ipv6Addr::LOCALHOST.into()
        });
    }
    graph.tasks.listens(address);
    let graph = Arc::clone(graph);
    let tasks = Arc::clone(&graph.tasks);
    tasks.spawn("accept", move |cancel| accept(&graph, &listener, serve, cancel))?;
    Ok(())
}

fn accept(graph: &Arc<Graph>, listener: &TcpListener, serve: Serve, cancel: &Cancel) {
    let open = Arc::new(AtomicUsize::new(0));
    while !cancel.is_asked() {
        let Ok((stream, _)) = listener.accept() else {
            // Out of file descriptors, most likely: they may come back.
            cancel.wait(Duration::from_millis(100));
            continue;
        };
        if cancel.is_asked() {
            return;
        }
        if open.fetch_add(1, Ordering::AcqRel) >= MOST_CONNECTIONS {
            open.fetch_sub(1, Ordering::AcqRel);
            graph.problem(Error::unsupported(format!(
                "more than {MOST_CONNECTIONS} connections at a time; one was closed"
            )));
            continue;
        }
        let (served, count) = (Arc::clone(graph), Counted(Arc::clone(&open)));
        let started = graph.tasks.spawn("connection", move |cancel| {
            let _count = count;
            stream.set_nodelay(true).ok();
            keep_alive(&stream);
            let ended = cancel.hold(&stream).and_then(|()| serve(&served, &stream, cancel));
            tell(&served, &stream, cancel, ended);
        });
        if let Err(error) = started
            && !cancel.is_asked()
        {
            graph.problem(error);
        }
    }
}

/// One connection of those that are open.
struct Counted(Arc<AtomicUsize>);

impl Drop for Counted {
    fn drop(&mut self) {
        self.0.fetch_sub(1, Ordering::AcqRel);
    }
}

/// A peer that leaves is no problem, one that talks nonsense is.
fn tell(graph: &Graph, stream: &TcpStream, cancel: &Cancel, ended: Result<()>) {
    if let Err(error) = ended
        && !matches!(error.kind(), ErrorKind::Network | ErrorKind::Io)
        && !cancel.is_asked()
    {
        let peer = stream.peer_addr().map(|address| address.to_string());
        graph.problem(error.context(format!("serving {}", peer.as_deref().unwrap_or("a peer"))));
    }
}

/// XML-RPC.
pub(crate) fn serve_api(graph: &Arc<Graph>, stream: &TcpStream, _: &Cancel) -> Result<()> {
    serve_connection(stream, |method, params| slave::answer(graph, method, &params))
}

/// TCPROS: a subscriber, or a client of a service.
pub(crate) fn serve_tcpros(graph: &Arc<Graph>, stream: &TcpStream, cancel: &Cancel) -> Result<()> {
    // Somebody who never reads must not hold a handshake either.
    stream.set_write_timeout(Some(HANDSHAKE_TIME))?;
    let header = Header::read(&mut Timed::new(stream, HANDSHAKE_TIME))?;
    let unknown = |text: String| {
        Header::error(&text).write(stream)?;
        // Restarted nodes are asked for what they do not have yet: no problem of this node.
        Err(Error::network(text))
    };
    if let Some(name) = header.get("service") {
        let service = lock(&graph.services).get(name).cloned();
        match service {
            Some(service) => service.serve(graph, &header, stream),
            None => unknown(format!("{} offers no service {name:.200}", graph.names.node())),
        }
    } else if let Some(topic) = header.get("topic") {
        let publication = lock(&graph.publications).get(topic).cloned();
        match publication {
            Some(publication) => publication.serve(graph, &header, stream, cancel),
            None => unknown(format!("{} does not publish {topic:.200}", graph.names.node())),
        }
    } else {
        Header::error("the header names neither a topic nor a service").write(stream)?;
        Err(Error::format("a TCPROS header that names neither a topic nor a service"))
    }
}
