//! Connections to publishers.

use std::io::BufReader;
use std::net::TcpStream;
use std::sync::atomic::{AtomicBool, AtomicU64, Ordering};
use std::sync::{Arc, Mutex};
use std::time::Duration;

use opendr_engine::{Error, ErrorKind, Result};

use super::PublisherInfo;
use super::inbox::Inbox;
use crate::connection::{HANDSHAKE_TIME, Timed, connect};
use crate::context::Context;
use crate::http::HttpUri;
use crate::lock::lock;
use crate::master::{CALL_TIME, call_api};
use crate::tasks::Cancel;
use crate::tcpros::{Header, read_body, read_length};
use crate::types::agree;
use crate::{ParameterValue, TopicType};

/// First and maximum wait before a reconnection; the wait doubles each time.
const WAITS: [Duration; 2] = [Duration::from_millis(100), Duration::from_secs(5)];

/// Number of successive failures before an unreachable publisher is reported.
const PATIENCE: u32 = 4;

/// What the links of a subscription receive, and where the messages go.
pub(crate) struct Wanted {
    pub topic: String,
    pub kind: TopicType,
    pub tcp_nodelay: bool,
    pub inbox: Arc<Inbox>,
}

/// A connection to one publisher, renewed when it breaks, with its statistics for getBusStats and getBusInfo.
#[derive(Debug)]
pub(crate) struct Link {
    pub id: u32,
    /// URI of the publisher's XML-RPC server.
    pub uri: String,
    pub connected: AtomicBool,
    /// Whether a restarted master does not know the publisher; the connection is kept, but not renewed.
    pub orphaned: AtomicBool,
    /// Whether the thread of the link has ended.
    pub finished: AtomicBool,
    pub received_bytes: AtomicU64,
    pub received_messages: AtomicU64,
    /// Both ends of the connection, as text.
    pub ends: Mutex<String>,
    cancel: Mutex<Option<Arc<Cancel>>>,
}

impl Link {
    /// Starts the thread that connects to the publisher at `uri`.
    pub fn start(context: &Arc<Context>, wanted: &Arc<Wanted>, uri: &str) -> Result<Arc<Self>> {
        let link = Arc::new(Self {
            id: context.connection_id(),
            uri: uri.to_owned(),
            connected: AtomicBool::new(false),
            orphaned: AtomicBool::new(false),
            finished: AtomicBool::new(false),
            received_bytes: AtomicU64::new(0),
            received_messages: AtomicU64::new(0),
            ends: Mutex::default(),
            cancel: Mutex::default(),
        });
        let (this, context, wanted) = (Arc::clone(&link), Arc::clone(context), Arc::clone(wanted));
        let tasks = Arc::clone(&context.tasks);
        let cancel = tasks.spawn("subscriber", move |cancel| {
            this.run(&context, &wanted, cancel);
            this.finished.store(true, Ordering::Relaxed);
        })?;
        *lock(&link.cancel) = Some(cancel);
        Ok(link)
    }

    /// Ends the connection.
    pub fn cancel(&self) {
        if let Some(cancel) = &*lock(&self.cancel) {
            cancel.cancel();
        }
    }

    fn run(&self, context: &Context, wanted: &Wanted, cancel: &Cancel) {
        let (mut pause, mut failures, mut reported) = (WAITS[0], 0, String::new());
        while !cancel.is_cancelled() {
            let before = self.received_messages.load(Ordering::Relaxed);
            let ended = self.receive(context, wanted, cancel);
            self.connected.store(false, Ordering::Relaxed);
            cancel.release();
            if self.received_messages.load(Ordering::Relaxed) > before {
                (pause, failures, reported) = (WAITS[0], 0, String::new());
            }
            if let Err(error) = ended {
                // A disconnected publisher is not an error, but one that stays unreachable is reported once.
                failures += 1;
                let text = error.to_string();
                let serious = error.kind() != ErrorKind::Network || failures >= PATIENCE;
                if serious && text != reported && !cancel.is_cancelled() {
                    context.problem(error.context(format!("receiving {} from {}", wanted.topic, self.uri)));
                    reported = text;
                }
            }
            if self.orphaned.load(Ordering::Relaxed) || cancel.wait(pause) {
                return;
            }
            pause = (pause * 2).min(WAITS[1]);
        }
    }

