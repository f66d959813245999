//! A node.

use std::fmt;
use std::net::TcpListener;
use std::sync::atomic::{AtomicBool, AtomicU32};
use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use opendr_engine::{Error, ErrorKind, Result, ResultExt};

use crate::graph::Graph;
use crate::host::{bind_address, host};
use crate::http::{HttpUri, host_in_uri};
use crate::master::Master;
use crate::name::Names;
use crate::service::probe;
use crate::tasks::Tasks;
use crate::{
    NodeOptions, Publisher, PublisherOptions, ServiceClient, ServiceServer, ServiceType, SubscriberOptions,
    Subscription, TopicType, incoming, master_watch,
};

/// A node of the ROS graph, until it goes: then everything is unregistered, and every connection and thread
/// ended.
///
/// Its handles (publishers, subscriptions, services) may outlive it, but do nothing any more.
pub struct Node {
    pub(crate) graph: Arc<Graph>,
}

impl Node {
    /// A node as `options` and ROS's environment variables have it.
    ///
    /// # Errors
    /// `InvalidParam` for a name or address that is not valid, `Network` when the master does not answer,
    /// `Io` when no port can be listened on.
    pub fn new(options: NodeOptions) -> Result<Self> {
        let from_environment = |key| std::env::var(key).ok().filter(|value| !value.is_empty());
        let uri = options.master_uri.or_else(|| from_environment("ROS_MASTER_URI"));
        let uri =
            HttpUri::new(uri.as_deref().unwrap_or("http://localhost:11311")).context(|| "ROS_MASTER_URI")?;
        let namespace = options.namespace.or_else(|| from_environment("ROS_NAMESPACE")).unwrap_or_default();
        let name = if options.anonymous { anonymous(&options.name) } else { options.name };
        let names = Names::new(&name, &namespace, &options.remappings)?;
        let host = host(options.host.as_deref(), &uri);
        let listen = || TcpListener::bind((bind_address(&host), 0)).context(|| "listening for ROS nodes");
        let (api, tcp) = (listen()?, listen()?);
        let api_uri = format!("http://{}:{}/", host_in_uri(&host), api.local_addr()?.port());
        let master = Master::new(uri, names.node());
        wait_for_master(&master, options.wait_for_master)?;
        let graph = Arc::new(Graph {
            names,
            master,
            api_uri,
            tcp_port: tcp.local_addr()?.port(),
            host,
            max_message_bytes: options.max_message_bytes,
            tasks: Arc::new(Tasks::default()),
            publications: Mutex::default(),
            subscriptions: Mutex::default(),
            services: Mutex::default(),
            watches: Mutex::default(),
            unregistered: AtomicBool::new(false),
            on_problem: options.on_problem,
            on_shutdown: options.on_shutdown,
            next_id: AtomicU32::new(1),
            ending: AtomicBool::new(false),
            ended: Mutex::new(false),
            has_ended: Condvar::new(),
        });
        // From here on a failure ends the threads that run already.
        let node = Self { graph };
        incoming::start(&node.graph, api, incoming::serve_api)?;
        incoming::start(&node.graph, tcp, incoming::serve_tcpros)?;
        master_watch::start(&node.graph)?;
        for (key, value) in options.parameters {
            node.set_parameter(&key, value)?;
        }
        Ok(node)
    }

    /// The node's full name.
    pub fn name(&self) -> &str {
        self.graph.names.node()
    }

    /// The address of the node's own XML-RPC server.
    pub fn uri(&self) -> &str {
        &self.graph.api_uri
    }

    /// The full name that `name` stands for in this node, remapped.
    ///
    /// # Errors
    /// `InvalidParam` for a name that is not valid.
    pub fn resolve(&self, name: &str) -> Result<String> {
        self.graph.names.resolve(name)
    }

    /// Publishes `topic`. Asked again with the same type it shares the connections.
    ///
    /// # Errors
    /// `InvalidParam` for names or types that are not valid or clash, `Network` once the node is shut down. A
    /// master that does not answer is told as a problem, and told of the topic once it is back.
    pub fn advertise(&self, topic: &str, kind: TopicType, options: PublisherOptions) -> Result<Publisher> {
        Publisher::new(&self.graph, &self.resolve(topic)?, kind, options)
    }

    /// Subscribes to `topic`. Each subscription has connections of its own.
    ///
    /// # Errors
    /// As [`Node::advertise`].
    pub fn subscribe(
        &self,
        topic: &str,
        kind: TopicType,
        options: SubscriberOptions,
    ) -> Result<Subscription> {
        Subscription::new(&self.graph, &self.resolve(topic)?, kind, options)
    }

