//! State of a node, shared by its handles and threads.

use std::collections::BTreeMap;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::sync::atomic::{AtomicBool, AtomicU32, Ordering};
use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, Instant};

use opendr_engine::{Error, ErrorKind, Result};

use crate::ParameterValue;
use crate::lock::{lock, wait};
use crate::master::Master;
use crate::name::Names;
use crate::options::{ProblemHook, ShutdownHook};
use crate::parameter::Watch;
use crate::service::Service;
use crate::tasks::Tasks;
use crate::topic::{Publication, Subscribed};

/// Time limit of sending queued messages when the node ends.
const DRAIN_TIME: Duration = Duration::from_secs(1);

/// State of a node on the ROS graph.
pub(crate) struct Graph {
    pub names: Names,
    pub master: Master,
    /// Name or address of this machine for other nodes.
    pub host: String,
    /// URI of the node's XML-RPC server.
    pub api_uri: String,
    pub tcp_port: u16,
    pub max_message_bytes: usize,
    pub tasks: Arc<Tasks>,
    pub publications: Mutex<BTreeMap<String, Arc<Publication>>>,
    pub subscriptions: Mutex<Vec<Arc<Subscribed>>>,
    pub services: Mutex<BTreeMap<String, Arc<Service>>>,
    pub watches: Mutex<Vec<Arc<Watch>>>,
    /// Whether the master may lack a registration of this node.
    pub unregistered: AtomicBool,
    pub on_problem: ProblemHook,
    pub on_shutdown: ShutdownHook,
    pub next_id: AtomicU32,
    pub ending: AtomicBool,
    pub ended: Mutex<bool>,
    pub has_ended: Condvar,
}

impl Graph {
    /// Reports an error to the owner's hook.
    pub fn problem(&self, error: Error) {
        // A panic of the hook must not end the calling thread.
        catch_unwind(AssertUnwindSafe(|| (self.on_problem)(error))).ok();
    }

    /// Runs the owner's code; a panic in it is reported and does not end the thread.
    pub fn guarded<T>(&self, what: &str, code: impl FnOnce() -> T) -> Option<T> {
        let done = catch_unwind(AssertUnwindSafe(code));
        if done.is_err() {
            self.problem(Error::internal(format!("{what} panicked; its message is on standard error")));
        }
        done.ok()
    }

    /// Returns a new id of a connection.
    pub fn connection_id(&self) -> u32 {
        self.next_id.fetch_add(1, Ordering::Relaxed)
    }

    /// Registers with the master. If the master does not respond, the error is reported and the registration repeated later.
    ///
    /// # Errors
    /// The error of a master that refuses.
    pub fn register(&self, method: &str, params: &[ParameterValue]) -> Result<Option<ParameterValue>> {
        match self.master.call(method, params) {
            Ok(value) => Ok(Some(value)),
            Err(error) if error.kind() == ErrorKind::Network => {
                self.unregistered.store(true, Ordering::Release);
                self.problem(error);
                Ok(None)
            }
            Err(error) => Err(error),
        }
    }

    /// Unregisters with the master; errors of a master that is gone are ignored.
    pub fn unregister(&self, method: &str, params: &[ParameterValue]) {
        if !self.is_ended() {
            self.master.call_within(method, params, Duration::from_secs(2)).ok();
        }
    }

    /// Repeats all registrations, for a restarted master.
    pub fn register_all(&self) {
        let publications: Vec<_> = lock(&self.publications).values().cloned().collect();
        let services: Vec<_> = lock(&self.services).values().cloned().collect();
        let watches: Vec<_> = lock(&self.watches).clone();
        let each = publications.iter().map(|publication| publication.register(self));
        let each = each.chain(services.iter().map(|service| service.register(self)));
        let each = each.chain(watches.iter().map(|watch| watch.register(self).map(|_| ())));
        let errors = each.filter_map(Result::err).collect::<Vec<_>>();
        errors.into_iter().for_each(|error| self.problem(error));
        self.register_subscriptions();
    }

    /// Registers every subscription and connects to the publishers that the master returns.
    pub fn register_subscriptions(&self) {
        let subscriptions: Vec<_> = lock(&self.subscriptions).clone();
        for error in subscriptions.iter().filter_map(|subscribed| subscribed.register(true).err()) {
            self.problem(error);
        }
    }

    /// Returns whether the node is shutting down or has ended.
    pub fn is_ended(&self) -> bool {
        self.ending.load(Ordering::Acquire)
    }

    /// Waits for the shutdown of the node, for at most `time`; returns whether it happened.
    pub fn wait_for_end(&self, time: Option<Duration>) -> bool {
        let until = time.and_then(|time| Instant::now().checked_add(time));
        let mut ended = lock(&self.ended);
        while !*ended {
            let left = match until {
                Some(until) => until.saturating_duration_since(Instant::now()),
                None => Duration::from_secs(3600),
            };
            if left.is_zero() {
                return false;
            }
            ended = wait(&self.has_ended, ended, left);
        }
        true
    }

    /// Unregisters everything and ends every thread.
    pub fn shut_down(&self, reason: &str) {
        if self.ending.swap(true, Ordering::AcqRel) {
            return;
        }
        self.unregister_all();
        let publications: Vec<_> = lock(&self.publications).values().cloned().collect();
        publications.iter().for_each(|publication| publication.close());
        lock(&self.subscriptions).iter().for_each(|subscribed| subscribed.close());
        self.tasks.stop(DRAIN_TIME);
        lock(&self.publications).clear();
        lock(&self.subscriptions).clear();
        lock(&self.services).clear();
        lock(&self.watches).clear();
        self.guarded("the hook for the node's end", || (self.on_shutdown)(reason));
        *lock(&self.ended) = true;
        self.has_ended.notify_all();
    }

    fn unregister_all(&self) {
        let api = || ParameterValue::from(self.api_uri.as_str());
        let mut calls = Vec::new();
        calls
            .extend(lock(&self.publications).keys().map(|name| ("unregisterPublisher", name.clone(), api())));
        let topics =
            lock(&self.subscriptions).iter().map(|subscribed| subscribed.topic.clone()).collect::<Vec<_>>();
        calls.extend(topics.into_iter().map(|name| ("unregisterSubscriber", name, api())));
        let service = ParameterValue::from(self.service_uri());
        calls.extend(
            lock(&self.services).keys().map(|name| ("unregisterService", name.clone(), service.clone())),
        );
        let keys = lock(&self.watches).iter().map(|watch| watch.key.clone()).collect::<Vec<_>>();
        for (method, name, address) in calls {
            let params = [name.into(), address];
            if let Err(error) = self.master.call_within(method, &params, Duration::from_secs(1))
                && error.kind() == ErrorKind::Network
            {
                return; // The master is gone, and with it what it knew.
            }
        }
        for key in keys {
            self.master.call_within("unsubscribeParam", &[api(), key.into()], Duration::from_secs(1)).ok();
        }
    }

    /// Returns the URI of the node's services.
    pub fn service_uri(&self) -> String {
        format!("rosrpc://{}:{}", crate::http::host_in_uri(&self.host), self.tcp_port)
    }
}
