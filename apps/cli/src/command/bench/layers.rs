//! `opendr bench --layers`: time, arithmetic and bandwidth of the layers of a learner's networks.

use std::collections::HashMap;
use std::fmt;
use std::path::Path;
use std::time::{Duration, Instant};

use opendr::atomic_file::replace_file;
use opendr::inference::default_runtime;
use opendr::inference::layers::{self, LayerCost, LayerProfile, Limits, SessionProfile};
use opendr::{Device, Error, Result, ResultExt as _};
use serde::Serialize;
use serde_json::{Value as Json, json};

/// Rows of a table that are printed.
const MOST_ROWS: usize = 25;
/// Calls that a trace contains.
const TRACED: usize = 10;

/// A profiled call of a learner.
pub struct ProfiledCall {
    start: Instant,
    time: Duration,
    runs: Vec<SessionProfile>,
}

impl ProfiledCall {
    /// Profiles `call`.
    pub fn of<R>(call: impl FnOnce() -> Result<R>) -> Result<Self> {
        let start = Instant::now();
        layers::start();
        let result = call();
        let (time, runs) = (start.elapsed(), layers::take());
        result.map(|_| Self { start, time, runs })
    }
}

/// Checks that networks on the device have profiles.
///
/// # Errors
/// `Unsupported` with what to do, where another runtime than the built-in one is used.
pub fn check_runtime(device: Device) -> Result<()> {
    let runtime = default_runtime(device.or_environment()?)?;
    if runtime.name() == "builtin" {
        return Ok(());
    }
    Err(Error::unsupported(format!(
        "--layers needs the built-in runtime, but networks run on {}; set OPENDR_RUNTIME=builtin",
        runtime.name()
    )))
}

/// Layers of the networks of a learner.
#[derive(Serialize)]
pub struct LayerReport {
    /// Number of calls over which the times are means.
    calls: usize,
    /// Milliseconds of all layers per call.
    ms: f64,
    /// Measured limits of the machine.
    gflops_limit: f64,
    gb_per_s_limit: f64,
    /// The longest time first.
    layers: Vec<LayerRow>,
    operators: Vec<LayerRow>,
}

/// A layer, or all layers of an operator.
#[derive(Serialize)]
struct LayerRow {
    /// Number of the network, from 1; 0 for those of all networks.
    #[serde(skip_serializing_if = "is_zero")]
    network: usize,
    #[serde(skip_serializing_if = "String::is_empty")]
    name: String,
    operator: String,
    /// Milliseconds per call.
    ms: f64,
    /// Share of the time of all layers.
    share: f64,
    /// Operations on single-precision numbers and on bytes, in 10^9 per second.
    gflops: f64,
    byte_gops: f64,
    /// Bytes of tensors and weights, in 10^9 per second.
    gb_per_s: f64,
    /// Share of the machine's arithmetic on single-precision numbers.
    peak_share: f64,
}

fn is_zero(number: &usize) -> bool {
    *number == 0
}

/// Sums over calls.
#[derive(Default)]
struct Total {
    time: Duration,
    cost: LayerCost,
    bytes: u64,
}

impl Total {
    fn add(&mut self, layer: &LayerProfile) {
        self.time += layer.time;
        self.cost = self.cost + layer.cost;
        self.bytes += layer.tensor_bytes + layer.cost.weight_bytes;
    }
}

impl LayerReport {
    /// Sums the layers of calls, and measures the limits of the machine with that number of threads.
    ///
    /// # Errors
    /// `Unsupported` where no network ran.
    pub fn new(calls: &[ProfiledCall], threads: usize) -> Result<Self> {
        let runs = || calls.iter().flat_map(|call| &call.runs);
        if runs().all(|run| run.layers.is_empty()) {
            return Err(Error::unsupported("--layers: this learner runs no network in the built-in runtime"));
        }
        Ok(Self::with_limits(calls, layers::limits(threads)))
    }

