//! XML-RPC API of a node for other nodes and ROS's tools.
//!
//! Source: <https://wiki.ros.org/ROS/Slave_API>.

use std::sync::Arc;
use std::sync::atomic::Ordering;
use std::thread;

use crate::ParameterValue;
use crate::graph::Graph;
use crate::lock::lock;
use crate::parameter::notify;
use crate::topic::{Subscribed, uris};
use crate::xml_rpc::Fault;

/// Returns the response to `method` with `params`: `[1, text, value]`, or `[0 or -1, error, 0]`.
///
/// # Errors
/// A fault for an unknown method.
pub(crate) fn answer(
    graph: &Arc<Graph>,
    method: &str,
    params: &[ParameterValue],
) -> Result<ParameterValue, Fault> {
    let text = |at: usize| params.get(at).and_then(ParameterValue::as_str).unwrap_or_default();
    let value = match method {
        "getBusStats" => Ok(bus_stats(graph)),
        "getBusInfo" => Ok(bus_info(graph)),
        "getMasterUri" => Ok(graph.context.master.uri.to_string().into()),
        "getName" => Ok(graph.context.names.node().into()),
        "getPid" => Ok(i32::try_from(std::process::id()).unwrap_or(0).into()),
        "getSubscriptions" => Ok(subscriptions(graph)),
        "getPublications" => Ok(publications(graph)),
        "shutdown" => shutdown(graph, text(0), text(1)),
        "paramUpdate" => param_update(graph, text(1), params.get(2)),
        "publisherUpdate" => publisher_update(graph, text(1), params.get(2)),
        "requestTopic" => request_topic(graph, text(1), params.get(2)),
        _ => return Err(Fault { code: 1, text: format!("a ROS node has no method {method:.80?}") }),
    };
    let answer: [ParameterValue; 3] = match value {
        Ok(value) => [1.into(), method.into(), value],
        Err((code, text)) => [code.into(), text.into(), 0.into()],
    };
    Ok(ParameterValue::List(answer.into()))
}

type Answer = Result<ParameterValue, (i32, String)>;

fn list(values: impl IntoIterator<Item = ParameterValue>) -> ParameterValue {
    ParameterValue::List(values.into_iter().collect())
}

/// Converts a count to XML-RPC's 32 bits, saturating.
fn count(value: u64) -> ParameterValue {
    ParameterValue::Int(i32::try_from(value).unwrap_or(i32::MAX))
}

fn all_subscribed(graph: &Graph) -> Vec<Arc<Subscribed>> {
    lock(&graph.subscriptions).clone()
}

fn bus_stats(graph: &Graph) -> ParameterValue {
    let published = lock(&graph.publications).values().cloned().collect::<Vec<_>>();
    let published = published.iter().map(|publication| {
        let outboxes = publication.outboxes();
        let sent = |outbox: &crate::topic::Outbox| outbox.sent_bytes.load(Ordering::Relaxed);
        let all = outboxes.iter().map(|outbox| sent(outbox)).sum();
        let each = outboxes.iter().map(|outbox| {
            let messages = count(outbox.sent_messages.load(Ordering::Relaxed));
            list([count(outbox.id.into()), count(sent(outbox)), messages, true.into()])
        });
        list([publication.topic.as_str().into(), count(all), list(each)])
    });
    let subscribed = all_subscribed(graph);
    let subscribed = subscribed.iter().map(|subscribed| {
        let each = subscribed.links().into_iter().map(|link| {
            list([
                count(link.id.into()),
                count(link.received_bytes.load(Ordering::Relaxed)),
                count(link.received_messages.load(Ordering::Relaxed)),
                count(subscribed.wanted.inbox.dropped.load(Ordering::Relaxed)),
                link.connected.load(Ordering::Relaxed).into(),
            ])
        });
        list([subscribed.wanted.topic.as_str().into(), list(each)])
    });
    let (mut requests, mut received, mut sent) = (0, 0, 0);
    for service in lock(&graph.services).values() {
        requests += service.requests.load(Ordering::Relaxed);
        received += service.received_bytes.load(Ordering::Relaxed);
        sent += service.sent_bytes.load(Ordering::Relaxed);
    }
    list([list(published), list(subscribed), list([count(requests), count(received), count(sent)])])
}

