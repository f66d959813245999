//! The measured speeds in the cards of `models/`.

use std::fs;

use serde_json::Value;

use crate::shell::{Result, root};

/// Writes the report of `opendr bench` for `LEARNER/VARIANT` into its card.
pub fn write_speed(model: &str, report: &Value) -> Result<()> {
    let (learner, variant) = model.split_once('/').ok_or_else(|| format!("{model} has no variant"))?;
    let path = root().join(format!("models/{learner}.toml"));
    let card = fs::read_to_string(&path).map_err(|error| format!("{}: {error}", path.display()))?;
    let changed = with_speed(&card, variant, &speed_of(report, &processor()?)?)
        .ok_or_else(|| format!("{} has no licence of {variant} to write after", path.display()))?;
    fs::write(&path, changed).map_err(|error| format!("{}: {error}", path.display()))
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
    let size = match &report["picture"] {
        Value::Object(picture) => format!(", {}x{}", picture["width"], picture["height"]),
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

/// Returns the card with `speed` as the line of its variant.
fn with_speed(card: &str, variant: &str, speed: &str) -> Option<String> {
    let mut lines: Vec<&str> = card.lines().collect();
    let name = format!("name = {variant:?}");
    let begin = lines.iter().position(|line| *line == name)?;
    let length = lines[begin..].iter().position(|line| line.starts_with("[[")).unwrap_or(lines.len() - begin);
    let block = begin..begin + length;
    match lines[block.clone()].iter().position(|line| line.starts_with("speed = ")) {
        Some(at) => lines[begin + at] = speed,
        None => {
            let licence = lines[block].iter().position(|line| line.starts_with("licence = "))?;
            lines.insert(begin + licence + 1, speed);
        }
    }
    Some(lines.join("\n") + "\n")
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn the_speed_is_written_into_the_block_of_its_variant() {
        let card = "[[variants]]\nname = \"a\"\nlicence = {}\n\n[[variants]]\nname = \"b\"\nlicence = {}\nspeed = {}\n";
        let with = with_speed(card, "a", "speed = 1").unwrap();
        assert_eq!(with, card.replacen("licence = {}\n", "licence = {}\nspeed = 1\n", 1));
        assert_eq!(with_speed(card, "b", "speed = 1").unwrap(), card.replace("speed = {}", "speed = 1"));
        assert_eq!(with_speed(card, "c", "speed = 1"), None);
    }

    #[test]
    fn audio_has_a_real_time_factor() {
        let mut report = json!({
            "runtime": "ONNX Runtime 1.31.1 (/x.so), cpu, 2 threads", "frames_per_second": 25.04, "p50_ms": { "total": 40.126 },
            "peak_memory_mb": 95.4, "picture": { "source": "s", "width": 1920, "height": 1080 },
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