    fn with_limits(calls: &[ProfiledCall], limits: Limits) -> Self {
        let mut networks: Vec<usize> = Vec::new();
        let mut by_layer: HashMap<(usize, &str, &str), Total> = HashMap::new();
        let mut by_operator: HashMap<(usize, &str, &str), Total> = HashMap::new();
        let mut all = Total::default();
        for run in calls.iter().flat_map(|call| &call.runs) {
            let network = networks.iter().position(|&known| known == run.session).unwrap_or_else(|| {
                networks.push(run.session);
                networks.len() - 1
            });
            for layer in &run.layers {
                by_layer.entry((network + 1, &layer.name, &layer.operator)).or_default().add(layer);
                by_operator.entry((0, "", &layer.operator)).or_default().add(layer);
                all.add(layer);
            }
        }
        let rows = |totals: HashMap<(usize, &str, &str), Total>| {
            let row = |((network, name, operator), total): ((usize, &str, &str), Total)| {
                let seconds = total.time.as_secs_f64().max(1e-9);
                let rate = |count: u64| count as f64 / seconds;
                LayerRow {
                    network,
                    name: name.to_owned(),
                    operator: operator.to_owned(),
                    ms: per_call_ms(total.time, calls.len()),
                    share: seconds / all.time.as_secs_f64().max(1e-9),
                    gflops: rate(total.cost.float_operations) / 1e9,
                    byte_gops: rate(total.cost.byte_operations) / 1e9,
                    gb_per_s: rate(total.bytes) / 1e9,
                    peak_share: rate(total.cost.float_operations) / limits.operations_per_s,
                }
            };
            let mut rows: Vec<LayerRow> = totals.into_iter().map(row).collect();
            rows.sort_by(|a, b| b.ms.total_cmp(&a.ms).then_with(|| a.name.cmp(&b.name)));
            rows
        };
        Self {
            calls: calls.len(),
            ms: per_call_ms(all.time, calls.len()),
            gflops_limit: limits.operations_per_s / 1e9,
            gb_per_s_limit: limits.bytes_per_s / 1e9,
            layers: rows(by_layer),
            operators: rows(by_operator),
        }
    }
}

fn per_call_ms(time: Duration, calls: usize) -> f64 {
    1e3 * time.as_secs_f64() / calls.max(1) as f64
}

impl fmt::Display for LayerReport {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Self { calls, ms, gflops_limit, gb_per_s_limit, layers, operators } = self;
        let networks = layers.iter().map(|layer| layer.network).max().unwrap_or(0);
        writeln!(
            f,
            "layers: {ms:.3} ms per call, mean of {calls}; measured limits of the machine: {gflops_limit:.0} GFLOP/s, {gb_per_s_limit:.1} GB/s"
        )?;
        for (rows, title) in [(operators, "operator"), (layers, "layer")] {
            writeln!(
                f,
                "{:>10} {:>6} {:>8} {:>7} {:>8} {:>7}  {title}",
                "ms", "share", "GFLOP/s", "of peak", "int8 G/s", "GB/s"
            )?;
            for row in rows.iter().take(MOST_ROWS) {
                let number = |value: f64| if value > 0.0 { format!("{value:.1}") } else { "-".to_owned() };
                write!(
                    f,
                    "{:>10.4} {:>5.1}% {:>8} {:>7} {:>8} {:>7}  {}",
                    row.ms,
                    100.0 * row.share,
                    number(row.gflops),
                    if row.gflops > 0.0 { format!("{:.0}%", 100.0 * row.peak_share) } else { "-".to_owned() },
                    number(row.byte_gops),
                    number(row.gb_per_s),
                    row.operator,
                )?;
                match (row.network, networks) {
                    (0, _) => writeln!(f)?,
                    (_, 1) => writeln!(f, " {}", row.name)?,
                    (network, _) => writeln!(f, " {} (network {network})", row.name)?,
                }
            }
            if let Some(rest) = rows.get(MOST_ROWS..).filter(|rest| !rest.is_empty()) {
                let ms: f64 = rest.iter().map(|row| row.ms).sum();
                writeln!(f, "{ms:>10.4} {:>5.1}%  in {} more", 100.0 * ms / self.ms.max(1e-9), rest.len())?;
            }
        }
        Ok(())
    }
}

/// Writes the first calls as trace events, which <https://ui.perfetto.dev> opens.
///
/// # Errors
/// `Io` where the file cannot be written.
pub fn write_trace(learner: &str, calls: &[ProfiledCall], path: &Path) -> Result<()> {
    replace_file(path, trace(learner, calls).to_string().as_bytes())
        .context(|| format!("writing {}", path.display()))
}

