//! Lifecycle nodes, whose state a manager controls, such as that of Nav2 (`lifecycle_msgs`, states of
//! <https://design.ros2.org/articles/node_lifecycle.html>).

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError};

use opendr_engine::Result;
use opendr_messages::lifecycle_msgs::{
    ChangeStateRequest, ChangeStateResponse, GetAvailableStatesResponse, GetAvailableTransitionsResponse,
    GetStateResponse, State, Transition, TransitionDescription, TransitionEvent,
};
use opendr_messages::{
    LifecycleMsgsChangeState, LifecycleMsgsGetAvailableStates, LifecycleMsgsGetAvailableTransitions,
    LifecycleMsgsGetState, MessageType,
};

use super::typed_services::TypedServices;
use crate::clock::system_time_ns;
use crate::{Publisher, Qos};

/// A transition: id, label, start state and goal state.
type Row = (u8, &'static str, u8, u8);

const UNCONFIGURED: u8 = State::PRIMARY_STATE_UNCONFIGURED;
const INACTIVE: u8 = State::PRIMARY_STATE_INACTIVE;
const ACTIVE: u8 = State::PRIMARY_STATE_ACTIVE;
const FINALIZED: u8 = State::PRIMARY_STATE_FINALIZED;

const STATES: [(u8, &str); 4] =
    [(UNCONFIGURED, "unconfigured"), (INACTIVE, "inactive"), (ACTIVE, "active"), (FINALIZED, "finalized")];

const TRANSITIONS: [Row; 7] = [
    (Transition::TRANSITION_CONFIGURE, "configure", UNCONFIGURED, INACTIVE),
    (Transition::TRANSITION_CLEANUP, "cleanup", INACTIVE, UNCONFIGURED),
    (Transition::TRANSITION_ACTIVATE, "activate", INACTIVE, ACTIVE),
    (Transition::TRANSITION_DEACTIVATE, "deactivate", ACTIVE, INACTIVE),
    (Transition::TRANSITION_UNCONFIGURED_SHUTDOWN, "shutdown", UNCONFIGURED, FINALIZED),
    (Transition::TRANSITION_INACTIVE_SHUTDOWN, "shutdown", INACTIVE, FINALIZED),
    (Transition::TRANSITION_ACTIVE_SHUTDOWN, "shutdown", ACTIVE, FINALIZED),
];

/// State machine of a node.
struct Machine {
    state: Mutex<u8>,
    active: Arc<AtomicBool>,
    over: Arc<AtomicBool>,
    events: Arc<dyn Publisher>,
}

/// Serves the lifecycle of `node`, which starts unconfigured. Sets `active` in the active state and `over` after a shutdown.
pub(super) fn start(
    node: &mut impl TypedServices,
    active: Arc<AtomicBool>,
    over: Arc<AtomicBool>,
) -> Result<()> {
    active.store(false, Ordering::Relaxed);
    let events =
        node.advertise("~/transition_event", MessageType::LifecycleMsgsTransitionEvent, Qos::RESULT)?;
    let machine = Arc::new(Machine { state: Mutex::new(UNCONFIGURED), active, over, events });
    let own = machine.clone();
    node.serve_typed::<LifecycleMsgsChangeState>("~/change_state", move |request| ChangeStateResponse {
        success: own.change(&request),
    })?;
    let own = machine.clone();
    node.serve_typed::<LifecycleMsgsGetState>("~/get_state", move |_| GetStateResponse {
        current_state: state(own.now()),
    })?;
    node.serve_typed::<LifecycleMsgsGetAvailableStates>("~/get_available_states", move |_| {
        GetAvailableStatesResponse { available_states: STATES.iter().map(|(id, _)| state(*id)).collect() }
    })?;
    node.serve_typed::<LifecycleMsgsGetAvailableTransitions>("~/get_transition_graph", move |_| {
        GetAvailableTransitionsResponse { available_transitions: TRANSITIONS.iter().map(described).collect() }
    })?;
    node.serve_typed::<LifecycleMsgsGetAvailableTransitions>("~/get_available_transitions", move |_| {
        let now = machine.now();
        let available = TRANSITIONS.iter().filter(|(_, _, from, _)| *from == now);
        GetAvailableTransitionsResponse { available_transitions: available.map(described).collect() }
    })
}

impl Machine {
    fn now(&self) -> u8 {
        *self.state.lock().unwrap_or_else(PoisonError::into_inner)
    }

    /// Performs the requested transition, by label or id; returns whether the current state has it.
    fn change(&self, request: &ChangeStateRequest) -> bool {
        let asked = &request.transition;
        let mut now = self.state.lock().unwrap_or_else(PoisonError::into_inner);
        let way = TRANSITIONS.iter().find(|(id, label, from, _)| {
            *from == *now && if asked.label.is_empty() { asked.id == *id } else { asked.label == *label }
        });
        let Some((id, label, from, to)) = way else { return false };
        *now = *to;
        self.active.store(*to == ACTIVE, Ordering::Relaxed);
        self.over.store(*to == FINALIZED, Ordering::Relaxed);
        let event = TransitionEvent {
            timestamp: u64::try_from(system_time_ns()).unwrap_or(0),
            transition: Transition { id: *id, label: (*label).to_owned() },
            start_state: state(*from),
            goal_state: state(*to),
        };
        // Subscribers that miss the event can query the state.
        let _ = self.events.publish(event.into());
        true
    }
}

fn state(id: u8) -> State {
    let label = STATES.iter().find(|(known, _)| *known == id).map_or("unknown", |(_, label)| label);
    State { id, label: label.to_owned() }
}

fn described((id, label, from, to): &Row) -> TransitionDescription {
    TransitionDescription {
        transition: Transition { id: *id, label: (*label).to_owned() },
        start_state: state(*from),
        goal_state: state(*to),
    }
}