fn bus_info(graph: &Graph) -> ParameterValue {
    let mut connections = Vec::new();
    let row = |id: u32, peer: &str, direction: &str, topic: &str, connected: bool, ends: &str| {
        let texts = [peer, direction, "TCPROS", topic].map(ParameterValue::from);
        let [peer, direction, transport, topic] = texts;
        list([count(id.into()), peer, direction, transport, topic, connected.into(), ends.into()])
    };
    let published = lock(&graph.publications).values().cloned().collect::<Vec<_>>();
    for publication in published {
        for outbox in publication.outboxes() {
            connections.push(row(outbox.id, &outbox.caller_id, "o", &publication.topic, true, &outbox.ends));
        }
    }
    for subscribed in all_subscribed(graph) {
        for link in subscribed.links() {
            let connected = link.connected.load(Ordering::Relaxed);
            connections.push(row(
                link.id,
                &link.uri,
                "i",
                &subscribed.wanted.topic,
                connected,
                &lock(&link.ends),
            ));
        }
    }
    list(connections)
}

fn subscriptions(graph: &Graph) -> ParameterValue {
    let mut pairs: Vec<_> = all_subscribed(graph)
        .iter()
        .map(|subscribed| (subscribed.wanted.topic.clone(), subscribed.wanted.kind.name.clone()))
        .collect();
    pairs.sort();
    pairs.dedup();
    list(pairs.into_iter().map(|(topic, kind)| list([topic.into(), kind.into()])))
}

fn publications(graph: &Graph) -> ParameterValue {
    let publications = lock(&graph.publications);
    list(publications.values().map(|one| list([one.topic.as_str().into(), one.kind.name.as_str().into()])))
}

/// Returns before the shutdown, which waits for this thread.
fn shutdown(graph: &Arc<Graph>, caller: &str, reason: &str) -> Answer {
    let reason = format!("requested by {caller:.200}: {reason:.500}");
    let graph = Arc::clone(graph);
    let started =
        thread::Builder::new().name("ros1 shutdown".to_owned()).spawn(move || graph.shut_down(&reason));
    started.map(|_| 0.into()).map_err(|error| (0, error.to_string()))
}

fn param_update(graph: &Graph, key: &str, value: Option<&ParameterValue>) -> Answer {
    let value =
        value.filter(|_| !key.is_empty()).ok_or((-1, "paramUpdate needs a key and a value".to_owned()))?;
    notify(graph, key, value);
    Ok(0.into())
}

fn publisher_update(graph: &Graph, topic: &str, publishers: Option<&ParameterValue>) -> Answer {
    let publishers = publishers.and_then(|value| uris(value).ok());
    let publishers = publishers.ok_or((-1, "publisherUpdate needs a topic and addresses".to_owned()))?;
    for subscribed in all_subscribed(graph) {
        if subscribed.wanted.topic == topic {
            subscribed.update(&publishers);
        }
    }
    Ok(0.into())
}

fn request_topic(graph: &Graph, topic: &str, protocols: Option<&ParameterValue>) -> Answer {
    if !lock(&graph.publications).contains_key(topic) {
        return Err((-1, format!("{} does not publish {topic:.200}", graph.context.names.node())));
    }
    let is_tcp = |protocol: &ParameterValue| {
        protocol.as_list().and_then(<[_]>::first).and_then(ParameterValue::as_str) == Some("TCPROS")
    };
    if !protocols.and_then(ParameterValue::as_list).is_some_and(|all| all.iter().any(is_tcp)) {
        return Err((0, "this node supports only TCPROS".to_owned()));
    }
    Ok(list(["TCPROS".into(), graph.context.host.as_str().into(), i32::from(graph.context.tcp_port).into()]))
}
