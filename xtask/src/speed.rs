//! The measured speeds in the cards of `models/`.

use std::fs;

use serde_json::Value;

use crate::card::{edited_card, with_line};
use crate::shell::Result;

/// Writes the report of `opendr bench` for `LEARNER/VARIANT` into its card.
pub fn write_speed(model: &str, report: &Value) -> Result<()> {
    let speed = speed_of(report, &processor()?)?;
    edited_card(model, |card, variant| with_line(card, variant, "speed = ", &speed))
}

/// Returns the line `speed = {...}` of a report, measured on `processor`.
fn speed_of(report: &Value, processor: &str) -> Result<String> {
    let number = |value: &Value| value.as_f64().ok_or_else(|| "the report lacks a number".to_owned());
    let rounded = |value: f64| match value {
        value if value >= 100.0 => format!("{value:.0}"),
        value if value >= 10.0 => format!("{value:.1}"),
        value if value >= 0.1 => format!("{value:.2}"),
        value => format!("{value:.4}"),
    };
    let rate = match report["real_time_factor"].as_f64() {
        Some(factor) => format!("real_time_factor = {}", rounded(factor)),
        None => format!("fps = {}", rounded(number(&report["frames_per_second"])?)),
    };
    let p50 = rounded(number(&report["p50_ms"]["total"])?);
    let peak = number(&report["peak_memory_mb"])?;
    // The path of the library is specific to this machine.
    let runtime = report["runtime"].as_str().unwrap_or_default();
    let runtime = runtime.split([',', '(']).next().unwrap_or_default().trim();
    let size = match &report["image"] {
        Value::Object(image) => format!(", {}x{}", image["width"], image["height"]),
        _ => String::new(),
    };
    Ok(format!(
        "speed = {{ {rate}, p50_ms = {p50}, peak_mb = {peak:.0}, on = \"2 cores of {processor}, {runtime}{size}\" }}"
    ))
}

/// Returns the kernel's name of the CPU without trade marks, e.g. `Intel Xeon Processor`.
fn processor() -> Result<String> {
    let text = fs::read_to_string("/proc/cpuinfo").map_err(|error| format!("/proc/cpuinfo: {error}"))?;
    let name = text.lines().find_map(|line| line.strip_prefix("model name")?.split_once(':'));
    let (_, name) = name.ok_or("/proc/cpuinfo has no CPU name")?;
    Ok(name.replace("(R)", "").replace("(TM)", "").split_whitespace().collect::<Vec<_>>().join(" "))
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn audio_has_a_real_time_factor() {
        let mut report = json!({
            "runtime": "ONNX Runtime 1.31.1 (/x.so), cpu, 2 threads", "frames_per_second": 25.04, "p50_ms": { "total": 40.126 },
            "peak_memory_mb": 95.4, "image": { "source": "s", "width": 1920, "height": 1080 },
        });
        let on = "on = \"2 cores of a Z80, ONNX Runtime 1.31.1, 1920x1080\"";
        assert_eq!(
            speed_of(&report, "a Z80").unwrap(),
            format!("speed = {{ fps = 25.0, p50_ms = 40.1, peak_mb = 95, {on} }}")
        );
        report["real_time_factor"] = json!(0.0561);
        assert!(speed_of(&report, "a Z80").unwrap().starts_with("speed = { real_time_factor = 0.0561, "));
        report["peak_memory_mb"] = Value::Null;
        assert!(speed_of(&report, "a Z80").is_err());
    }
}
