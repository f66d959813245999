//! Topics, services and watches of a node, shared by its handles and threads.

use std::collections::BTreeMap;
use std::sync::atomic::Ordering;
use std::sync::{Arc, Condvar, Mutex};
use std::time::{Duration, Instant};

use opendr_engine::{ErrorKind, Result};

use crate::ParameterValue;
use crate::context::Context;
use crate::lock::{lock, wait};
use crate::options::ShutdownHook;
use crate::parameter::Watch;
use crate::service::Service;
use crate::topic::{Publication, Subscribed};

/// Time limit of sending queued messages when the node ends.
const DRAIN_TIME: Duration = Duration::from_secs(1);

/// Topics, services and watches of a node on the ROS graph.
pub(crate) struct Graph {
    pub context: Arc<Context>,
    pub publications: Mutex<BTreeMap<String, Arc<Publication>>>,
    pub subscriptions: Mutex<Vec<Arc<Subscribed>>>,
    pub services: Mutex<BTreeMap<String, Arc<Service>>>,
    pub watches: Mutex<Vec<Arc<Watch>>>,
    on_shutdown: ShutdownHook,
    ended: Mutex<bool>,
    has_ended: Condvar,
}

impl Graph {
    /// Creates the state of a node without topics, services and watches.
    pub fn new(context: Context, on_shutdown: ShutdownHook) -> Self {
        Self {
            context: Arc::new(context),
            publications: Mutex::default(),
            subscriptions: Mutex::default(),
            services: Mutex::default(),
            watches: Mutex::default(),
            on_shutdown,
            ended: Mutex::new(false),
            has_ended: Condvar::new(),
        }
    }

    /// Repeats all registrations, for a restarted master.
    pub fn register_all(&self) {
        let publications: Vec<_> = lock(&self.publications).values().cloned().collect();
        let services: Vec<_> = lock(&self.services).values().cloned().collect();
        let watches: Vec<_> = lock(&self.watches).clone();
        let each = publications.iter().map(|publication| publication.register(&self.context));
        let each = each.chain(services.iter().map(|service| service.register(&self.context)));
        let each = each.chain(watches.iter().map(|watch| watch.register(&self.context).map(|_| ())));
        let errors = each.filter_map(Result::err).collect::<Vec<_>>();
        errors.into_iter().for_each(|error| self.context.problem(error));
        self.register_subscriptions();
    }

    /// Registers every subscription and connects to the publishers that the master returns.
    pub fn register_subscriptions(&self) {
        let subscriptions: Vec<_> = lock(&self.subscriptions).clone();
        for error in subscriptions.iter().filter_map(|subscribed| subscribed.register(true).err()) {
            self.context.problem(error);
        }
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
        if self.context.ending.swap(true, Ordering::AcqRel) {
            return;
        }
        self.unregister_all();
        let publications: Vec<_> = lock(&self.publications).values().cloned().collect();
        publications.iter().for_each(|publication| publication.close());
        lock(&self.subscriptions).iter().for_each(|subscribed| subscribed.close());
        self.context.tasks.stop(DRAIN_TIME);
        lock(&self.publications).clear();
        lock(&self.subscriptions).clear();
        lock(&self.services).clear();
        lock(&self.watches).clear();
        self.context.guarded("the hook for the node's end", || (self.on_shutdown)(reason));
        *lock(&self.ended) = true;
        self.has_ended.notify_all();
    }

    fn unregister_all(&self) {
        let api = || ParameterValue::from(self.context.api_uri.as_str());
        let mut calls = Vec::new();
        calls
            .extend(lock(&self.publications).keys().map(|name| ("unregisterPublisher", name.clone(), api())));
        let topics = lock(&self.subscriptions)
            .iter()
            .map(|subscribed| subscribed.wanted.topic.clone())
            .collect::<Vec<_>>();
        calls.extend(topics.into_iter().map(|name| ("unregisterSubscriber", name, api())));
        let service = ParameterValue::from(self.context.service_uri());
        calls.extend(
            lock(&self.services).keys().map(|name| ("unregisterService", name.clone(), service.clone())),
        );
        let keys = lock(&self.watches).iter().map(|watch| watch.key.clone()).collect::<Vec<_>>();
        for (method, name, address) in calls {
            let params = [name.into(), address];
            if let Err(error) = self.context.master.call_within(method, &params, Duration::from_secs(1))
                && error.kind() == ErrorKind::Network
            {
                return; // The master is gone, and with it what it knew.
            }
        }
        for key in keys {
            self.context
                .master
                .call_within("unsubscribeParam", &[api(), key.into()], Duration::from_secs(1))
                .ok();
        }
    }
}
