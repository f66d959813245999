//! ROS 1 nodes.

use std::fmt;
use std::net::TcpListener;
use std::sync::Arc;
use std::sync::atomic::{AtomicBool, AtomicU32};
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use opendr_engine::{Error, ErrorKind, Result, ResultExt};

use crate::context::Context;
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

/// A node of the ROS graph. Dropping it unregisters everything and ends every connection and thread.
///
/// Its handles (publishers, subscriptions, services) may outlive it, but have no effect then.
pub struct Node {
    pub(crate) graph: Arc<Graph>,
}

impl Node {
    /// Creates a node with `options` and ROS's environment variables.
    ///
    /// # Errors
    /// `InvalidParam` for an invalid name or address, `Network` when the master does not respond, `Io` when no port is available.
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
        let context = Context {
            names,
            master,
            api_uri,
            tcp_port: tcp.local_addr()?.port(),
            host,
            max_message_bytes: options.max_message_bytes,
            tasks: Arc::new(Tasks::default()),
            unregistered: AtomicBool::new(false),
            on_problem: options.on_problem,
            next_id: AtomicU32::new(1),
            ending: AtomicBool::new(false),
        };
        let graph = Arc::new(Graph::new(context, options.on_shutdown));
        // From here on, an error drops the node and ends its threads.
        let node = Self { graph };
        incoming::start(&node.graph, api, incoming::serve_api)?;
        incoming::start(&node.graph, tcp, incoming::serve_tcpros)?;
        master_watch::start(&node.graph)?;
        for (key, value) in options.parameters {
            node.set_parameter(&key, value)?;
        }
        Ok(node)
    }

    /// Returns the node's full name.
    pub fn name(&self) -> &str {
        self.graph.context.names.node()
    }

    /// Returns the URI of the node's XML-RPC server.
    pub fn uri(&self) -> &str {
        &self.graph.context.api_uri
    }

    /// Resolves `name` to its full name in this node, after remapping.
    ///
    /// # Errors
    /// `InvalidParam` for an invalid name.
    pub fn resolve(&self, name: &str) -> Result<String> {
        self.graph.context.names.resolve(name)
    }

    /// Advertises `topic`. Several publishers of one topic and type share the connections.
    ///
    /// # Errors
    /// `InvalidParam` for invalid or conflicting names or types, `Network` after the shutdown of the node. A master that does not
    /// respond is reported to the hook, and the registration is repeated later.
    pub fn advertise(&self, topic: &str, kind: TopicType, options: PublisherOptions) -> Result<Publisher> {
        Publisher::new(&self.graph, &self.resolve(topic)?, kind, options)
    }

    /// Subscribes to `topic`. Each subscription has its own connections.
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

    /// Offers `service`. `handler` receives a request and returns the response, or the text of an error; it is called on one thread
    /// per client.
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

    /// Calls `service` once, with a time limit of a minute; use [`Node::client`] for many calls.
    ///
    /// # Errors
    /// As [`ServiceClient::call`].
    pub fn call(&self, service: &str, kind: ServiceType, request: &[u8]) -> Result<Vec<u8>> {
        self.client(service, kind)?.call_once(request)
    }

    /// Returns a client of `service`, which need not exist yet.
    ///
    /// # Errors
    /// `InvalidParam` for an invalid name.
    pub fn client(&self, service: &str, kind: ServiceType) -> Result<ServiceClient> {
        Ok(ServiceClient::new(&self.graph.context, self.resolve(service)?, kind))
    }

    /// Waits until `service` responds.
    ///
    /// # Errors
    /// The last error, if it does not respond within `time`.
    pub fn wait_for_service(&self, service: &str, time: Duration) -> Result<()> {
        let name = self.resolve(service)?;
        retry(time, || probe(&self.graph.context, &name)).context(|| format!("waiting for service {name}"))
    }

    /// Returns the currently published topics with their types.
    ///
    /// # Errors
    /// `Network` without a master.
    pub fn published_topics(&self) -> Result<Vec<(String, String)>> {
        let answer = self.graph.context.master.call("getPublishedTopics", &["".into()])?;
        let pair = |value: &crate::ParameterValue| match value.as_list()? {
            [topic, kind] => Some((topic.as_str()?.to_owned(), kind.as_str()?.to_owned())),
            _ => None,
        };
        let pairs = answer.as_list().and_then(|list| list.iter().map(pair).collect());
        pairs.ok_or_else(|| Error::format("getPublishedTopics of the master did not return pairs of strings"))
    }

    /// Returns whether the node has been shut down, or is shutting down: by its owner, `rosnode kill`, or another node of its name.
    pub fn is_shut_down(&self) -> bool {
        self.graph.context.is_ended()
    }

    /// Waits for the shutdown of the node.
    pub fn wait(&self) {
        self.graph.wait_for_end(None);
    }

    /// Waits for the shutdown of the node, for at most `time`; returns whether it happened.
    pub fn wait_timeout(&self, time: Duration) -> bool {
        self.graph.wait_for_end(Some(time))
    }

    /// Unregisters everything and ends every connection and thread, as dropping the node does.
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
            Err(error.context(format!("{} is not a ROS master", master.uri)))
        }
        outcome => outcome,
    }
}

/// Repeats `attempt` until it succeeds or `time` is over.
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
    fn a_missing_master_is_reported() {
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