    /// Offers `service`. `handler` gets a request and gives the response, or the text of an error; it is
    /// called from a thread for each client.
    ///
    /// # Errors
    /// As [`Node::advertise`].
    pub fn serve(
        &self,
        service: &str,
        kind: ServiceType,
        handler: impl Fn(&[u8]) -> Result<Vec<u8>, String> + Send + Sync + 'static,
    ) -> Result<ServiceServer> {
        ServiceServer::new(&self.graph, &self.resolve(service)?, kind, Box::new(handler))
    }

    /// Calls `service` once, within a minute; [`Node::client`] is for many calls.
    ///
    /// # Errors
    /// As [`ServiceClient::call`].
    pub fn call(&self, service: &str, kind: ServiceType, request: &[u8]) -> Result<Vec<u8>> {
        self.client(service, kind)?.call_once(request)
    }

    /// A client of `service`, which need not be there yet.
    ///
    /// # Errors
    /// `InvalidParam` for a name that is not valid.
    pub fn client(&self, service: &str, kind: ServiceType) -> Result<ServiceClient> {
        Ok(ServiceClient::new(&self.graph, self.resolve(service)?, kind))
    }

    /// Waits until `service` answers.
    ///
    /// # Errors
    /// What was wrong last, when it does not within `time`.
    pub fn wait_for_service(&self, service: &str, time: Duration) -> Result<()> {
        let name = self.resolve(service)?;
        retry(time, || probe(&self.graph, &name)).context(|| format!("waiting for service {name}"))
    }

    /// Topics that are published now, with their types.
    ///
    /// # Errors
    /// `Network` without a master.
    pub fn published_topics(&self) -> Result<Vec<(String, String)>> {
        let answer = self.graph.master.call("getPublishedTopics", &["".into()])?;
        let pair = |value: &crate::ParameterValue| match value.as_list()? {
            [topic, kind] => Some((topic.as_str()?.to_owned(), kind.as_str()?.to_owned())),
            _ => None,
        };
        let pairs = answer.as_list().and_then(|list| list.iter().map(pair).collect());
        pairs.ok_or_else(|| Error::format("getPublishedTopics of the master answered no pairs of texts"))
    }

    /// Whether the node was shut down, or is about to be: by `rosnode kill`, or by another node of its name.
    pub fn is_shut_down(&self) -> bool {
        self.graph.is_ended()
    }

    /// Waits until the node was shut down.
    pub fn wait(&self) {
        self.graph.wait_for_end(None);
    }

    /// Waits until the node was shut down, `time` at most; tells whether it was.
    pub fn wait_timeout(&self, time: Duration) -> bool {
        self.graph.wait_for_end(Some(time))
    }

    /// Unregisters everything and ends every connection and thread; so does dropping the node.
    pub fn shut_down(&self, reason: &str) {
        self.graph.shut_down(reason);
    }
}

impl Drop for Node {
    fn drop(&mut self) {
        self.graph.shut_down("the node was dropped");
    }
}

impl fmt::Debug for Node {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Node").field("name", &self.name()).field("uri", &self.uri()).finish_non_exhaustive()
    }
}

fn anonymous(name: &str) -> String {
    let time = SystemTime::now().duration_since(UNIX_EPOCH).unwrap_or_default();
    format!("{name}_{}_{}", std::process::id(), time.as_millis())
}

fn wait_for_master(master: &Master, time: Duration) -> Result<()> {
    match retry(time, || master.call("getPid", &[]).map(|_| ())) {
        Err(error) if error.kind() != ErrorKind::Network => {
            Err(error.context(format!("{} is no ROS master", master.uri)))
        }
        outcome => outcome,
    }
}

/// Tries until it works or `time` is over.
fn retry(time: Duration, attempt: impl Fn() -> Result<()>) -> Result<()> {
    let started = Instant::now();
    loop {
        match attempt() {
            Err(_) if started.elapsed() < time => std::thread::sleep(Duration::from_millis(100)),
            outcome => return outcome,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Listener, ParameterWatch};

    #[test]
    fn handles_go_between_threads() {
        fn check<T: Send + Sync>() {}
        check::<Node>();
        check::<(Publisher, Subscription, Listener)>();
        check::<(ServiceServer, ServiceClient, ParameterWatch)>();
    }

    #[test]
    fn a_node_without_a_master_says_what_to_do() {
        // Port 1 has no listener.
        let mut options = NodeOptions::new("lonely");
        (options.master_uri, options.host) =
            (Some("http://127.0.0.1:1".to_owned()), Some("127.0.0.1".to_owned()));
        let error = Node::new(options.clone()).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Network);
        assert!(error.to_string().contains("start roscore"), "{error}");
        options.master_uri = Some("localhost".to_owned());
        assert_eq!(Node::new(options.clone()).unwrap_err().kind(), ErrorKind::InvalidParam);
        options.name = "a/b".to_owned();
        assert!(Node::new(options).is_err());
    }
}