    fn receive(&self, context: &Context, wanted: &Wanted, cancel: &Cancel) -> Result<()> {
        let stream = self.open(context, &wanted.topic)?;
        cancel.hold(&stream)?;
        let publisher = Arc::new(self.greet(context, wanted, &stream)?);
        stream.set_read_timeout(None)?;
        *lock(&self.ends) = ends(&stream);
        self.connected.store(true, Ordering::Relaxed);
        let mut reader = BufReader::with_capacity(64 << 10, &stream);
        let broken = |error| Error::network("the publisher disconnected").with_source(error);
        while let Some(length) = read_length(&mut reader).map_err(broken)? {
            if length as usize > context.max_message_bytes {
                return Err(Error::format(format!(
                    "a message has {length} bytes; at most {} are allowed (NodeOptions::max_message_bytes)",
                    context.max_message_bytes
                )));
            }
            let mut buffer = wanted.inbox.buffer(length as usize);
            read_body(&mut reader, length as usize, &mut buffer).map_err(broken)?;
            wanted.inbox.push(buffer, Arc::clone(&publisher));
            self.received_messages.fetch_add(1, Ordering::Relaxed);
            self.received_bytes.fetch_add(u64::from(length) + 4, Ordering::Relaxed);
        }
        Err(Error::network("the publisher closed the connection"))
    }

    /// Requests the publisher's TCPROS address and connects to it.
    fn open(&self, context: &Context, topic: &str) -> Result<TcpStream> {
        let uri = HttpUri::new(&self.uri)?;
        let protocols = ParameterValue::List(vec![ParameterValue::List(vec!["TCPROS".into()])]);
        let params = [topic.into(), protocols];
        let answer = call_api(&uri, context.names.node(), "requestTopic", &params, CALL_TIME)
            .map_err(|error| if error.kind() == ErrorKind::NotFound { not_yet(&error) } else { error })?;
        match answer.as_list().unwrap_or_default() {
            [
                ParameterValue::String(protocol),
                ParameterValue::String(host),
                ParameterValue::Int(port),
                ..,
            ] if protocol == "TCPROS" => {
                let port = u16::try_from(*port).map_err(|_| {
                    Error::format(format!("the publisher returned the invalid port {port} for TCPROS"))
                })?;
                connect(host, port, HANDSHAKE_TIME)
            }
            _ => Err(Error::unsupported("the publisher does not support TCPROS")),
        }
    }

    fn greet(&self, context: &Context, wanted: &Wanted, stream: &TcpStream) -> Result<PublisherInfo> {
        let kind = &wanted.kind;
        Header::new([
            ("callerid", context.names.node()),
            ("topic", &wanted.topic),
            ("type", &kind.name),
            ("md5sum", &kind.md5sum),
            ("message_definition", &kind.definition),
            ("tcp_nodelay", if wanted.tcp_nodelay { "1" } else { "0" }),
        ])
        .write(stream)?;
        let header = Header::read(&mut Timed::new(stream, HANDSHAKE_TIME))?;
        if let Some(error) = header.get("error") {
            return Err(Error::invalid_input(format!("the publisher refused the connection: {error:.500}")));
        }
        let (md5sum, type_name) = (header.need("md5sum")?, header.need("type")?);
        if !agree(md5sum, &kind.md5sum) || !agree(type_name, &kind.name) {
            return Err(Error::invalid_input(format!(
                "the publisher sends {type_name:.80} with md5 sum {md5sum:.40}, but this node expects {} \
                 with {}; build both against the same definition",
                kind.name, kind.md5sum
            )));
        }
        let field = |name| header.get(name).unwrap_or_default().to_owned();
        Ok(PublisherInfo {
            caller_id: field("callerid"),
            uri: self.uri.clone(),
            type_name: type_name.to_owned(),
            md5sum: md5sum.to_owned(),
            definition: field("message_definition"),
            latching: header.get("latching") == Some("1"),
        })
    }
}

/// Converts the error of a node that does not publish the topic yet, or no longer, so that it is retried without a report.
fn not_yet(error: &Error) -> Error {
    Error::network(error.to_string())
}

/// Returns both ends of a connection in the format of `rosnode info`.
pub(crate) fn ends(stream: &TcpStream) -> String {
    let port = stream.local_addr().map(|address| address.port()).unwrap_or_default();
    let peer = stream.peer_addr().map(|address| address.to_string()).unwrap_or_default();
    format!("TCPROS connection on port {port} to [{peer} on socket]")
}