fn trace(learner: &str, calls: &[ProfiledCall]) -> Json {
    let Some(origin) = calls.first().map(|call| call.start) else { return json!({ "traceEvents": [] }) };
    let event = |name: &str, category: &str, start: Instant, time: Duration, args: Json| {
        let at = start.saturating_duration_since(origin);
        let us = |time: Duration| time.as_nanos() as f64 / 1e3;
        json!({
            "name": name, "cat": category, "ph": "X", "pid": 1, "tid": 1, "ts": us(at), "dur": us(time), "args": args,
        })
    };
    let mut events =
        vec![json!({ "name": "process_name", "ph": "M", "pid": 1, "args": { "name": learner } })];
    for call in calls.iter().take(TRACED) {
        events.push(event("call", "learner", call.start, call.time, json!({})));
        for run in &call.runs {
            let (Some(begin), Some(end)) = (run.layers.first(), run.layers.last()) else { continue };
            let time = (end.start + end.time).saturating_duration_since(begin.start);
            events.push(event("network", "session", begin.start, time, json!({ "session": run.session })));
            events.extend(run.layers.iter().map(|layer| {
                let args = json!({
                    "node": layer.name,
                    "float_operations": layer.cost.float_operations,
                    "byte_operations": layer.cost.byte_operations,
                    "weight_bytes": layer.cost.weight_bytes,
                    "tensor_bytes": layer.tensor_bytes,
                });
                event(&layer.operator, "layer", layer.start, layer.time, args)
            }));
        }
    }
    json!({ "displayTimeUnit": "ms", "traceEvents": events })
}

#[cfg(test)]
mod tests {
    use super::*;

    const LIMITS: Limits = Limits { operations_per_s: 100e9, bytes_per_s: 10e9 };

    fn layer(name: &str, operator: &str, us: u64, float_operations: u64) -> LayerProfile {
        LayerProfile {
            name: name.to_owned(),
            operator: operator.to_owned(),
            start: Instant::now(),
            time: Duration::from_micros(us),
            cost: LayerCost { float_operations, byte_operations: 0, weight_bytes: 500 },
            tensor_bytes: 500,
        }
    }

    fn call(runs: Vec<SessionProfile>) -> ProfiledCall {
        ProfiledCall { start: Instant::now(), time: Duration::from_millis(1), runs }
    }

    #[test]
    fn layers_are_sums_over_runs_and_means_over_calls() {
        let calls = [(); 2].map(|()| {
            let convolution = layer("a", "Conv", 100, 5_000_000);
            let twice = SessionProfile { session: 7, layers: vec![convolution, layer("b", "Relu", 50, 0)] };
            let other = SessionProfile { session: 9, layers: vec![layer("a", "Conv", 40, 0)] };
            call(vec![twice.clone(), other, twice])
        });
        let report = LayerReport::with_limits(&calls, LIMITS);
        let rows: Vec<_> = report.layers.iter().map(|row| (row.network, row.name.as_str(), row.ms)).collect();
        assert_eq!(rows, [(1, "a", 0.2), (1, "b", 0.1), (2, "a", 0.04)]);
        let first = &report.layers[0];
        assert!((first.gflops - 50.0).abs() < 1e-9 && (first.peak_share - 0.5).abs() < 1e-9);
        assert!((first.gb_per_s - 0.01).abs() < 1e-9 && (first.share - 0.2 / 0.34).abs() < 1e-9);
        let operators: Vec<_> = report.operators.iter().map(|row| (row.operator.as_str(), row.ms)).collect();
        assert!(
            operators[0].0 == "Conv" && (operators[0].1 - 0.24).abs() < 1e-9 && operators[1] == ("Relu", 0.1)
        );
        let text = report.to_string();
        assert!(text.contains("50%") && text.contains("Conv a (network 1)"), "{text}");
    }

    #[test]
    fn a_learner_without_networks_is_refused() {
        assert!(LayerReport::new(&[call(Vec::new())], 1).is_err());
    }

    #[test]
    fn events_of_a_trace_lie_within_their_call() {
        let mut profiled = call(Vec::new());
        profiled.time = Duration::from_micros(2);
        let start = profiled.start + Duration::from_micros(1);
        let step = LayerProfile { start, time: Duration::from_nanos(500), ..layer("a", "Conv", 1, 10) };
        profiled.runs = vec![SessionProfile { session: 0, layers: vec![step] }];
        let trace = trace("nanodet", &[profiled]);
        let events = trace["traceEvents"].as_array().unwrap();
        assert_eq!(events[0]["args"]["name"], "nanodet");
        let spans: Vec<_> = events[1..]
            .iter()
            .map(|event| (event["ts"].as_f64().unwrap(), event["dur"].as_f64().unwrap()))
            .collect();
        assert_eq!(spans, [(0.0, 2.0), (1.0, 0.5), (1.0, 0.5)]);
        assert_eq!(events[3]["name"], "Conv");
    }
}
