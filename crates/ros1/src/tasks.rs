//! Threads of a node and their cancellation.

use std::cell::Cell;
use std::collections::HashMap;
use std::net::{Shutdown, SocketAddr, TcpStream};
use std::sync::{Arc, Condvar, Mutex};
use std::thread;
use std::time::{Duration, Instant};

use opendr_engine::{Error, Result};

use crate::lock::{lock, wait};

thread_local! {
    /// Whether this is a thread of a node, which must not wait for the node's threads.
    static INSIDE: Cell<bool> = const { Cell::new(false) };
}

/// Cancellation of one thread.
#[derive(Debug, Default)]
pub(crate) struct Cancel {
    state: Mutex<CancelState>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct CancelState {
    asked: bool,
    drains: bool,
    socket: Option<TcpStream>,
}

impl Cancel {
    /// Cancels the thread and closes the connection on which it waits.
    pub fn cancel(&self) {
        let drains = lock(&self.state).drains;
        if drains {
            lock(&self.state).asked = true
        } else {
            self.abort()
        }
        self.changed.notify_all();
    }

    fn abort(&self) {
        let mut state = lock(&self.state);
        state.asked = true;
        if let Some(socket) = &state.socket {
            socket.shutdown(Shutdown::Both).ok();
        }
        self.changed.notify_all();
    }

    pub fn is_cancelled(&self) -> bool {
        lock(&self.state).asked
    }

    /// Waits for `time` or until the cancellation; returns whether the thread is cancelled.
    pub fn wait(&self, time: Duration) -> bool {
        let until = Instant::now() + time;
        let mut state = lock(&self.state);
        while !state.asked {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return false;
            }
            state = wait(&self.changed, state, left);
        }
        true
    }

    /// Closes `stream` at the cancellation.
    ///
    /// # Errors
    /// `Network` when the thread is already cancelled.
    pub fn hold(&self, stream: &TcpStream) -> Result<()> {
        let mut state = lock(&self.state);
        if state.asked {
            return Err(Error::network("the node is shutting down"));
        }
        state.socket = Some(stream.try_clone()?);
        Ok(())
    }

    /// Releases the connection.
    pub fn release(&self) {
        lock(&self.state).socket = None;
    }

    /// Lets the thread send its remaining data after the cancellation before it ends by itself.
    pub fn drain(&self) {
        lock(&self.state).drains = true;
    }
}

/// Threads of a node.
#[derive(Debug, Default)]
pub(crate) struct Tasks {
    state: Mutex<State>,
    changed: Condvar,
}

#[derive(Debug, Default)]
struct State {
    stopped: bool,
    next: u64,
    running: HashMap<u64, Arc<Cancel>>,
    listeners: Vec<SocketAddr>,
}

struct Running<'a>(&'a Tasks, u64);

impl Drop for Running<'_> {
    fn drop(&mut self) {
        lock(&self.0.state).running.remove(&self.1);
        self.0.changed.notify_all();
    }
}

impl Tasks {
    /// Runs `work` on a thread of its own.
    ///
    /// # Errors
    /// `Network` after the shutdown of the node, `Io` when the system has no more threads.
    pub fn spawn(
        self: &Arc<Self>,
        name: &str,
        work: impl FnOnce(&Arc<Cancel>) + Send + 'static,
    ) -> Result<Arc<Cancel>> {
        let cancel = Arc::new(Cancel::default());
        let id = {
            let mut state = lock(&self.state);
            if state.stopped {
                return Err(Error::network("the node was shut down; create a new one"));
            }
            state.next += 1;
            let id = state.next;
            state.running.insert(id, Arc::clone(&cancel));
            id
        };
        let (tasks, asked) = (Arc::clone(self), Arc::clone(&cancel));
        let started = thread::Builder::new().name(format!("ros1 {name}")).spawn(move || {
            let _running = Running(&tasks, id);
            INSIDE.set(true);
            work(&asked);
        });
        if let Err(error) = started {
            lock(&self.state).running.remove(&id);
            return Err(Error::from(error).context("starting a thread of the ROS node"));
        }
        Ok(cancel)
    }

    /// Records that a thread listens at `address`.
    pub fn listens(&self, address: SocketAddr) {
        lock(&self.state).listeners.push(address);
    }

    /// Cancels all threads and waits for them: `grace` for those that still send, and a second more for the others.
    pub fn stop(&self, grace: Duration) {
        let (running, listeners) = {
            let mut state = lock(&self.state);
            state.stopped = true;
            (state.running.values().cloned().collect::<Vec<_>>(), std::mem::take(&mut state.listeners))
        };
        running.iter().for_each(|cancel| cancel.cancel());
        for address in listeners {
            // The connection wakes the listening thread.
            TcpStream::connect_timeout(&address, Duration::from_millis(200)).ok();
        }
        if INSIDE.get() {
            return;
        }
        self.wait_for_all(grace);
        lock(&self.state).running.values().for_each(|cancel| cancel.abort());
        self.wait_for_all(Duration::from_secs(1));
    }

    fn wait_for_all(&self, time: Duration) {
        let until = Instant::now() + time;
        let mut state = lock(&self.state);
        while !state.running.is_empty() {
            let left = until.saturating_duration_since(Instant::now());
            if left.is_zero() {
                return;
            }
            state = wait(&self.changed, state, left);
        }
    }
}
